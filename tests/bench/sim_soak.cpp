// sim_soak SCENARIO FRAMES [KEY=VALUE ...]: makes frame after frame of a drive with all that its sensors do to it, and says how much memory
// the process holds. A drive that is too short gets a higher rate: sensors.cameras.NAME.rate_hz=60.
#include <chrono>
#include <cstdio>
#include <fstream>
#include <memory>
#include <string>

#include "core/config.h"
#include "core/error.h"
#include "sim/simulated_stream.h"

namespace {

// Resident memory in MB of 2^20 bytes (Linux).
double resident_mb() {
  std::ifstream status("/proc/self/statm");
  long total = 0, resident = 0;
  status >> total >> resident;
  return static_cast<double>(resident) * 4096.0 / (1 << 20);
}

}  // namespace

int main(int argc, char** argv) {
  using namespace waretwin;
  if (argc < 3) {
    std::fprintf(stderr, "usage: sim_soak SCENARIO FRAMES [KEY=VALUE ...]\n");
    return 2;
  }
  try {
    std::vector<Setting> settings;
    for (int i = 3; i < argc; ++i) {
      const std::string text = argv[i];
      const std::size_t equals = text.find('=');
      if (equals == std::string::npos) throw Error("'" + text + "' is no setting; expected KEY=VALUE");
      settings.push_back({text.substr(0, equals), text.substr(equals + 1)});
    }
    const Scenario scenario = load_scenario(argv[1], settings);
    SimulationConfig config;
    config.max_frames = std::stoi(argv[2]);
    SimulatedStream stream(scenario, std::make_shared<const Scene>(build_scene(scenario)), config);
    int frames = 0, events = 0;
    const auto begin = std::chrono::steady_clock::now();
    std::printf("frames,events,stream_s,wall_s,resident_mb\n");
    while (auto event = stream.next()) {
      ++events;
      if (auto* frame = std::get_if<RgbdFrame>(&*event)) {
        load_pictures(*frame);
        ++frames;
        if (frames % 500 == 1 || frames == config.max_frames) {
          const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
          std::printf("%d,%d,%.1f,%.1f,%.1f\n", frames, events, to_seconds(frame->stamp), wall, resident_mb());
          std::fflush(stdout);
        }
      }
    }
    std::printf("%d frames in all\n", frames);
  } catch (const Error& error) {
    std::fprintf(stderr, "sim_soak: %s\n", error.what());
    return 2;
  }
  return 0;
}

// What each idea of the volume is worth: one recorded drive, mapped with true poses under several settings, each mesh held against the
// true hall.
//
//   waretwin record scenes/agiprobot/scenario.yaml --out out/drive
//   volume_ablation scenes/agiprobot/scenario.yaml out/drive "" "method=rays" "projection.plane_distance=false clear_frames=0"
//
// Each further argument is one set of keys of mapper.integrate over those of profile best. A row of the table each: the figures of
// score.json's `surface`, the median time of a frame, the map's memory. WARETWIN_EVERY=N maps each Nth frame alone.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <sstream>

#include "core/config.h"
#include "core/error.h"
#include "harness/run/record.h"
#include "harness/run/run_config.h"
#include "harness/score/surface_score.h"
#include "harness/score/trajectory_file.h"
#include "mapper/mapper_config.h"
#include "mapper/stages.h"
#include "sensors/recordings/recording.h"
#include "sim/ray_caster.h"

namespace waretwin {
namespace {

struct Variant {
  std::string name;
  TsdfConfig config;
  std::unique_ptr<TsdfVolume> volume;
  std::unique_ptr<Integrator> integrator;
  std::vector<double> frame_ms;
};

Variant make_variant(const std::string& text) {
  Variant variant;
  variant.name = text.empty() ? "best" : text;
  MapperConfig mapper = MapperConfig::make("best");
  std::vector<Setting> settings;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos) throw Error("'" + word + "'; expected key=value");
    settings.push_back({"integrate." + word.substr(0, equals), word.substr(equals + 1)});
  }
  apply_settings(settings, [&](Fields& f) { mapper.visit(f); });
  variant.config = mapper.integrate;
  variant.volume = std::make_unique<TsdfVolume>(variant.config);
  variant.integrator = make_integrator(variant.config);
  return variant;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

int run(int argc, char** argv) {
  if (argc < 3) {
    std::cerr << "usage: volume_ablation SCENARIO RECORDING [\"key=value ...\"]...\n";
    return 2;
  }
  const std::filesystem::path folder = argv[2];
  RecordConfig config = load_record_config(argv[1], {}, {});
  read_resolved_config(folder / "config.yaml", [&](Fields& f) { config.visit(f); });
  const auto scene = std::make_shared<const Scene>(build_scene(config.scenario));
  const auto caster = std::make_shared<const RayCaster>(scene);
  SurfaceMeter meter(caster);
  const Trajectory truth = read_trajectory(folder / "trajectory_truth.tum");
  std::vector<Variant> variants;
  for (int i = 3; i < argc; ++i) variants.push_back(make_variant(argv[i]));
  if (variants.empty()) variants.push_back(make_variant(""));
  const char* const every_text = std::getenv("WARETWIN_EVERY");
  const int every = every_text != nullptr ? std::max(1, std::atoi(every_text)) : 1;

  const auto recording = open_recording(folder);
  std::size_t at = 0;
  int frames = 0;
  while (auto event = recording->next()) {
    auto* const frame = std::get_if<RgbdFrame>(&*event);
    if (frame == nullptr || frames++ % every != 0) continue;
    load_pictures(*frame);
    while (at + 1 < truth.poses.size() && truth.poses[at].stamp < frame->stamp) ++at;
    const StreamInfo::Camera& camera = recording->info().cameras.at(frame->sensor);
    const Pose X_WC = truth.poses[at].X_WB * camera.X_BC;
    meter.add_frame(config.scenario.sensors.cameras.at(frame->sensor), X_WC);
    for (Variant& variant : variants) {
      const auto start = std::chrono::steady_clock::now();
      variant.integrator->integrate(*frame, camera.intrinsics, {}, X_WC, *variant.volume);
      variant.frame_ms.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    }
  }
  std::printf(
      "| mean mm | median mm | p95 mm | > 30 mm %% | found %% | ms/frame | map MB | vertices | setting "
      "|\n|---|---|---|---|---|---|---|---|---|\n");
  for (const Variant& variant : variants) {
    const SurfaceScore s = meter.result(extract_mesh(*variant.volume));
    std::printf("| %.2f | %.2f | %.1f | %.2f | %.2f | %.1f | %.0f | %d | %s |\n", 1e3 * s.mean_m, 1e3 * s.median_m, 1e3 * s.p95_m,
                100.0 * s.share_over_30mm, 100.0 * s.found, median(variant.frame_ms), static_cast<double>(variant.volume->bytes()) / 1e6,
                s.vertices, variant.name.c_str());
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace
}  // namespace waretwin

int main(int argc, char** argv) {
  try {
    return waretwin::run(argc, argv);
  } catch (const waretwin::Error& e) {
    std::cerr << e.what() << "\n";
    return 2;
  }
}

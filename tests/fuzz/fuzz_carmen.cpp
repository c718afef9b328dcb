// Feeds arbitrary bytes to the CARMEN log reader, packed or not: it throws Error or gives events that a mapper can take.
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <variant>

#include "core/error.h"
#include "core/files.h"
#include "sensors/recordings/carmen_log.h"
#include "tests/support/test_data.h"

namespace {

void check(const waretwin::CarmenLog& log) {
  using namespace waretwin;
  WARETWIN_CHECK(!log.events.empty() && std::isfinite(*log.info.duration_s) && *log.info.duration_s >= 0.0, "a log has a length");
  const StreamInfo::Laser& laser = log.info.lasers.at("laser");
  WARETWIN_CHECK(std::isfinite(laser.rate_hz) && laser.rate_hz >= 0.0 && laser.X_BL.matrix().allFinite(), "the laser is where it can be");
  Stamp last = stamp_of(log.events.front());
  for (const SensorEvent& event : log.events) {
    WARETWIN_CHECK(stamp_of(event) >= last, "events are in order");
    last = stamp_of(event);
    if (const auto* reading = std::get_if<OdometryReading>(&event))
      WARETWIN_CHECK(reading->X_OB.matrix().allFinite(), "odometry is finite");
    if (const auto* scan = std::get_if<LaserScan>(&event)) {
      for (const float range : scan->ranges)
        WARETWIN_CHECK(range >= 0.0f && static_cast<double>(range) <= scan->range_max, "ranges are ranges");
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const waretwin::test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "input.log";  // zlib tells packed logs by their magic number
  waretwin::write_file(file, std::string_view(reinterpret_cast<const char*>(data), size));
  try {
    check(waretwin::read_carmen_log(file));
  } catch (const waretwin::Error&) {
  }
  return 0;
}

// Feeds arbitrary bytes to the CARMEN log reader, packed or not: it throws Error or gives events that a mapper can take.
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <variant>

#include "core/error.h"
#include "core/files.h"
#include "sensors/recordings/recording.h"
#include "tests/support/test_data.h"

namespace {

void check(waretwin::Recording& log) {
  using namespace waretwin;
  const StreamInfo& info = log.info();
  WARETWIN_CHECK(std::isfinite(*info.duration_s) && *info.duration_s >= 0.0, "a log has a length");
  const StreamInfo::Laser& laser = info.lasers.at("laser");
  WARETWIN_CHECK(std::isfinite(laser.rate_hz) && laser.rate_hz >= 0.0 && laser.X_BL.matrix().allFinite(), "the laser is where it can be");
  std::optional<Stamp> last;
  while (const auto event = log.next()) {
    WARETWIN_CHECK(!last || stamp_of(*event) >= *last, "events are in order");
    last = stamp_of(*event);
    if (const auto* reading = std::get_if<OdometryReading>(&*event))
      WARETWIN_CHECK(reading->X_OB.matrix().allFinite(), "odometry is finite");
    if (const auto* scan = std::get_if<LaserScan>(&*event)) {
      for (const float range : scan->ranges)
        WARETWIN_CHECK(range >= 0.0f && static_cast<double>(range) <= scan->range_max, "ranges are ranges");
    }
  }
  WARETWIN_CHECK(last, "a log has a scan");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const waretwin::test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "input.log";  // zlib tells packed logs by their magic number
  waretwin::write_file(file, std::string_view(reinterpret_cast<const char*>(data), size));
  try {
    check(*waretwin::open_recording(file));
  } catch (const waretwin::Error&) {
  }
  return 0;
}

// Which frames are taken to keep a rate; those in between are dropped.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "core/stamp.h"

namespace waretwin {

// Each camera has the rate for itself. Time is cut into slots of 1 / rate from the first frame on; of a slot the first frame is taken.
class FrameSchedule {
 public:
  // 0: every frame.
  explicit FrameSchedule(double rate_hz) : rate_hz_(rate_hz) {}
  // Of frames in order of their stamps.
  bool due(const std::string& camera, Stamp stamp);

 private:
  double rate_hz_;
  std::optional<Stamp> first_;
  std::map<std::string, std::int64_t> last_slots_;
};

}  // namespace waretwin

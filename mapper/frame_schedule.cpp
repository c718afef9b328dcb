#include "mapper/frame_schedule.h"

#include <cmath>

namespace waretwin {

bool FrameSchedule::due(const std::string& camera, Stamp stamp) {
  if (rate_hz_ <= 0.0) return true;
  if (!first_) first_ = stamp;
  // A frame that misses its slot by rounding of stamps still belongs to it.
  constexpr double kSlack = 1e-3;
  const auto slot = static_cast<std::int64_t>(std::floor(to_seconds(stamp - *first_) * rate_hz_ + kSlack));
  const auto [last, is_new] = last_slots_.try_emplace(camera, slot);
  if (!is_new && slot <= last->second) return false;
  last->second = slot;
  return true;
}

}  // namespace waretwin

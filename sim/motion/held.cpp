#include "sim/motion/held.h"

#include <algorithm>
#include <cmath>

namespace waretwin {

namespace {

// Between which places it is, and how far on the way from one to the other.
struct Moment {
  std::size_t from, to;
  double share;
};

Moment moment_of(const HeldConfig& config, double time_s) {
  const double round = config.hold_s + config.move_s;  // above 0
  const std::size_t last = config.places.size() - 1;
  const double turn = std::floor(std::max(time_s, 0.0) / round);
  if (turn >= static_cast<double>(last)) return {last, last, 0.0};
  const auto from = static_cast<std::size_t>(turn);
  const double moving = std::max(time_s, 0.0) - turn * round - config.hold_s;
  return {from, from + 1, std::clamp(moving / config.move_s, 0.0, 1.0)};
}

}  // namespace

Pose held_X_WG(const HeldConfig& config, double time_s) {
  const Moment m = moment_of(config, time_s);
  return interpolate(config.places[m.from].X_WG(), config.places[m.to].X_WG(), m.share);
}

Pose stand_X_WG(const HeldConfig& config, double time_s) {
  const Moment m = moment_of(config, time_s);
  const auto upright = [](const HeldPlace& p) { return make_upright_pose(p.x_m, p.y_m, p.z_m, to_radians(p.yaw_deg)); };
  return interpolate(upright(config.places[m.from]), upright(config.places[m.to]), m.share);
}

std::size_t held_mover_count(const MotionConfig& config) {
  std::size_t count = 0;
  for (const HeldConfig& thing : config.held) count += thing.stand.empty() ? 1 : 2;
  return count;
}

}  // namespace waretwin

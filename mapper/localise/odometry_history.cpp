#include "mapper/localise/odometry_history.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace waretwin {
namespace {

constexpr Stamp kKept = 5 * kNanosecondsPerSecond;
constexpr Stamp kVelocityWindow = 60'000'000;  // long enough to average over quantised encoders, short against a change of speed
constexpr Stamp kLongestExtrapolation = 500'000'000;

// The fraction `t` of a motion at constant velocity and turning rate; t may lie outside [0, 1].
PlanarMotion scaled(const PlanarMotion& motion, double t) {
  // On an arc the chord of the part is turned against the chord of the whole by half the difference of their angles.
  const double half = 0.5 * motion.yaw;
  const double part = t * half;
  const double chord = std::abs(half) < 1e-9 ? t : std::sin(part) / std::sin(half);
  const Eigen::Vector2d turned = PlanarMotion{{0, 0}, part - half}.rotation() * motion.translation;
  return {chord * turned, t * motion.yaw};
}

}  // namespace

PlanarMotion planar(const Pose& X_AB) { return {X_AB.translation().head<2>(), yaw_of(X_AB)}; }

Pose upright(const PlanarMotion& X_AB) { return make_upright_pose(X_AB.translation.x(), X_AB.translation.y(), 0.0, X_AB.yaw); }

void OdometryHistory::add(Stamp stamp, const PlanarMotion& X_OB) {
  if (!readings_.empty() && stamp < readings_.back().stamp) {
    throw Error("odometry reading at " + std::to_string(stamp) + " ns after one at " + std::to_string(readings_.back().stamp) +
                " ns; expected stamps in order");
  }
  if (!readings_.empty() && stamp == readings_.back().stamp) readings_.pop_back();
  readings_.push_back({stamp, X_OB});
  while (readings_.size() > 2 && readings_.front().stamp < stamp - kKept) readings_.pop_front();
}

PlanarMotion OdometryHistory::carried_on(const Reading& from, const Reading& to, const Reading& base, Stamp stamp) const {
  if (from.stamp == to.stamp) return base.X_OB;
  const Stamp ahead = std::clamp(stamp - base.stamp, -kLongestExtrapolation, kLongestExtrapolation);
  const double t = static_cast<double>(ahead) / static_cast<double>(to.stamp - from.stamp);
  return base.X_OB * scaled(from.X_OB.inverse() * to.X_OB, t);
}

PlanarMotion OdometryHistory::at(Stamp stamp) const {
  WARETWIN_CHECK(!readings_.empty(), "there is an odometry reading");
  const auto after =
      std::lower_bound(readings_.begin(), readings_.end(), stamp, [](const Reading& reading, Stamp s) { return reading.stamp < s; });
  if (after != readings_.end() && after->stamp == stamp) return after->X_OB;
  if (after == readings_.end()) {
    auto from = readings_.end() - 1;
    while (from != readings_.begin() && readings_.back().stamp - from->stamp < kVelocityWindow) --from;
    return carried_on(*from, readings_.back(), readings_.back(), stamp);
  }
  if (after == readings_.begin()) {
    auto to = readings_.begin();
    while (to + 1 != readings_.end() && to->stamp - readings_.front().stamp < kVelocityWindow) ++to;
    return carried_on(readings_.front(), *to, readings_.front(), stamp);
  }
  return carried_on(*(after - 1), *after, *(after - 1), stamp);
}

PlanarMotion OdometryHistory::between(Stamp from, Stamp to) const {
  if (readings_.empty()) return {};
  return at(from).inverse() * at(to);
}

}  // namespace waretwin

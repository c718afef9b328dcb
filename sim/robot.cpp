#include "sim/robot.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"

namespace waretwin {

namespace {

// Shorter drives and smaller turns than these are none (rounding of configured places).
constexpr double kNoDrive = 1e-9, kNoTurn = 1e-9;

void require_positive(const char* key, double value) {
  if (!(value > 0.0) || !std::isfinite(value))
    throw Error("robot." + std::string(key) + ": " + std::to_string(value) + " is not a limit; expected a number above 0");
}

}  // namespace

TrapezoidalProfile::TrapezoidalProfile(double distance, double speed, double acceleration)
    : distance_(distance), acceleration_(acceleration) {
  WARETWIN_CHECK(distance >= 0.0 && speed > 0.0 && acceleration > 0.0, "a profile has a distance and limits");
  if (distance == 0.0) return;
  peak_ = std::min(speed, std::sqrt(distance * acceleration));
  ramp_s_ = peak_ / acceleration;
  cruise_s_ = std::max(0.0, (distance - peak_ * ramp_s_) / peak_);
}

double TrapezoidalProfile::position(double t) const {
  if (t <= 0.0) return 0.0;
  const double left = duration() - t;
  if (left <= 0.0) return distance_;
  if (t < ramp_s_) return 0.5 * acceleration_ * t * t;
  if (left < ramp_s_) return distance_ - 0.5 * acceleration_ * left * left;
  return 0.5 * peak_ * ramp_s_ + peak_ * (t - ramp_s_);
}

double TrapezoidalProfile::velocity(double t) const {
  const double left = duration() - t;
  if (t <= 0.0 || left <= 0.0) return 0.0;
  return std::min({peak_, acceleration_ * t, acceleration_ * left});
}

RobotMotion::RobotMotion(const RobotConfig& config) {
  if (config.route.empty()) throw Error("robot.route: no waypoints; expected at least one");
  require_positive("speed_mps", config.speed_mps);
  require_positive("acceleration_mps2", config.acceleration_mps2);
  require_positive("turn_rate_deg_s", config.turn_rate_deg_s);
  require_positive("turn_acceleration_deg_s2", config.turn_acceleration_deg_s2);
  const double turn_rate = to_radians(config.turn_rate_deg_s), turn_acceleration = to_radians(config.turn_acceleration_deg_s2);
  const auto turn_to = [&](double yaw) {
    const double turn = wrap_angle(yaw - yaw_);
    if (std::abs(turn) > kNoTurn) add(0.0, turn, 0.0, turn_rate, turn_acceleration);
    yaw_ = yaw;
  };
  // The way from one waypoint to the next as the vehicle faces it.
  const auto heading_towards = [](const Waypoint& from, const Waypoint& to) {
    const double yaw = std::atan2(to.y_m - from.y_m, to.x_m - from.x_m);
    return to.reverse ? wrap_angle(yaw + to_radians(180.0)) : yaw;
  };
  const auto& route = config.route;
  x_ = route[0].x_m;
  y_ = route[0].y_m;
  if (route[0].heading_deg) {
    yaw_ = wrap_angle(to_radians(*route[0].heading_deg));
  } else if (route.size() > 1) {
    yaw_ = heading_towards(route[0], route[1]);
  }
  for (std::size_t i = 0; i < route.size(); ++i) {
    const Waypoint& to = route[i];
    const double distance = std::hypot(to.x_m - x_, to.y_m - y_);
    if (i > 0 && distance > kNoDrive) {
      turn_to(heading_towards(route[i - 1], to));
      add(to.reverse ? -distance : distance, 0.0, 0.0, config.speed_mps, config.acceleration_mps2);
      x_ = to.x_m;
      y_ = to.y_m;
    }
    if (to.heading_deg) turn_to(wrap_angle(to_radians(*to.heading_deg)));
    arrivals_.push_back(from_seconds(end_s_));
    if (to.wait_s > 0.0) add(0.0, 0.0, to.wait_s, 1.0, 1.0);
  }
  // Where the robot stands for good.
  add(0.0, 0.0, 0.0, 1.0, 1.0);
}

void RobotMotion::add(double drive, double turn, double wait_s, double speed, double acceleration) {
  const TrapezoidalProfile profile(std::abs(drive) + std::abs(turn), speed, acceleration);
  const double duration = drive != 0.0 || turn != 0.0 ? profile.duration() : wait_s;
  segments_.push_back({end_s_, x_, y_, yaw_, drive, turn, profile, duration});
  end_s_ += duration;
  distance_m_ += std::abs(drive);
  turned_rad_ += std::abs(turn);
}

const RobotMotion::Segment& RobotMotion::segment_at(double t) const {
  // The last segment that has begun.
  const auto after =
      std::upper_bound(segments_.begin(), segments_.end(), t, [](double time, const Segment& s) { return time < s.start_s; });
  return after == segments_.begin() ? segments_.front() : *(after - 1);
}

Pose RobotMotion::X_WB(Stamp stamp) const {
  const double t = to_seconds(stamp);
  const Segment& s = segment_at(t);
  const double way = s.profile.position(t - s.start_s);
  if (s.turn != 0.0) return make_upright_pose(s.x, s.y, 0.0, s.yaw + std::copysign(way, s.turn));
  const double drive = std::copysign(way, s.drive);
  return make_upright_pose(s.x + drive * std::cos(s.yaw), s.y + drive * std::sin(s.yaw), 0.0, s.yaw);
}

Twist RobotMotion::twist(Stamp stamp) const {
  const double t = to_seconds(stamp);
  const Segment& s = segment_at(t);
  const double speed = s.profile.velocity(t - s.start_s);
  Twist twist;
  if (s.turn != 0.0)
    twist.turn_rad_s = std::copysign(speed, s.turn);
  else if (s.drive != 0.0)
    twist.forward_mps = std::copysign(speed, s.drive);
  return twist;
}

Stamp RobotMotion::duration() const { return static_cast<Stamp>(std::ceil(end_s_ * 1e9)); }
double RobotMotion::distance_m() const { return distance_m_; }
double RobotMotion::turned_rad() const { return turned_rad_; }

}  // namespace waretwin

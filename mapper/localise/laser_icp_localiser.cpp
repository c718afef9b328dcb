#include "mapper/localise/laser_icp_localiser.h"

#include <cmath>

#include "core/error.h"

namespace waretwin {

LaserIcpLocaliser::LaserIcpLocaliser(const LaserIcpConfig& config, const StreamInfo& info) : config_(config), X_WS_(info.X_WB_start) {
  if (info.lasers.empty()) throw Error(info.source + ": no laser in this stream; laser poses need one (--poses odometry or recorded)");
  laser_ = info.lasers.begin()->first;
  X_BL_ = info.lasers.begin()->second.X_BL;
}

void LaserIcpLocaliser::add(const OdometryReading& reading) {
  odometry_.add(reading.stamp, planar(reading.X_OB));
  if (!anchor_) anchor_ = reading.stamp;
}

void LaserIcpLocaliser::add(const LaserScan& scan) {
  if (scan.sensor != laser_) return;
  const Stamp middle = scan.stamp + scan.beam_interval * (static_cast<Stamp>(scan.ranges.size()) - 1) / 2;
  const std::vector<Eigen::Vector2d> points_B = points_in_base(scan, middle);
  // Before the first scan the start pose is that of the first event.
  X_SB_ = X_SB_ * motion(anchor_.value_or(scan.stamp), middle);
  anchor_ = middle;
  newest_scan_ = scan.stamp;
  ++counts_.scans;

  if (keyframes_.empty()) {
    if (!points_B.empty()) {
      keyframes_.push_back({X_SB_, ReferenceScan(points_B, config_.match)});
      ++counts_.keyframes;
    }
  } else {
    const Keyframe& keyframe = keyframes_[active_];
    last_match_ = match_scans(keyframe.scan, points_B, keyframe.X_SB.inverse() * X_SB_, config_.match);
    if (last_match_.believable) {
      X_SB_ = keyframe.X_SB * last_match_.X_RS;
    } else {
      ++counts_.not_matched;
    }
    if (!near(X_SB_, keyframe)) choose_keyframe(points_B);
  }
  scan_poses_.add(middle, X_SB_);
}

std::optional<Pose> LaserIcpLocaliser::pose_at(const RgbdFrame& frame) {
  if (!anchor_) return X_WS_;
  return X_WS_ * upright(X_SB_ * motion(*anchor_, frame.stamp));
}

std::optional<Pose> LaserIcpLocaliser::current_pose() const {
  if (!newest_scan_) return std::nullopt;
  return X_WS_ * upright(X_SB_ * motion(*anchor_, *newest_scan_));
}

PlanarMotion LaserIcpLocaliser::motion(Stamp from, Stamp to) const {
  return odometry_.empty() ? scan_poses_.between(from, to) : odometry_.between(from, to);
}

std::vector<Eigen::Vector2d> LaserIcpLocaliser::points_in_base(const LaserScan& scan, Stamp middle) const {
  const std::size_t beams = scan.ranges.size();
  std::vector<Eigen::Vector2d> points_B;
  points_B.reserve(beams);
  if (beams == 0) return points_B;
  const Stamp end = scan.stamp + scan.beam_interval * static_cast<Stamp>(beams - 1);
  // Over one turn of the mirror the vehicle's velocity is as good as constant.
  const PlanarMotion first = motion(middle, scan.stamp), last = motion(middle, end);
  for (std::size_t i = 0; i < beams; ++i) {
    const double range = scan.ranges[i];
    if (!(range > config_.min_range_m) || !(range < scan.range_max) || range < scan.range_min) continue;
    const double angle = scan.angle_min + static_cast<double>(i) * scan.angle_increment;
    const Eigen::Vector3d p_L(range * std::cos(angle), range * std::sin(angle), 0.0);
    const Eigen::Vector2d p_B = (X_BL_ * p_L).head<2>();
    const double t = beams > 1 ? 2.0 * static_cast<double>(i) / static_cast<double>(beams - 1) - 1.0 : 0.0;
    const PlanarMotion& towards = t < 0.0 ? first : last;
    points_B.push_back(PlanarMotion{std::abs(t) * towards.translation, std::abs(t) * towards.yaw} * p_B);
  }
  return points_B;
}

bool LaserIcpLocaliser::near(const PlanarMotion& X_SB, const Keyframe& keyframe) const {
  const PlanarMotion X_KB = keyframe.X_SB.inverse() * X_SB;
  return X_KB.translation.norm() <= config_.keyframe_distance_m && std::abs(X_KB.yaw) <= to_radians(config_.keyframe_angle_deg) &&
         config_.keyframe_distance_m > 0.0;
}

// The vehicle has left its keyframe: go on with the oldest one near enough, whose pose has drifted least, or make a new one.
void LaserIcpLocaliser::choose_keyframe(const std::vector<Eigen::Vector2d>& points_B) {
  if (config_.reuse_keyframes) {
    for (std::size_t i = 0; i < keyframes_.size(); ++i) {
      if (i == active_ || !near(X_SB_, keyframes_[i])) continue;
      const ScanMatch match = match_scans(keyframes_[i].scan, points_B, keyframes_[i].X_SB.inverse() * X_SB_, config_.match);
      if (!match.believable) continue;
      active_ = i;
      X_SB_ = keyframes_[i].X_SB * match.X_RS;
      ++counts_.keyframes_reused;
      return;
    }
  }
  if (points_B.empty()) return;
  if (config_.keyframe_distance_m <= 0.0) keyframes_.clear();  // scan to scan: only the last one is ever used
  keyframes_.push_back({X_SB_, ReferenceScan(points_B, config_.match)});
  active_ = keyframes_.size() - 1;
  ++counts_.keyframes;
}

}  // namespace waretwin

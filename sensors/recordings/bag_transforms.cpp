#include "sensors/recordings/bag_transforms.h"

#include <tf2/exceptions.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace waretwin {

namespace {

// Time 0 means "the latest" to tf.
ros::Time tf_time(const ros::Time& time) { return std::max(time, ros::TIME_MIN); }

Stamp stamp_of_time(const ros::Time& time) { return static_cast<Stamp>(time.sec) * kNanosecondsPerSecond + time.nsec; }

Pose pose_of(const geometry_msgs::Transform& t) {
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(t.translation.x, t.translation.y, t.translation.z);
  pose.linear() = Eigen::Quaterniond(t.rotation.w, t.rotation.x, t.rotation.y, t.rotation.z).normalized().toRotationMatrix();
  return pose;
}

}  // namespace

std::string frame_name(const std::string& name) { return name.rfind('/', 0) == 0 ? name.substr(1) : name; }

bool BagTransforms::add(geometry_msgs::TransformStamped transform, bool fixed) {
  transform.header.frame_id = frame_name(transform.header.frame_id);
  transform.child_frame_id = frame_name(transform.child_frame_id);
  const auto& p = transform.transform.translation;
  const auto& q = transform.transform.rotation;
  const double norm = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  if (!std::isfinite(p.x + p.y + p.z) || !(std::abs(norm - 1.0) < 0.01)) return false;
  transform.header.stamp = tf_time(transform.header.stamp);
  if (!buffer_.setTransform(transform, "bag", fixed)) return true;  // was there before
  const auto [edge, is_new] = edges_.try_emplace(transform.child_frame_id);
  if (is_new) edge->second.fixed = fixed;  // what a frame is first it stays to tf
  if (edge->second.fixed) return true;
  std::vector<Stamp>& stamps = edge->second.stamps;
  const Stamp stamp = stamp_of_time(transform.header.stamp);
  stamps.insert(std::upper_bound(stamps.begin(), stamps.end(), stamp), stamp);
  return true;
}

std::optional<Pose> BagTransforms::last(const std::string& parent, const std::string& child) const {
  try {
    return pose_of(buffer_.lookupTransform(frame_name(parent), frame_name(child), ros::Time(0)).transform);
  } catch (const tf2::TransformException&) {
    return std::nullopt;
  }
}

BagTransforms::Found BagTransforms::at(const std::string& parent, const std::string& child, Stamp stamp, Stamp max_gap) const {
  // What ROS can say as a time.
  if (stamp < 0 || stamp / kNanosecondsPerSecond > std::numeric_limits<std::uint32_t>::max()) return {};
  const ros::Time time = tf_time(
      ros::Time(static_cast<std::uint32_t>(stamp / kNanosecondsPerSecond), static_cast<std::uint32_t>(stamp % kNanosecondsPerSecond)));
  Found found;
  try {
    found.X = pose_of(buffer_.lookupTransform(frame_name(parent), frame_name(child), time).transform);
  } catch (const tf2::TransformException&) {
    return found;
  }
  std::vector<std::string> above_child = ancestors(frame_name(child), time), above_parent = ancestors(frame_name(parent), time);
  // Above the frame where both meet they share their motion.
  while (!above_child.empty() && !above_parent.empty() && above_child.back() == above_parent.back()) {
    above_child.pop_back();
    above_parent.pop_back();
  }
  const auto gap = [&](const std::string& frame) { return in_gap(frame, stamp, max_gap); };
  found.in_gap = std::any_of(above_child.begin(), above_child.end(), gap) || std::any_of(above_parent.begin(), above_parent.end(), gap);
  if (found.in_gap) found.X.reset();
  return found;
}

// The frame itself, its parent, and so on to the root.
std::vector<std::string> BagTransforms::ancestors(const std::string& frame, const ros::Time& time) const {
  std::vector<std::string> frames = {frame};
  std::string parent;
  while (frames.size() < tf2::BufferCore::MAX_GRAPH_DEPTH && buffer_._getParent(frames.back(), time, parent)) frames.push_back(parent);
  return frames;
}

bool BagTransforms::in_gap(const std::string& child, Stamp stamp, Stamp max_gap) const {
  const auto edge = edges_.find(child);
  if (edge == edges_.end()) return false;
  const std::vector<Stamp>& stamps = edge->second.stamps;
  const auto after = std::lower_bound(stamps.begin(), stamps.end(), stamp);
  return after != stamps.begin() && after != stamps.end() && *after != stamp && *after - *(after - 1) > max_gap;
}

}  // namespace waretwin

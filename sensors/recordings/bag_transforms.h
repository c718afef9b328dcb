// The transforms of a bag, and where they put one frame in another. Internal to sensors/recordings; compiled where tf2 was found.
#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <tf2/buffer_core.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/pose.h"
#include "core/stamp.h"

namespace waretwin {

// As tf2 calls frames: without tf's old leading slash.
std::string frame_name(const std::string& name);

class BagTransforms {
 public:
  // One of /tf, or (`fixed`) of /tf_static; in any order. False for what is no rigid motion: it is left out.
  bool add(geometry_msgs::TransformStamped transform, bool fixed);

  // Pose of `child` in `parent` by the last transforms; nothing where they do not say.
  std::optional<Pose> last(const std::string& parent, const std::string& child) const;

  struct Found {
    std::optional<Pose> X;  // nothing where the transforms do not say, or only across a gap
    bool in_gap = false;
  };
  // The same at an instant, each transform between the two frames interpolated between its messages before and after. In a gap are instants
  // where two such messages are more than `max_gap` apart.
  Found at(const std::string& parent, const std::string& child, Stamp stamp, Stamp max_gap) const;

 private:
  // A frame's motion in its parent.
  struct Edge {
    bool fixed = false;
    std::vector<Stamp> stamps;  // sorted
  };
  std::vector<std::string> ancestors(const std::string& frame, const ros::Time& time) const;
  bool in_gap(const std::string& child, Stamp stamp, Stamp max_gap) const;

  tf2::BufferCore buffer_{ros::Duration(1e6)};  // nothing is forgotten
  std::map<std::string, Edge> edges_;           // by child
};

}  // namespace waretwin

// The places that the vehicle has been at, each with the scans taken there, and what is known of where they lie to each other.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapper/localise/scan_points.h"

namespace waretwin {

struct Keyframe {
  PlanarMotion X_SK;
  std::vector<ScanPoint> points_K;
  int scans = 1;                                         // that points_K holds
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // of X_SK: x, y, yaw in S
};

// "Keyframe b stands at X_ab in the frame of a."
struct KeyframeLink {
  int a = 0, b = 0;
  PlanarMotion X_ab;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  // of (x, y, yaw), in the frame of a
  bool loop = false;                                         // found by seeing a place again: it may be wrong
  // Of a loop: what it may be off by and still be right, the drift since the place was seen first included; in the frame of a.
  Eigen::Matrix3d expected = Eigen::Matrix3d::Identity();
};

// A covariance of (x, y, yaw) with its x and y turned by `yaw`.
Eigen::Matrix3d turned_covariance(const Eigen::Matrix3d& covariance, double yaw);
// What the uncertainty of a pose at `from` means for a pose that stands at `to` and is rigidly tied to it: an error of the heading acts
// through the arm between them.
Eigen::Matrix3d carried_covariance(const Eigen::Matrix3d& covariance, const Eigen::Vector2d& from, const Eigen::Vector2d& to);

class KeyframeGraph {
 public:
  std::vector<Keyframe>& keyframes() { return keyframes_; }
  const std::vector<Keyframe>& keyframes() const { return keyframes_; }
  const std::vector<KeyframeLink>& links() const { return links_; }

  int add(Keyframe keyframe);  // its number, from 0
  void link(KeyframeLink link) { links_.push_back(link); }

  // Length of the shortest way from a keyframe to each along the links, each as long as it is wide; infinity where there is none.
  std::vector<double> paths_from(int keyframe) const;

  // Moves all keyframes but the first so that the links are met best (Gauss-Newton, sparse Cholesky; Grisetti et al., "A tutorial on
  // graph-based SLAM", 2010). Loops that stay far beyond what was expected lose weight (Cauchy). Covariances are set anew: those of the
  // most certain way from the first keyframe, an upper bound of the true ones.
  void straighten();

  // The links' poses set to where the keyframes now stand: after they have been laid anew by other means.
  void relink();

 private:
  void carry_covariances();

  std::vector<Keyframe> keyframes_;
  std::vector<KeyframeLink> links_;
};

}  // namespace waretwin

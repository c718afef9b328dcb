// Outlier exclusion (section 3.2, step 2): statistical outlier removal and Euclidean clusters (Rusu and Cousins 2011), with the 70 % rule.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mapper/segment/segment_config.h"

namespace waretwin {

struct ClusterResult {
  std::vector<int> kept;  // indices into the points, ascending; empty where rejected
  std::string rejected;   // reason, empty where a cluster was selected
};

// Both steps work on one point a voxel (the mean of the voxel's points), a kept voxel keeps all its points; shares count points, not
// voxels. The largest cluster is selected if it holds at least config.cluster_fraction of the points that outlier removal left.
ClusterResult select_cluster(const std::vector<Eigen::Vector3f>& points, const SegmentConfig& config);

}  // namespace waretwin

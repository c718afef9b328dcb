#include "mapper/segment/clusters.h"

#include <pcl/filters/statistical_outlier_removal.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/extract_clusters.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace waretwin {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

// Points sorted by voxel: members of voxel i are order[start[i]] .. order[start[i + 1] - 1].
struct Voxels {
  std::vector<int> order;
  std::vector<int> start;
  std::size_t count() const { return start.size() - 1; }
};

Voxels sort_into_voxels(const std::vector<Eigen::Vector3f>& points, double size) {
  using Key = std::array<std::int32_t, 3>;
  std::vector<std::pair<Key, int>> keyed(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    Key& key = keyed[i].first;
    for (int axis = 0; axis < 3; ++axis) key[axis] = static_cast<std::int32_t>(std::floor(points[i][axis] / size));
    keyed[i].second = static_cast<int>(i);
  }
  std::sort(keyed.begin(), keyed.end());
  Voxels voxels;
  voxels.order.reserve(points.size());
  for (std::size_t i = 0; i < keyed.size(); ++i) {
    if (i == 0 || keyed[i].first != keyed[i - 1].first) voxels.start.push_back(static_cast<int>(i));
    voxels.order.push_back(keyed[i].second);
  }
  voxels.start.push_back(static_cast<int>(keyed.size()));
  return voxels;
}

// Indices of the voxels that survive.
std::vector<int> without_outliers(const Cloud::Ptr& cloud, const SegmentConfig& config) {
  std::vector<int> kept(cloud->size());
  std::iota(kept.begin(), kept.end(), 0);
  // With fewer points than neighbours there is no statistic.
  if (!config.outlier_removal || static_cast<int>(cloud->size()) <= config.outlier_neighbours) return kept;
  pcl::StatisticalOutlierRemoval<pcl::PointXYZ> removal;
  removal.setInputCloud(cloud);
  removal.setMeanK(config.outlier_neighbours);
  removal.setStddevMulThresh(config.outlier_sigmas);
  pcl::Indices indices;
  removal.filter(indices);
  return {indices.begin(), indices.end()};
}

}  // namespace

ClusterResult select_cluster(const std::vector<Eigen::Vector3f>& points, const SegmentConfig& config) {
  ClusterResult result;
  if (points.empty()) {
    result.rejected = "no points";
    return result;
  }
  double size = config.thin_voxel_m;
  Voxels voxels = sort_into_voxels(points, size);
  while (static_cast<int>(voxels.count()) > config.thin_points) voxels = sort_into_voxels(points, size *= 2.0);

  auto cloud = pcl::make_shared<Cloud>();
  for (std::size_t i = 0; i < voxels.count(); ++i) {
    Eigen::Vector3f mean = Eigen::Vector3f::Zero();
    for (int k = voxels.start[i]; k < voxels.start[i + 1]; ++k) mean += points[voxels.order[k]];
    mean /= static_cast<float>(voxels.start[i + 1] - voxels.start[i]);
    cloud->push_back({mean.x(), mean.y(), mean.z()});
  }
  const auto members = [&](int voxel) { return voxels.start[voxel + 1] - voxels.start[voxel]; };

  const std::vector<int> inliers = without_outliers(cloud, config);
  int remaining = 0;
  for (const int voxel : inliers) remaining += members(voxel);

  auto tree = pcl::make_shared<pcl::search::KdTree<pcl::PointXYZ>>();
  auto indices = pcl::make_shared<pcl::Indices>(inliers.begin(), inliers.end());
  pcl::EuclideanClusterExtraction<pcl::PointXYZ> extraction;
  // A tolerance below the voxel's diagonal would cut every surface into its voxels.
  extraction.setClusterTolerance(std::max(config.cluster_tolerance_m, 2.0 * size));
  extraction.setMinClusterSize(1);
  extraction.setSearchMethod(tree);
  extraction.setInputCloud(cloud);
  extraction.setIndices(indices);
  std::vector<pcl::PointIndices> clusters;
  if (!inliers.empty()) extraction.extract(clusters);

  int largest = -1, largest_points = 0;
  for (std::size_t i = 0; i < clusters.size(); ++i) {
    int count = 0;
    for (const int voxel : clusters[i].indices) count += members(voxel);
    if (count > largest_points) {
      largest = static_cast<int>(i);
      largest_points = count;
    }
  }
  if (largest < 0 || largest_points < config.cluster_fraction * remaining) {
    result.rejected = "no cluster with the required share of points";
    return result;
  }
  for (const int voxel : clusters[largest].indices) {
    for (int k = voxels.start[voxel]; k < voxels.start[voxel + 1]; ++k) result.kept.push_back(voxels.order[k]);
  }
  std::sort(result.kept.begin(), result.kept.end());
  return result;
}

}  // namespace waretwin

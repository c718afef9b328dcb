#include "mapper/segment/planes.h"

#include <pcl/features/integral_image_normal.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/segmentation/organized_multi_plane_segmentation.h>

#include <algorithm>
#include <limits>

#include "core/pose.h"

namespace waretwin {

std::vector<DetectedPlane> detect_planes(const cv::Mat& depth, const Intrinsics& intrinsics, double depth_min_m, double depth_max_m,
                                         const PlaneConfig& config) {
  const int width = (depth.cols + config.stride - 1) / config.stride;
  const int height = (depth.rows + config.stride - 1) / config.stride;
  // Integral images need a few pixels each way.
  if (width < 16 || height < 16) return {};
  auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>(width, height);
  cloud->is_dense = false;
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  int valid = 0;
  for (int row = 0; row < height; ++row) {
    const auto* line = depth.ptr<float>(row * config.stride);
    for (int column = 0; column < width; ++column) {
      const float z = line[column * config.stride];
      pcl::PointXYZ& point = cloud->at(column, row);
      if (!(z > depth_min_m) || !(z <= depth_max_m)) {
        point = pcl::PointXYZ(kNan, kNan, kNan);
        continue;
      }
      const Eigen::Vector3d p_C = z * intrinsics.ray(column * config.stride, row * config.stride);
      point = pcl::PointXYZ(static_cast<float>(p_C.x()), static_cast<float>(p_C.y()), static_cast<float>(p_C.z()));
      ++valid;
    }
  }
  if (valid < config.min_inliers) return {};

  auto normals = pcl::make_shared<pcl::PointCloud<pcl::Normal>>();
  pcl::IntegralImageNormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setNormalEstimationMethod(estimation.AVERAGE_3D_GRADIENT);
  estimation.setMaxDepthChangeFactor(0.03f);
  estimation.setNormalSmoothingSize(static_cast<float>(config.normal_smoothing_px));
  estimation.setInputCloud(cloud);
  estimation.compute(*normals);

  pcl::OrganizedMultiPlaneSegmentation<pcl::PointXYZ, pcl::Normal, pcl::Label> segmentation;
  segmentation.setMinInliers(static_cast<unsigned>(config.min_inliers));
  segmentation.setAngularThreshold(to_radians(config.angle_deg));
  segmentation.setDistanceThreshold(config.distance_m);
  segmentation.setInputNormals(normals);
  segmentation.setInputCloud(cloud);
  std::vector<pcl::ModelCoefficients> coefficients;
  std::vector<pcl::PointIndices> inliers;
  segmentation.segment(coefficients, inliers);

  std::vector<DetectedPlane> planes;
  for (std::size_t i = 0; i < coefficients.size(); ++i) {
    DetectedPlane plane;
    plane.normal_C = {coefficients[i].values[0], coefficients[i].values[1], coefficients[i].values[2]};
    plane.distance = coefficients[i].values[3];
    const double length = plane.normal_C.norm();
    if (!(length > 0.0)) continue;
    plane.normal_C /= length;
    plane.distance /= length;
    if (plane.distance < 0.0) {
      plane.normal_C = -plane.normal_C;
      plane.distance = -plane.distance;
    }
    plane.inliers = static_cast<int>(inliers[i].indices.size());
    for (const int index : inliers[i].indices) plane.centroid_C += cloud->points[index].getVector3fMap().cast<double>();
    plane.centroid_C /= std::max(1, plane.inliers);
    planes.push_back(plane);
  }
  std::stable_sort(planes.begin(), planes.end(), [](const DetectedPlane& a, const DetectedPlane& b) { return a.inliers > b.inliers; });
  return planes;
}

}  // namespace waretwin

#include "mapper/associate/similarity.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace waretwin {
namespace {

constexpr double kNear = 0.01;  // metres

double dot(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) sum += static_cast<double>(a[i]) * b[i];
  return sum;
}

}  // namespace

double iou_2d(const cv::Rect2f& a, const cv::Rect2f& b) {
  const double width = std::min<double>(a.x + a.width, b.x + b.width) - std::max<double>(a.x, b.x);
  const double height = std::min<double>(a.y + a.height, b.y + b.height) - std::max<double>(a.y, b.y);
  if (width <= 0.0 || height <= 0.0) return 0.0;
  const double both = width * height;
  return both / (static_cast<double>(a.width) * a.height + static_cast<double>(b.width) * b.height - both);
}

double normalised_correlation(const std::vector<float>& a, const std::vector<float>& b) {
  const double lengths = std::sqrt(dot(a, a) * dot(b, b));
  return lengths > 0.0 ? dot(a, b) / lengths : 0.0;
}

double literal_correlation(const std::vector<float>& a, const std::vector<float>& b) {
  const double lengths = std::sqrt(dot(a, a) + dot(b, b));
  return lengths > 0.0 ? dot(a, b) / lengths : 0.0;
}

std::optional<cv::Rect2f> projected_box(const Cuboid& cuboid, const Pose& X_WC, const Intrinsics& intrinsics) {
  std::vector<Eigen::Vector3d> corners_C;
  const Pose X_CW = X_WC.inverse();
  for (const Eigen::Vector3d& corner_W : cuboid.corners()) corners_C.push_back(X_CW * corner_W);
  double low_u = std::numeric_limits<double>::infinity(), high_u = -low_u, low_v = low_u, high_v = -low_u;
  const auto add = [&](const Eigen::Vector3d& p_C) {
    const Eigen::Vector2d pixel = intrinsics.project(p_C);
    low_u = std::min(low_u, pixel.x());
    high_u = std::max(high_u, pixel.x());
    low_v = std::min(low_v, pixel.y());
    high_v = std::max(high_v, pixel.y());
  };
  for (unsigned a = 0; a < 8; ++a) {
    if (corners_C[a].z() >= kNear) add(corners_C[a]);
    for (unsigned bit = 1; bit < 8; bit <<= 1) {
      const unsigned b = a | bit;
      if (b == a || (corners_C[a].z() >= kNear) == (corners_C[b].z() >= kNear)) continue;
      const double t = (kNear - corners_C[a].z()) / (corners_C[b].z() - corners_C[a].z());
      add(corners_C[a] + t * (corners_C[b] - corners_C[a]));
    }
  }
  // Pixel (u, v) has its centre at (u, v) in the camera's coordinates and at (u + 0.5, v + 0.5) in a box's.
  const double x0 = std::clamp(low_u + 0.5, 0.0, static_cast<double>(intrinsics.width));
  const double x1 = std::clamp(high_u + 0.5, 0.0, static_cast<double>(intrinsics.width));
  const double y0 = std::clamp(low_v + 0.5, 0.0, static_cast<double>(intrinsics.height));
  const double y1 = std::clamp(high_v + 0.5, 0.0, static_cast<double>(intrinsics.height));
  if (!(x1 > x0) || !(y1 > y0)) return std::nullopt;
  return cv::Rect2f(static_cast<float>(x0), static_cast<float>(y0), static_cast<float>(x1 - x0), static_cast<float>(y1 - y0));
}

}  // namespace waretwin

#include "sim/pixel_rays.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace waretwin {

PixelRays::PixelRays(const Intrinsics& intrinsics, const Pose& X_WC, float time)
    : width_(intrinsics.width),
      height_(intrinsics.height),
      spread_(static_cast<float>(1.0 / intrinsics.fx)),
      station_{X_WC.translation().cast<float>(), X_WC.linear().cast<float>(), time},
      corner_(X_WC.linear() * intrinsics.ray(0.0, 0.0)),
      right_(X_WC.linear().col(0) / intrinsics.fx),
      down_(X_WC.linear().col(1) / intrinsics.fy) {}

PixelRays::PixelRays(const cv::Mat& directions, double spread, const std::vector<Row>& rows)
    : width_(directions.cols),
      height_(directions.rows),
      spread_(static_cast<float>(spread)),
      corner_(Eigen::Vector3d::Zero()),
      right_(Eigen::Vector3d::Zero()),
      down_(Eigen::Vector3d::Zero()),
      directions_(directions) {
  WARETWIN_CHECK(directions.type() == CV_32FC2 && directions.cols > 1 && directions.rows > 1, "two floats a pixel");
  WARETWIN_CHECK(static_cast<int>(rows.size()) == height_, "a pose for each row");
  const auto station = [](const Pose& X_WC, float time) {
    return Station{X_WC.translation().cast<float>(), X_WC.linear().cast<float>(), time};
  };
  for (const Row& row : rows) {
    rows_.push_back({station(row.X_WC_begin, row.begin), station(row.X_WC, row.middle), station(row.X_WC_end, row.end)});
    lasts_ = lasts_ || row.begin != row.end || row.X_WC_begin.matrix() != row.X_WC_end.matrix();
  }
}

Eigen::Vector2f PixelRays::bent(double u, double v) const {
  const int x = std::clamp(static_cast<int>(std::floor(u)), 0, width_ - 2), y = std::clamp(static_cast<int>(std::floor(v)), 0, height_ - 2);
  const auto fx = static_cast<float>(u - x), fy = static_cast<float>(v - y);
  const auto *top = directions_.ptr<cv::Vec2f>(y) + x, *low = directions_.ptr<cv::Vec2f>(y + 1) + x;
  const cv::Vec2f upper = top[0] + fx * (top[1] - top[0]), lower = low[0] + fx * (low[1] - low[0]);
  const cv::Vec2f both = upper + fy * (lower - upper);
  return {both[0], both[1]};
}

Ray PixelRays::at(double u, double v, float moment) const {
  Ray ray;
  if (rows_.empty()) {
    ray.origin = station_.origin;
    ray.time = station_.time;
    ray.direction = pinhole(u, v);
    return ray;
  }
  const int y = std::clamp(static_cast<int>(std::lround(v)), 0, height_ - 1);
  const Stations& row = rows_[static_cast<std::size_t>(y)];
  const Eigen::Vector2f xy = bent(u, v);
  const Eigen::Vector3f direction(xy.x(), xy.y(), 1.0f);
  // In the milliseconds of an exposure the way between is straight and turns are small: a chord in place of the arc.
  ray.time = row.begin.time + moment * (row.end.time - row.begin.time);
  ray.origin = row.begin.origin + moment * (row.end.origin - row.begin.origin);
  const Eigen::Vector3f first = row.begin.R_WC * direction, last = row.end.R_WC * direction;
  ray.direction = first + moment * (last - first);
  return ray;
}

Eigen::Matrix3f PixelRays::R_CW(int v) const {
  if (rows_.empty()) return station_.R_WC.transpose();
  return rows_[static_cast<std::size_t>(std::clamp(v, 0, height_ - 1))].middle.R_WC.transpose();
}

}  // namespace waretwin

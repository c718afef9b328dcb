#include "harness/pictures/frame_pictures.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <opencv2/imgproc.hpp>

#include "harness/pictures/rasteriser.h"

namespace waretwin {

namespace {

constexpr double kNear = 0.1;  // metres before the camera; edges are cut there

void draw_cuboid(cv::Mat& image, const Cuboid& cuboid, const Pose& X_CW, const Intrinsics& intrinsics, const cv::Scalar& colour) {
  const std::vector<Eigen::Vector3d> corners_W = cuboid.corners();
  for (const auto& [i, j] : cuboid_edges()) {
    Eigen::Vector3d a = X_CW * corners_W[static_cast<std::size_t>(i)], b = X_CW * corners_W[static_cast<std::size_t>(j)];
    if (a.z() < kNear && b.z() < kNear) continue;
    if (a.z() < kNear) a += (b - a) * (kNear - a.z()) / (b.z() - a.z());
    if (b.z() < kNear) b += (a - b) * (kNear - b.z()) / (a.z() - b.z());
    const Eigen::Vector2d u = intrinsics.project(a), v = intrinsics.project(b);
    cv::Point from(static_cast<int>(std::clamp(u.x(), -2e4, 2e4)), static_cast<int>(std::clamp(u.y(), -2e4, 2e4)));
    cv::Point to(static_cast<int>(std::clamp(v.x(), -2e4, 2e4)), static_cast<int>(std::clamp(v.y(), -2e4, 2e4)));
    cv::line(image, from, to, colour, 2, cv::LINE_AA);
  }
}

}  // namespace

cv::Mat draw_frame(const Mapper::FrameResult& result, const ObjectList& objects, const Intrinsics& intrinsics) {
  cv::Mat image = result.frame.colour.clone();
  for (std::size_t i = 0; i < result.segmentation.objects.size(); ++i) {
    if (result.map_ids[i] == 0) continue;
    const cv::Scalar tint = colour_of_id(result.map_ids[i]);
    for (const int pixel : result.segmentation.objects[i].pixels) {
      cv::Vec3b& value = image.at<cv::Vec3b>(pixel / image.cols, pixel % image.cols);
      for (int c = 0; c < 3; ++c) value[c] = cv::saturate_cast<uchar>(0.6 * value[c] + 0.4 * tint[c]);
    }
  }
  const Pose X_CW = result.X_WC.inverse();
  for (const MappedObject& object : objects) {
    draw_cuboid(image, object.cuboid, X_CW, intrinsics, colour_of_id(object.id));
    const Eigen::Vector3d centre_C = X_CW * object.cuboid.centre;
    if (centre_C.z() < kNear) continue;
    const Eigen::Vector2d at = intrinsics.project(centre_C);
    if (intrinsics.contains(at.x(), at.y())) {
      draw_text(image, {static_cast<int>(at.x()), static_cast<int>(at.y())}, std::to_string(object.id), colour_of_id(object.id), 0.8);
    }
  }
  for (const Detection& detection : result.detections) {
    cv::rectangle(image, detection.box, cv::Scalar(255, 255, 255), 1);
    char text[96];
    std::snprintf(text, sizeof text, "%.60s %.2f", detection.class_name.c_str(), static_cast<double>(detection.score));
    draw_text(image, {static_cast<int>(detection.box.x) + 4, static_cast<int>(detection.box.y) + 18}, text, cv::Scalar(255, 255, 255));
  }
  return image;
}

cv::Mat draw_depth(const cv::Mat& depth, double near_m, double far_m) {
  const double range = std::max(1e-3, far_m - near_m);
  cv::Mat nearness(depth.size(), CV_8UC1, cv::Scalar(0));
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      const float z = depth.at<float>(v, u);
      if (z > 0.0f) nearness.at<uchar>(v, u) = cv::saturate_cast<uchar>(255.0 * (1.0 - (z - near_m) / range));
    }
  }
  cv::Mat image;
  cv::applyColorMap(nearness, image, cv::COLORMAP_TURBO);
  image.setTo(cv::Scalar(0, 0, 0), depth <= 0.0f);
  char text[64];
  std::snprintf(text, sizeof text, "red %.1f m, blue %.1f m", near_m, far_m);
  draw_text(image, {12, image.rows - 14}, text, cv::Scalar(255, 255, 255), 0.6);
  return image;
}

cv::Mat draw_depth_error(const cv::Mat& sensor, const cv::Mat& ideal, double near_m, double far_m) {
  constexpr float kFull = 0.05f;
  cv::Mat error(sensor.size(), CV_8UC3, cv::Scalar::all(0));
  for (int v = 0; v < sensor.rows; ++v) {
    for (int u = 0; u < sensor.cols; ++u) {
      const float truth = ideal.at<float>(v, u), reading = sensor.at<float>(v, u);
      if (truth <= 0.0f) continue;
      if (reading <= 0.0f) {
        error.at<cv::Vec3b>(v, u) = {60, 60, 60};
        continue;
      }
      const float e = std::clamp((reading - truth) / kFull, -1.0f, 1.0f);
      const auto fade = cv::saturate_cast<uchar>(255.0f * (1.0f - std::abs(e)));
      error.at<cv::Vec3b>(v, u) = e < 0.0f ? cv::Vec3b(255, fade, fade) : cv::Vec3b(fade, fade, 255);
    }
  }
  cv::Mat panels, small;
  const std::array<cv::Mat, 3> all = {draw_depth(ideal, near_m, far_m), draw_depth(sensor, near_m, far_m), error};
  cv::hconcat(all.data(), all.size(), panels);
  cv::resize(panels, small, {}, 0.5, 0.5, cv::INTER_NEAREST);
  const int width = small.cols / 3;
  draw_text(small, {12, 22}, "ideal", cv::Scalar::all(255), 0.6);
  draw_text(small, {width + 12, 22}, "sensor", cv::Scalar::all(255), 0.6);
  draw_text(small, {2 * width + 12, 22}, "error: blue 5 cm near, red 5 cm far, grey nothing", cv::Scalar::all(255), 0.6);
  return small;
}

}  // namespace waretwin

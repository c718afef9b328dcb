#include "harness/pictures/map_pictures.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>

namespace waretwin {

namespace {

const cv::Vec3b kPaper(245, 245, 245);
const cv::Scalar kTruth(60, 180, 0), kMapped(30, 60, 235), kPath(230, 120, 20), kTruePath(90, 90, 90), kInk(30, 30, 30);
constexpr double kLongSide = 1500.0;  // pixels
constexpr int kMargin = 40;           // pixels

Eigen::AlignedBox3d bounds_of(const MapScene& scene, double ceiling) {
  // Single far-away triangles would make everything else tiny: the box holds all but half a percent of the vertices on each side.
  Eigen::AlignedBox3d box;
  std::vector<Eigen::Vector3f> points;
  for (const Eigen::Vector3f& p_W : scene.mesh.vertices) {
    if (p_W.z() <= ceiling) points.push_back(p_W);
  }
  if (!points.empty()) {
    const std::size_t low = points.size() / 200, high = points.size() - 1 - low;
    Eigen::Vector3d from, to;
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<float> values;
      for (const Eigen::Vector3f& p_W : points) values.push_back(p_W[axis]);
      std::sort(values.begin(), values.end());
      from[axis] = values[low];
      to[axis] = values[high];
    }
    box.extend(from);
    box.extend(to);
  }
  for (const auto* list : {&scene.mapped, &scene.truth}) {
    for (const ListedObject& object : *list) {
      for (const Eigen::Vector3d& corner : object.cuboid.corners()) box.extend(corner);
    }
  }
  for (const auto* path : {&scene.trajectory, &scene.true_trajectory}) {
    for (const StampedPose& point : *path) box.extend(point.X_WB.translation());
  }
  if (box.isEmpty()) box.extend(Eigen::AlignedBox3d(Eigen::Vector3d(-1, -1, 0), Eigen::Vector3d(1, 1, 1)));
  return box;
}

PictureMesh tinted(const MapScene& scene) {
  PictureMesh mesh = scene.mesh;
  for (std::size_t i = 0; i < scene.labels.size() && i < mesh.colours.size(); ++i) {
    if (scene.labels[i] == 0) continue;
    const cv::Scalar tint = colour_of_id(scene.labels[i]);
    for (std::size_t c = 0; c < 3; ++c) {
      mesh.colours[i][c] = cv::saturate_cast<std::uint8_t>(0.35 * mesh.colours[i][c] + 0.65 * tint[2 - static_cast<int>(c)]);
    }
  }
  return mesh;
}

// Id and class; the id alone where all objects are of one class, so that neighbours' labels stay apart.
std::string label_of(const ListedObject& object, const std::vector<ListedObject>& all) {
  const bool one_class = std::all_of(all.begin(), all.end(), [&](const ListedObject& o) { return o.class_name == all.front().class_name; });
  return one_class ? std::to_string(object.id) : object.class_name + " " + std::to_string(object.id);
}

void draw_path(Picture& picture, const std::vector<StampedPose>& path, const cv::Scalar& colour, int thickness) {
  for (std::size_t i = 1; i < path.size(); ++i) {
    picture.draw_line(path[i - 1].X_WB.translation(), path[i].X_WB.translation(), colour, thickness);
  }
}

void draw_outline(Picture& picture, const Cuboid& cuboid, const cv::Scalar& colour, int thickness) {
  const std::vector<Eigen::Vector3d> corners = cuboid.corners();
  for (const auto& [a, b] : {std::pair<std::size_t, std::size_t>{4, 5}, {5, 7}, {7, 6}, {6, 4}}) {
    picture.draw_line(corners[a], corners[b], colour, thickness);
  }
}

// The longest of 1, 2, 5 times a power of ten that is at most a fifth of the picture.
double scale_bar_m(const PictureView& view) {
  const double longest = 0.2 * view.width() / view.pixels_per_metre();
  const double decade = std::pow(10.0, std::floor(std::log10(longest)));
  for (const double step : {5.0, 2.0}) {
    if (step * decade <= longest) return step * decade;
  }
  return decade;
}

// A strip under the picture with the meaning of its colours and a scale bar.
cv::Mat with_legend(const cv::Mat& image, const PictureView& view, const MapScene& scene) {
  constexpr int kStrip = 44;
  cv::Mat page(image.rows + kStrip, std::max(image.cols, 640), CV_8UC3, cv::Scalar(kPaper[0], kPaper[1], kPaper[2]));
  image.copyTo(page(cv::Rect(0, 0, image.cols, image.rows)));
  const int y = image.rows + kStrip / 2;
  int x = 16;
  const auto entry = [&](const std::string& text, const cv::Scalar& colour, int thickness) {
    cv::line(page, {x, y}, {x + 26, y}, colour, thickness, cv::LINE_AA);
    cv::putText(page, text, {x + 32, y + 5}, cv::FONT_HERSHEY_SIMPLEX, 0.45, kInk, 1, cv::LINE_AA);
    x += 32 + cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, 0.45, 1, nullptr).width + 18;
  };
  if (!scene.truth.empty()) entry("true object", kTruth, 3);
  entry("mapped object", kMapped, 2);
  if (!scene.true_trajectory.empty()) entry("true path", kTruePath, 4);
  entry("estimated path", kPath, 2);

  const double metres = scale_bar_m(view);
  const int length = static_cast<int>(std::lround(metres * view.pixels_per_metre()));
  char text[32];
  std::snprintf(text, sizeof text, "%g m", metres);
  const int right = page.cols - 70;
  cv::line(page, {right - length, y}, {right, y}, kInk, 2);
  cv::line(page, {right - length, y - 5}, {right - length, y + 5}, kInk, 2);
  cv::line(page, {right, y - 5}, {right, y + 5}, kInk, 2);
  cv::putText(page, text, {right + 8, y + 5}, cv::FONT_HERSHEY_SIMPLEX, 0.45, kInk, 1, cv::LINE_AA);
  return page;
}

}  // namespace

cv::Mat draw_from_above(const MapScene& scene, double ceiling) {
  const Eigen::AlignedBox3d box = bounds_of(scene, ceiling);
  const Eigen::Vector2d extent = box.diagonal().head<2>().cwiseMax(0.5);
  const double scale = std::min(250.0, kLongSide / extent.maxCoeff());
  Picture picture(PictureView::from_above(box.min().head<2>(), box.min().head<2>() + extent, scale, kMargin), kPaper);
  picture.draw(scene.mesh, ceiling);
  draw_path(picture, scene.true_trajectory, kTruePath, 4);
  draw_path(picture, scene.trajectory, kPath, 2);
  for (const ListedObject& object : scene.truth) draw_outline(picture, object.cuboid, kTruth, 3);
  for (const ListedObject& object : scene.mapped) {
    draw_outline(picture, object.cuboid, kMapped, 2);
    picture.draw_label(object.cuboid.centre, label_of(object, scene.mapped), cv::Scalar(255, 255, 255));
  }
  return with_legend(picture.image(), picture.view(), scene);
}

cv::Mat draw_oblique(const MapScene& scene, double ceiling) {
  const Eigen::AlignedBox3d box = bounds_of(scene, ceiling);
  const double reach = std::max(1.0, box.diagonal().norm());
  // From the long side, so that the hall fills the picture's width.
  const bool along_x = box.sizes().x() >= box.sizes().y();
  const Eigen::Vector3d away = along_x ? Eigen::Vector3d(-0.35, -0.75, 0.75) : Eigen::Vector3d(-0.75, -0.35, 0.75);
  const Eigen::Vector3d target = box.center();
  Picture picture(PictureView::perspective(target + 0.68 * reach * away.normalized(), target, 1280, 720, to_radians(48.0)), kPaper);
  picture.draw(tinted(scene), ceiling);
  for (const ListedObject& object : scene.mapped) {
    picture.draw_edges(object.cuboid, colour_of_id(object.id), 1);
    picture.draw_label({object.cuboid.centre.x(), object.cuboid.centre.y(), object.cuboid.top() + 0.1}, label_of(object, scene.mapped),
                       cv::Scalar(255, 255, 255));
  }
  return picture.image();
}

}  // namespace waretwin

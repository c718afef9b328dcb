#include "harness/generate/plan_picture.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>

#include "core/pose.h"
#include "harness/pictures/rasteriser.h"

namespace waretwin {

namespace {

const cv::Vec3b kPaper(245, 245, 245);
const cv::Scalar kObject(60, 180, 0), kRoute(230, 120, 20), kStop(30, 60, 235), kInk(30, 30, 30);
constexpr double kLongSide = 1400.0;  // pixels
constexpr int kMargin = 30;
constexpr float kCeilingShare = 0.9f;  // of the hall's height: what reaches higher is left out

// Linear to sRGB, 0-255.
std::uint8_t shown(float linear) {
  const double c = std::clamp(static_cast<double>(linear), 0.0, 1.0);
  const double s = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * s));
}

// A material's colour as a whole: its factor times the mean of its texture, from every 16th pixel.
std::array<std::uint8_t, 3> mean_colour(const Scene& scene, const Material& material) {
  std::array<std::uint8_t, 3> colour{};
  Eigen::Vector3d mean = Eigen::Vector3d::Constant(255);
  if (material.base_colour_texture.texture >= 0) {
    const Texture& texture = scene.textures[static_cast<std::size_t>(material.base_colour_texture.texture)];
    mean.setZero();
    double count = 0;
    for (std::size_t i = 0; i + 3 < texture.rgba.size(); i += 4 * 16) {
      mean += Eigen::Vector3d(texture.rgba[i], texture.rgba[i + 1], texture.rgba[i + 2]);
      ++count;
    }
    mean /= std::max(1.0, count);
  }
  for (int k = 0; k < 3; ++k) {
    colour[static_cast<std::size_t>(k)] = static_cast<std::uint8_t>(std::lround(mean[k] / 255 * shown(material.base_colour[k])));
  }
  return colour;
}

PictureMesh picture_mesh(const Scene& scene) {
  std::vector<std::array<std::uint8_t, 3>> colours;
  for (const Material& material : scene.materials) colours.push_back(mean_colour(scene, material));
  PictureMesh picture;
  const std::vector<bool> moves = scene.moves();
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    if (moves[i]) continue;
    const Instance& instance = scene.instances[i];
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
    // What is cut out by alpha (tyre marks) would show as a solid strip.
    if (scene.materials[static_cast<std::size_t>(mesh.material)].alpha_mask) continue;
    const auto first = static_cast<std::uint32_t>(picture.vertices.size());
    for (const Eigen::Vector3f& p : mesh.positions) {
      picture.vertices.push_back(instance.X_WM * p);
      picture.colours.push_back(colours[static_cast<std::size_t>(mesh.material)]);
    }
    for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) {
      picture.triangles.push_back({first + mesh.triangles[t], first + mesh.triangles[t + 1], first + mesh.triangles[t + 2]});
    }
  }
  return picture;
}

void draw_scale_bar(cv::Mat& image, double pixels_per_metre) {
  const double metres = image.cols / pixels_per_metre > 20 ? 5.0 : 1.0;
  const int length = static_cast<int>(std::lround(metres * pixels_per_metre)), y = image.rows - 12, right = image.cols - 60;
  cv::line(image, {right - length, y}, {right, y}, kInk, 2);
  for (const int x : {right - length, right}) cv::line(image, {x, y - 5}, {x, y + 5}, kInk, 2);
  char text[16];
  std::snprintf(text, sizeof text, "%g m", metres);
  cv::putText(image, text, {right + 8, y + 5}, cv::FONT_HERSHEY_SIMPLEX, 0.45, kInk, 1, cv::LINE_AA);
}

}  // namespace

PictureView plan_view(const Scene& scene) {
  const Eigen::AlignedBox3f bounds = scene.bounds();
  const Eigen::Vector2d low = bounds.min().head<2>().cast<double>(), high = bounds.max().head<2>().cast<double>();
  return PictureView::from_above(low, high, kLongSide / std::max(1.0, (high - low).maxCoeff()), kMargin);
}

cv::Mat draw_plan(const Scene& scene, const RobotConfig& robot) {
  Picture picture(plan_view(scene), kPaper);
  picture.draw(picture_mesh(scene), static_cast<double>(kCeilingShare * scene.bounds().max().z()));

  const auto point = [](const Waypoint& w, double z) { return Eigen::Vector3d(w.x_m, w.y_m, z); };
  constexpr double kAbove = 0.02;
  for (std::size_t i = 1; i < robot.route.size(); ++i) {
    picture.draw_line(point(robot.route[i - 1], kAbove), point(robot.route[i], kAbove), kRoute, 2);
  }
  for (const TrueObject& object : scene.objects) picture.draw_edges(object.cuboid, kObject, 2);
  constexpr double kArrow = 0.45;  // metres
  for (const Waypoint& w : robot.route) {
    if (!w.heading_deg || w.wait_s <= 0) continue;
    const double yaw = to_radians(*w.heading_deg);
    const Eigen::Vector3d from = point(w, kAbove), tip = from + kArrow * Eigen::Vector3d(std::cos(yaw), std::sin(yaw), 0);
    picture.draw_line(from, tip, kStop, 2);
    for (const double side : {-1.0, 1.0}) {
      const double back = yaw + side * to_radians(150);
      picture.draw_line(tip, tip + 0.13 * Eigen::Vector3d(std::cos(back), std::sin(back), 0), kStop, 2);
    }
  }
  if (const auto start = picture.view().project(point(robot.route.front(), kAbove))) {
    cv::circle(picture.image(), cv::Point(static_cast<int>(start->x()), static_cast<int>(start->y())), 9, kRoute, 2, cv::LINE_AA);
  }
  for (const TrueObject& object : scene.objects) {
    picture.draw_label(object.cuboid.centre + Eigen::Vector3d(0, 0, object.cuboid.size.z() / 2), std::to_string(object.id), kObject);
  }
  draw_scale_bar(picture.image(), picture.view().pixels_per_metre());
  return picture.image();
}

}  // namespace waretwin

#include "harness/pictures/rasteriser.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace waretwin {

namespace {

constexpr double kNearPlane = 0.05;  // metres, pinhole views

// Key by which the z-buffer compares: linear in the picture for either kind of view, larger is nearer.
double nearness(double depth, bool pinhole) { return pinhole ? 1.0 / depth : -depth; }

double edge(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double u, double v) {
  return (b.x() - a.x()) * (v - a.y()) - (b.y() - a.y()) * (u - a.x());
}

}  // namespace

PictureView PictureView::from_above(const Eigen::Vector2d& low, const Eigen::Vector2d& high, double pixels_per_metre, int margin) {
  PictureView view;
  view.scale_ = pixels_per_metre;
  view.width_ = static_cast<int>(std::ceil((high.x() - low.x()) * pixels_per_metre)) + 2 * margin;
  view.height_ = static_cast<int>(std::ceil((high.y() - low.y()) * pixels_per_metre)) + 2 * margin;
  view.X_VW_.linear() << 1, 0, 0, 0, -1, 0, 0, 0, -1;  // right, towards the picture's bottom, down
  view.centre_ = {margin - low.x() * pixels_per_metre, margin + high.y() * pixels_per_metre};
  return view;
}

PictureView PictureView::perspective(const Eigen::Vector3d& eye, const Eigen::Vector3d& target, int width, int height,
                                     double vertical_fov) {
  PictureView view;
  view.pinhole_ = true;
  view.width_ = width;
  view.height_ = height;
  view.scale_ = 0.5 * height / std::tan(0.5 * vertical_fov);
  view.centre_ = {0.5 * (width - 1), 0.5 * (height - 1)};
  const Eigen::Vector3d forward = (target - eye).normalized();
  Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitZ());
  right = right.norm() > 1e-6 ? right.normalized() : Eigen::Vector3d::UnitX();
  Eigen::Matrix3d R_VW;
  R_VW.row(0) = right;
  R_VW.row(1) = forward.cross(right);
  R_VW.row(2) = forward;
  view.X_VW_.linear() = R_VW;
  view.X_VW_.translation() = -R_VW * eye;
  return view;
}

std::optional<Eigen::Vector3d> PictureView::project(const Eigen::Vector3d& p_W) const {
  const Eigen::Vector3d p = X_VW_ * p_W;
  if (!pinhole_) return Eigen::Vector3d(centre_.x() + scale_ * p.x(), centre_.y() + scale_ * p.y(), p.z());
  if (p.z() < kNearPlane) return std::nullopt;
  return Eigen::Vector3d(centre_.x() + scale_ * p.x() / p.z(), centre_.y() + scale_ * p.y() / p.z(), p.z());
}

Picture::Picture(const PictureView& view, const cv::Vec3b& background)
    : view_(view),
      image_(view.height(), view.width(), CV_8UC3, cv::Scalar(background[0], background[1], background[2])),
      inverse_depth_(view.height(), view.width(), CV_32FC1, cv::Scalar(-1e30)) {}

void Picture::draw(const PictureMesh& mesh, double ceiling) {
  for (const auto& triangle : mesh.triangles) {
    std::array<Eigen::Vector3d, 3> corners, world;
    std::array<Eigen::Vector3f, 3> colours;
    bool visible = true;
    for (std::size_t i = 0; i < 3 && visible; ++i) {
      world[i] = mesh.vertices[triangle[i]].cast<double>();
      const auto pixel = view_.project(world[i]);
      visible = pixel && world[i].z() <= ceiling;
      if (!visible) break;
      corners[i] = {pixel->x(), pixel->y(), nearness(pixel->z(), view_.pinhole())};
      const auto& c = mesh.colours[triangle[i]];
      colours[i] = {static_cast<float>(c[2]), static_cast<float>(c[1]), static_cast<float>(c[0])};
    }
    if (!visible) continue;
    const Eigen::Vector3d normal = (world[1] - world[0]).cross(world[2] - world[0]);
    if (normal.squaredNorm() < 1e-16) continue;
    // A light over the viewer's shoulder keeps every side readable.
    const Eigen::Vector3d light = (view_.direction() + Eigen::Vector3d(0.25, 0.35, -0.3)).normalized();
    const auto shade = static_cast<float>(0.55 + 0.45 * std::abs(normal.normalized().dot(light)));
    fill(corners, colours, shade);
  }
}

void Picture::fill(const std::array<Eigen::Vector3d, 3>& p, const std::array<Eigen::Vector3f, 3>& colours, float shade) {
  const double area = edge(p[0], p[1], p[2].x(), p[2].y());
  if (area == 0.0) return;
  // Outside the picture the bounds would not fit an int.
  const double low_u = std::max(0.0, std::ceil(std::min({p[0].x(), p[1].x(), p[2].x()})));
  const double high_u = std::min(view_.width() - 1.0, std::floor(std::max({p[0].x(), p[1].x(), p[2].x()})));
  const double low_v = std::max(0.0, std::ceil(std::min({p[0].y(), p[1].y(), p[2].y()})));
  const double high_v = std::min(view_.height() - 1.0, std::floor(std::max({p[0].y(), p[1].y(), p[2].y()})));
  for (int v = static_cast<int>(low_v); v <= high_v; ++v) {
    for (int u = static_cast<int>(low_u); u <= high_u; ++u) {
      const double a = edge(p[1], p[2], u, v) / area, b = edge(p[2], p[0], u, v) / area, c = edge(p[0], p[1], u, v) / area;
      if (a < 0.0 || b < 0.0 || c < 0.0) continue;
      const auto near = static_cast<float>(a * p[0].z() + b * p[1].z() + c * p[2].z());
      if (near <= inverse_depth_.at<float>(v, u)) continue;
      inverse_depth_.at<float>(v, u) = near;
      const Eigen::Vector3f colour =
          shade * (static_cast<float>(a) * colours[0] + static_cast<float>(b) * colours[1] + static_cast<float>(c) * colours[2]);
      image_.at<cv::Vec3b>(v, u) = {cv::saturate_cast<uchar>(colour[0]), cv::saturate_cast<uchar>(colour[1]),
                                    cv::saturate_cast<uchar>(colour[2])};
    }
  }
}

void Picture::draw_line(const Eigen::Vector3d& a_W, const Eigen::Vector3d& b_W, const cv::Scalar& colour, int thickness) {
  const auto a = view_.project(a_W), b = view_.project(b_W);
  if (!a || !b || a->head<2>().cwiseAbs().maxCoeff() > 1e4 || b->head<2>().cwiseAbs().maxCoeff() > 1e4) return;
  cv::line(image_, cv::Point2d(a->x(), a->y()), cv::Point2d(b->x(), b->y()), colour, thickness, cv::LINE_AA);
}

void Picture::draw_edges(const Cuboid& cuboid, const cv::Scalar& colour, int thickness) {
  const std::vector<Eigen::Vector3d> corners = cuboid.corners();
  for (const auto& [a, b] : cuboid_edges())
    draw_line(corners[static_cast<std::size_t>(a)], corners[static_cast<std::size_t>(b)], colour, thickness);
}

void Picture::draw_label(const Eigen::Vector3d& p_W, const std::string& text, const cv::Scalar& colour) {
  const auto p = view_.project(p_W);
  if (!p || p->head<2>().cwiseAbs().maxCoeff() > 1e4) return;
  const cv::Size size = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, 0.5, 1, nullptr);
  draw_text(image_, cv::Point(static_cast<int>(p->x()) - size.width / 2, static_cast<int>(p->y()) + size.height / 2), text, colour);
}

const std::array<std::array<int, 2>, 12>& cuboid_edges() {
  static const std::array<std::array<int, 2>, 12> edges = {
      {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3}, {4, 6}, {5, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};
  return edges;
}

void draw_text(cv::Mat& image, const cv::Point& at, const std::string& text, const cv::Scalar& colour, double scale) {
  cv::putText(image, text, at, cv::FONT_HERSHEY_SIMPLEX, scale, cv::Scalar(20, 20, 20), 4, cv::LINE_AA);
  cv::putText(image, text, at, cv::FONT_HERSHEY_SIMPLEX, scale, colour, 1, cv::LINE_AA);
}

cv::Scalar colour_of_id(int id) {
  // Steps of the golden angle around the hue circle keep neighbours apart.
  const double hue = std::fmod(0.07 + 0.61803398875 * id, 1.0) * 6.0;
  const auto channel = [hue](double offset) {
    const double k = std::fmod(offset + hue, 6.0);
    return 255.0 * (0.95 - 0.8 * std::clamp(std::min(k, 4.0 - k), 0.0, 1.0));
  };
  return {channel(1.0), channel(3.0), channel(5.0)};
}

}  // namespace waretwin

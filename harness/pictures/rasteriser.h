// A small z-buffer rasteriser for pictures of the map: triangles and lines, coloured by vertex.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

#include "core/cuboid.h"
#include "core/pose.h"

namespace waretwin {

// A triangle mesh as pictures need it.
struct PictureMesh {
  std::vector<Eigen::Vector3f> vertices;             // metres, world
  std::vector<std::array<std::uint8_t, 3>> colours;  // red, green, blue; one a vertex
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

// Where a picture is taken from. World points go to pixels; depth grows away from the viewer.
class PictureView {
 public:
  // Looks straight down on [low, high] in x-y; `pixels_per_metre` as given, y of the world up in the picture, with a margin in pixels.
  static PictureView from_above(const Eigen::Vector2d& low, const Eigen::Vector2d& high, double pixels_per_metre, int margin);
  // A pinhole camera at `eye` that looks at `target`, the world's z up in the picture.
  static PictureView perspective(const Eigen::Vector3d& eye, const Eigen::Vector3d& target, int width, int height, double vertical_fov);

  int width() const { return width_; }
  int height() const { return height_; }
  bool pinhole() const { return pinhole_; }
  double pixels_per_metre() const { return scale_; }  // from above
  // (u, v, depth); nothing behind a pinhole camera.
  std::optional<Eigen::Vector3d> project(const Eigen::Vector3d& p_W) const;
  // Unit vector from the viewer into the scene.
  Eigen::Vector3d direction() const { return X_VW_.linear().row(2).transpose(); }

 private:
  int width_ = 0, height_ = 0;
  bool pinhole_ = false;
  double scale_ = 1.0;  // pixels per metre, or focal length in pixels
  Pose X_VW_ = Pose::Identity();
  Eigen::Vector2d centre_ = Eigen::Vector2d::Zero();  // pixel of the view's axis
};

class Picture {
 public:
  Picture(const PictureView& view, const cv::Vec3b& background);

  // Shaded by the angle between face and view; triangles with a vertex above `ceiling` (metres) are left out.
  void draw(const PictureMesh& mesh, double ceiling);
  // Lines on top of everything. Colours are blue, green, red.
  void draw_line(const Eigen::Vector3d& a_W, const Eigen::Vector3d& b_W, const cv::Scalar& colour, int thickness);
  void draw_edges(const Cuboid& cuboid, const cv::Scalar& colour, int thickness);
  // Text with a dark rim, centred on a point of the world.
  void draw_label(const Eigen::Vector3d& p_W, const std::string& text, const cv::Scalar& colour);

  const PictureView& view() const { return view_; }
  cv::Mat& image() { return image_; }  // CV_8UC3, BGR

 private:
  void fill(const std::array<Eigen::Vector3d, 3>& corners, const std::array<Eigen::Vector3f, 3>& colours, float shade);

  PictureView view_;
  cv::Mat image_;
  cv::Mat inverse_depth_;  // CV_32FC1, larger is nearer
};

// The 12 edges of a cuboid as pairs of indices into Cuboid::corners().
const std::array<std::array<int, 2>, 12>& cuboid_edges();

// Text with a rim at a pixel (its left end on the base line), readable on any background.
void draw_text(cv::Mat& image, const cv::Point& at, const std::string& text, const cv::Scalar& colour, double scale = 0.5);

// A distinct colour for an object id, as blue, green, red; the same in every picture.
cv::Scalar colour_of_id(int id);

}  // namespace waretwin

#include "sensors/recordings/picture_loader.h"

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "core/error.h"

namespace waretwin {

namespace {

void check_size(const cv::Mat& image, const std::string& name, const Intrinsics& camera) {
  if (image.cols == camera.width && image.rows == camera.height) return;
  throw Error(name + ": has " + std::to_string(image.cols) + " x " + std::to_string(image.rows) + " pixels; expected " +
              std::to_string(camera.width) + " x " + std::to_string(camera.height));
}

}  // namespace

TurnedCamera turned_camera(const Intrinsics& stored, int quarter_turns) {
  TurnedCamera turned{stored, Pose::Identity()};
  // One quarter: the picture's left edge becomes its upper one. Pixel (u, v) goes to (height - 1 - v, u).
  Eigen::Matrix3d quarter;
  quarter << 0, 1, 0,  //
      -1, 0, 0,        //
      0, 0, 1;
  for (int i = 0; i < quarter_turns; ++i) {
    const Intrinsics k = turned.intrinsics;
    turned.intrinsics = Intrinsics::checked(k.height, k.width, k.fy, k.fx, k.height - 1 - k.cy, k.cx);
    turned.X_CT.linear() = turned.X_CT.linear() * quarter;
  }
  return turned;
}

PictureLoader::PictureLoader(Plan plan) : plan_(std::move(plan)) {
  if (plan_.stored.distortion().is_none()) return;
  const Intrinsics& k = plan_.view;
  map_.create(k.height, k.width, CV_32FC2);
  for (int v = 0; v < k.height; ++v) {
    for (int u = 0; u < k.width; ++u) {
      const auto at = plan_.stored.project(Eigen::Vector3d((u - k.cx) / k.fx, (v - k.cy) / k.fy, 1.0));
      // What the lens never saw lies far outside and becomes black, or invalid.
      map_.at<cv::Vec2f>(v, u) = at ? cv::Vec2f(static_cast<float>(at->x()), static_cast<float>(at->y())) : cv::Vec2f(-1e6f, -1e6f);
    }
  }
}

cv::Mat PictureLoader::upright(const cv::Mat& stored, int interpolation) const {
  cv::Mat view = stored;
  if (!map_.empty()) cv::remap(stored, view, map_, cv::noArray(), interpolation, cv::BORDER_CONSTANT);
  if (plan_.quarter_turns == 0) return view;
  cv::Mat turned;
  cv::rotate(view, turned, cv::ROTATE_90_CLOCKWISE + plan_.quarter_turns - 1);
  return turned;
}

void PictureLoader::load(const RecordedFrame& recorded, RgbdFrame& frame) const {
  const Intrinsics& stored = plan_.stored.intrinsics();
  const cv::Mat colour = recorded.colour.read();
  check_size(colour, recorded.colour.name, stored);
  const cv::Mat depth = recorded.depth.read();
  check_size(depth, recorded.depth.name, stored);
  cv::Mat native;
  if (plan_.native && recorded.native_depth) {
    native = recorded.native_depth.read();
    check_size(native, recorded.native_depth.name, *plan_.native);
    native = depth_in_metres(native, plan_.units);
  }
  frame.colour = upright(colour, cv::INTER_LINEAR);
  // Depth of two surfaces never mixes.
  frame.depth = depth_in_metres(upright(depth, cv::INTER_NEAREST), plan_.units);
  frame.native_depth = native;
}

}  // namespace waretwin

#include "mapper/associate/box_views.h"

#include <algorithm>
#include <limits>

#include "mapper/associate/similarity.h"

namespace waretwin {

void BoxViews::add(const BoxView& view) {
  if (least_ == 0 || offered_++ % step_ != 0) return;
  views_.push_back(view);
  thin();
}

void BoxViews::add(const BoxViews& other) {
  BoxViews theirs = other;
  while (theirs.step_ > step_) halve();
  while (step_ > theirs.step_) theirs.halve();
  views_.insert(views_.end(), theirs.views_.begin(), theirs.views_.end());
  offered_ += theirs.offered_;
  thin();
}

void BoxViews::thin() {
  while (least_ > 0 && views_.size() >= 2 * least_) halve();
}

void BoxViews::halve() {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < views_.size(); i += 2) views_[kept++] = views_[i];
  views_.resize(kept);
  step_ *= 2;
}

ShownBoxes BoxViews::shown(const std::vector<Eigen::Vector3f>& points_W, double radius) const {
  constexpr float kNear = 0.05f;  // metres before the camera
  ShownBoxes boxes;
  boxes.reserve(views_.size());
  for (const BoxView& view : views_) {
    const Pose X_CW = view.X_WC.inverse();
    const Eigen::Matrix3f R = X_CW.linear().cast<float>();
    const Eigen::Vector3f t = X_CW.translation().cast<float>();
    const Intrinsics& in = view.intrinsics;
    const auto fx = static_cast<float>(in.fx), fy = static_cast<float>(in.fy), r = static_cast<float>(radius);
    Eigen::Array2f low = Eigen::Array2f::Constant(std::numeric_limits<float>::infinity()), high = -low;
    for (const Eigen::Vector3f& p_W : points_W) {
      const Eigen::Vector3f p = R * p_W + t;
      if (p.z() < kNear) continue;
      const Eigen::Array2f middle(fx * p.x() / p.z(), fy * p.y() / p.z()), reach(fx * r / p.z(), fy * r / p.z());
      low = low.min(middle - reach);
      high = high.max(middle + reach);
    }
    // Boxes count from the picture's corner, half a pixel before the centre of its first pixel.
    const Eigen::Array2f centre(static_cast<float>(in.cx) + 0.5f, static_cast<float>(in.cy) + 0.5f);
    low = (low + centre).max(0.0f);
    high = (high + centre).min(Eigen::Array2f(static_cast<float>(in.width), static_cast<float>(in.height)));
    const bool none = !(low < high).all();
    boxes.push_back(none ? cv::Rect2f() : cv::Rect2f(low.x(), low.y(), high.x() - low.x(), high.y() - low.y()));
  }
  return boxes;
}

ShownBoxes BoxViews::shown(const Cuboid& cuboid) const {
  ShownBoxes boxes;
  boxes.reserve(views_.size());
  for (const BoxView& view : views_) boxes.push_back(projected_box(cuboid, view.X_WC, view.intrinsics).value_or(cv::Rect2f()));
  return boxes;
}

double BoxViews::match(const ShownBoxes& shown) const {
  if (views_.empty()) return 0.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < views_.size(); ++i) sum += iou_2d(shown[i], views_[i].box);
  return sum / static_cast<double>(views_.size());
}

ShownBoxes united(const ShownBoxes& a, const ShownBoxes& b) {
  ShownBoxes both(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) both[i] = a[i].empty() ? b[i] : b[i].empty() ? a[i] : (a[i] | b[i]);
  return both;
}

}  // namespace waretwin

// The 2D boxes in which an object was detected, with the views they were drawn in: what a guess at its extent is held against.
#pragma once

#include <Eigen/Core>
#include <opencv2/core/types.hpp>
#include <vector>

#include "core/cuboid.h"
#include "core/pose.h"
#include "sensors/intrinsics.h"

namespace waretwin {

struct BoxView {
  Pose X_WC = Pose::Identity();
  Intrinsics intrinsics;
  cv::Rect2f box;  // pixels
};

// The boxes around what each view of a list shows of some part of an object; empty where it shows none.
using ShownBoxes = std::vector<cv::Rect2f>;

class BoxViews {
 public:
  // Of twice `least` views every second one is dropped: those that stay are spread over all. 0: none is kept.
  explicit BoxViews(std::size_t least) : least_(least) {}

  void add(const BoxView& view);
  void add(const BoxViews& other);
  bool empty() const { return views_.empty(); }

  // The boxes around balls of `radius` metres at `points_W`, cut off at the pictures' edges.
  ShownBoxes shown(const std::vector<Eigen::Vector3f>& points_W, double radius) const;
  // The boxes around a cuboid.
  ShownBoxes shown(const Cuboid& cuboid) const;
  // How well these match the detected boxes: the mean of their 2D IoU (eq. 3 of the paper), in [0, 1]. Without any view 0.
  double match(const ShownBoxes& shown) const;

 private:
  void thin();
  void halve();

  std::size_t least_;
  std::vector<BoxView> views_;
  std::size_t step_ = 1, offered_ = 0;
};

// Around both boxes of each view.
ShownBoxes united(const ShownBoxes& a, const ShownBoxes& b);

}  // namespace waretwin

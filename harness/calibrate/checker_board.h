// The checkerboard that camera and laser look at, and its corners in a picture.
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

#include "core/fields.h"

namespace waretwin {

// The board's frame O: origin in the middle of the printed squares, x along its rows, y along its columns, z into the board. The defaults
// are those of board.glb (scenes/agiprobot).
struct CheckerBoard {
  int columns = 9, rows = 6;  // inner corners, where four squares meet
  double square_m = 0.07;     // edge of a square

  std::vector<Eigen::Vector3d> corners_O() const;  // row by row
  // Half the size of what the squares cover: (columns + 1) by (rows + 1) of them.
  Eigen::Vector2d half_size() const { return 0.5 * square_m * Eigen::Vector2d(columns + 1, rows + 1); }
  void visit(Fields& f);
};

// Corners in pixels (the middle of the upper left pixel is 0, 0), in the order of corners_O; of the two orders that look alike the one
// whose first corner lies more to the upper left. Nothing where the picture (BGR) does not show the whole board.
std::optional<std::vector<Eigen::Vector2d>> find_corners(const cv::Mat& picture, const CheckerBoard& board);

// The same for a board that should still stand where `before` saw it, in its order: quick, and sees a board that find_corners misses for a
// little noise. Nothing where a corner is more than `within_px` away, or there is no checkerboard between them.
std::optional<std::vector<Eigen::Vector2d>> find_corners_again(const cv::Mat& picture, const CheckerBoard& board,
                                                               const std::vector<Eigen::Vector2d>& before, double within_px);

}  // namespace waretwin

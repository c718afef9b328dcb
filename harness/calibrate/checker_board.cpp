#include "harness/calibrate/checker_board.h"

#include <algorithm>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace waretwin {

std::vector<Eigen::Vector3d> CheckerBoard::corners_O() const {
  std::vector<Eigen::Vector3d> corners;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      corners.emplace_back(square_m * (column - 0.5 * (columns - 1)), square_m * (row - 0.5 * (rows - 1)), 0.0);
    }
  }
  return corners;
}

void CheckerBoard::visit(Fields& f) {
  f("columns", columns, "inner corners along a row", {.min = 3, .max = 50});
  f("rows", rows, "inner corners along a column", {.min = 3, .max = 50});
  f("square_m", square_m, "edge of a square", {.min = 0.001, .max = 2});
}

std::optional<std::vector<Eigen::Vector2d>> find_corners(const cv::Mat& picture, const CheckerBoard& board) {
  cv::Mat grey;
  cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
  const cv::Size size(board.columns, board.rows);
  std::vector<cv::Point2f> found;
  // The quick look alone decides whether there is a board; most pictures of a long recording have none.
  if (!cv::findChessboardCorners(grey, size, found, cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_FAST_CHECK))
    return std::nullopt;
  // As wide as fits between neighbours: a window that holds a second corner would be drawn to it.
  double nearest = 1e9;
  for (std::size_t i = 1; i < found.size(); ++i) {
    if (i % static_cast<std::size_t>(board.columns) != 0) nearest = std::min(nearest, cv::norm(found[i] - found[i - 1]));
    if (i >= static_cast<std::size_t>(board.columns)) {
      nearest = std::min(nearest, cv::norm(found[i] - found[i - static_cast<std::size_t>(board.columns)]));
    }
  }
  const int half = std::clamp(static_cast<int>(0.35 * nearest), 2, 11);
  cv::cornerSubPix(grey, found, {half, half}, {-1, -1}, {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 50, 1e-4});
  const cv::Point2f across = found.back() - found.front();
  if (across.x + across.y < 0.0f) std::reverse(found.begin(), found.end());
  std::vector<Eigen::Vector2d> corners;
  for (const cv::Point2f& p : found) corners.emplace_back(static_cast<double>(p.x), static_cast<double>(p.y));
  return corners;
}

}  // namespace waretwin

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

namespace {

// To a fraction of a pixel, in a window as wide as fits between neighbours: one that holds a second corner would be drawn to it.
void sharpen(const cv::Mat& grey, const CheckerBoard& board, std::vector<cv::Point2f>& corners) {
  const auto columns = static_cast<std::size_t>(board.columns);
  double nearest = 1e9;
  for (std::size_t i = 1; i < corners.size(); ++i) {
    if (i % columns != 0) nearest = std::min(nearest, cv::norm(corners[i] - corners[i - 1]));
    if (i >= columns) nearest = std::min(nearest, cv::norm(corners[i] - corners[i - columns]));
  }
  const int half = std::clamp(static_cast<int>(0.35 * nearest), 2, 11);
  cv::cornerSubPix(grey, corners, {half, half}, {-1, -1}, {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 50, 1e-4});
}

// Of the squares between the corners those of one colour are all brighter than those of the other.
bool is_checkered(const cv::Mat& grey, const CheckerBoard& board, const std::vector<cv::Point2f>& corners) {
  constexpr double kLeastContrast = 10.0;  // grey levels
  double least[2] = {1e9, 1e9}, most[2] = {-1e9, -1e9};
  for (int row = 0; row + 1 < board.rows; ++row) {
    for (int column = 0; column + 1 < board.columns; ++column) {
      const auto i = static_cast<std::size_t>(row * board.columns + column), below = i + static_cast<std::size_t>(board.columns);
      const cv::Point2f middle = 0.25f * (corners[i] + corners[i + 1] + corners[below] + corners[below + 1]);
      const cv::Rect patch = cv::Rect(cvRound(middle.x) - 1, cvRound(middle.y) - 1, 3, 3) & cv::Rect({}, grey.size());
      if (patch.empty()) return false;
      const double level = cv::mean(grey(patch))[0];
      const int colour = (row + column) % 2;
      least[colour] = std::min(least[colour], level);
      most[colour] = std::max(most[colour], level);
    }
  }
  return std::max(least[0] - most[1], least[1] - most[0]) >= kLeastContrast;
}

cv::Mat grey_of(const cv::Mat& picture) {
  cv::Mat grey;
  cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
  return grey;
}

std::vector<Eigen::Vector2d> to_eigen(const std::vector<cv::Point2f>& points) {
  std::vector<Eigen::Vector2d> corners;
  for (const cv::Point2f& p : points) corners.emplace_back(static_cast<double>(p.x), static_cast<double>(p.y));
  return corners;
}

}  // namespace

std::optional<std::vector<Eigen::Vector2d>> find_corners(const cv::Mat& picture, const CheckerBoard& board) {
  const cv::Mat grey = grey_of(picture);
  const cv::Size size(board.columns, board.rows);
  std::vector<cv::Point2f> found;
  // The quick look alone refuses most pictures of a long recording. Noise breaks now and then a square's edge; a little blur mends it.
  constexpr int kHow = cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_FAST_CHECK;
  if (!cv::findChessboardCorners(grey, size, found, kHow)) {
    cv::Mat soft;
    cv::GaussianBlur(grey, soft, {}, 1.0);
    if (!cv::findChessboardCorners(soft, size, found, kHow)) return std::nullopt;
  }
  sharpen(grey, board, found);
  if (!is_checkered(grey, board, found)) return std::nullopt;
  const cv::Point2f across = found.back() - found.front();
  if (across.x + across.y < 0.0f) std::reverse(found.begin(), found.end());
  return to_eigen(found);
}

std::optional<std::vector<Eigen::Vector2d>> find_corners_again(const cv::Mat& picture, const CheckerBoard& board,
                                                               const std::vector<Eigen::Vector2d>& before, double within_px) {
  const cv::Mat grey = grey_of(picture);
  // cornerSubPix leaves a point where it was when it finds none in its window: begun beside the corner, that shows.
  const auto beside = static_cast<float>(within_px + 1.0);
  std::vector<cv::Point2f> found;
  for (const Eigen::Vector2d& p : before) found.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()));
  if (!is_checkered(grey, board, found)) return std::nullopt;
  for (cv::Point2f& p : found) p += cv::Point2f(beside, 0.0f);
  sharpen(grey, board, found);
  std::vector<Eigen::Vector2d> corners = to_eigen(found);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if ((corners[i] - before[i]).norm() > within_px) return std::nullopt;
  }
  return corners;
}

}  // namespace waretwin

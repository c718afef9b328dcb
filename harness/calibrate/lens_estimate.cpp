#include "harness/calibrate/lens_estimate.h"

#include <opencv2/calib3d.hpp>

#include "core/error.h"

namespace waretwin {

void LensConfig::visit(Fields& f) {
  f("estimate", estimate, "the camera's intrinsics are estimated, too, and told beside those that the stream names");
  f("distortion", distortion, "with k1, k2, p1 and p2");
}

LensEstimate estimate_lens(const std::vector<std::vector<Eigen::Vector2d>>& corners, const CheckerBoard& board, const Intrinsics& given,
                           const LensConfig& config) {
  if (corners.size() < 3) {
    throw Error("--intrinsics: the camera saw " + std::to_string(corners.size()) + " board poses; expected at least 3");
  }
  std::vector<std::vector<cv::Point3f>> on_board;
  std::vector<std::vector<cv::Point2f>> in_picture;
  for (const auto& view : corners) {
    on_board.emplace_back();
    for (const Eigen::Vector3d& p : board.corners_O())
      on_board.back().emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()), 0.0f);
    in_picture.emplace_back();
    for (const Eigen::Vector2d& p : view) in_picture.back().emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()));
  }
  cv::Mat k = (cv::Mat_<double>(3, 3) << given.fx, 0, given.cx, 0, given.fy, given.cy, 0, 0, 1);
  cv::Mat lens = cv::Mat::zeros(5, 1, CV_64F), sigmas, sigmas_of_views, errors;
  std::vector<cv::Mat> turns, shifts;
  int flags = cv::CALIB_USE_INTRINSIC_GUESS | cv::CALIB_FIX_K3;
  if (!config.distortion) flags |= cv::CALIB_FIX_K1 | cv::CALIB_FIX_K2 | cv::CALIB_ZERO_TANGENT_DIST;
  LensEstimate estimate;
  estimate.rms_px = cv::calibrateCamera(on_board, in_picture, {given.width, given.height}, k, lens, turns, shifts, sigmas, sigmas_of_views,
                                        errors, flags, {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 100, 1e-12});
  estimate.values << k.at<double>(0, 0), k.at<double>(1, 1), k.at<double>(0, 2), k.at<double>(1, 2), lens.at<double>(0), lens.at<double>(1),
      lens.at<double>(2), lens.at<double>(3);
  for (int i = 0; i < 8; ++i) estimate.sigmas[i] = sigmas.at<double>(i);
  if (!estimate.values.allFinite())
    throw Error("--intrinsics: the corners leave the camera's intrinsics open; expected boards turned and tilted differently");
  estimate.poses = static_cast<int>(corners.size());
  return estimate;
}

}  // namespace waretwin

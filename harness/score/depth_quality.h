// How far the depth that the mapper got is from the depth that was there.
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core/mat.hpp>

namespace waretwin {

// Shares in [0, 1]; 0 where nothing was counted. Only pixels count that lie in the depth field and show a surface within the camera's
// range.
struct DepthQuality {
  double valid_share = 0.0;           // pixels with a reading
  double object_missing_share = 0.0;  // pixels of true objects without a reading (dark belts, grazing sides, parallax shadows)
  // Of the readings within two pixels of an object's edge where the surface breaks off by more than 4 cm: those that lie more than 1 cm
  // from the nearer and the farther surface, in between.
  double flying_share = 0.0;
  double median_abs_error_m = 0.0, p95_abs_error_m = 0.0;  // of all readings; to a millimetre, 1 m at most
};

class DepthQualityMeter {
 public:
  // `sensor` and `ideal`: CV_32FC1, metres along the optical axis, 0 = none. `instances`: CV_16UC1, 0 = background. `field`: CV_8UC1, 0 =
  // outside. All of one size.
  void add(const cv::Mat& sensor, const cv::Mat& ideal, const cv::Mat& instances, const cv::Mat& field, double near_m, double far_m);
  DepthQuality result() const;

 private:
  std::int64_t pixels_ = 0, valid_ = 0, object_pixels_ = 0, object_missing_ = 0, edge_readings_ = 0, flying_ = 0;
  std::array<std::int64_t, 1001> errors_mm_{};
};

}  // namespace waretwin

#include "mapper/detect/resized_picture.h"

#include <gtest/gtest.h>

#include <cmath>

namespace waretwin {
namespace {

cv::Mat resized(const cv::Mat& picture, const cv::Size& size) {
  cv::Mat out(size, CV_8UC3);
  resize_picture(picture, out);
  return out;
}

TEST(ResizedPicture, KeepsTheLightOfThinThings) {
  // Lines one pixel wide, 37 apart: whatever the size, they keep their share of the light.
  cv::Mat picture(720, 1280, CV_8UC3, cv::Scalar::all(20));
  for (int x = 5; x < picture.cols; x += 37) picture.col(x).setTo(cv::Scalar::all(220));
  const double expected = cv::mean(picture)[0];
  for (const cv::Size size : {cv::Size(1120, 640), cv::Size(640, 360), cv::Size(576, 320), cv::Size(448, 256), cv::Size(160, 96),
                              cv::Size(320, 640), cv::Size(320, 800)}) {
    const cv::Mat out = resized(picture, size);
    EXPECT_NEAR(cv::mean(out)[0], expected, 0.6) << size;
    for (int x = 5; x < picture.cols - 37; x += 37) {
      const auto at = static_cast<int>((x + 0.5) * size.width / picture.cols);
      const cv::Mat near = out.colRange(std::max(at - 1, 0), std::min(at + 2, size.width));
      double brightest = 0.0;
      cv::minMaxLoc(near.reshape(1), nullptr, &brightest);
      EXPECT_GT(brightest, 20.0 + 60.0 * size.width / picture.cols) << size << " at " << x;
    }
  }
}

TEST(ResizedPicture, IsNearlyTheMeanOverAreas) {
  cv::Mat picture(720, 1280, CV_8UC3);
  cv::randu(picture, 0, 256);
  cv::GaussianBlur(picture, picture, {0, 0}, 3.0);
  for (const cv::Size size : {cv::Size(576, 320), cv::Size(448, 256), cv::Size(300, 300)}) {
    cv::Mat areas;
    cv::resize(picture, areas, size, 0, 0, cv::INTER_AREA);
    EXPECT_LT(cv::norm(resized(picture, size), areas, cv::NORM_L1) / static_cast<double>(3 * size.area()), 1.0) << size;
  }
  // Larger ones are interpolated.
  EXPECT_EQ(cv::norm(resized(cv::Mat(90, 160, CV_8UC3, cv::Scalar(1, 2, 3)), {320, 192}), cv::Mat(192, 320, CV_8UC3, cv::Scalar(1, 2, 3)),
                     cv::NORM_INF),
            0.0);
}

}  // namespace
}  // namespace waretwin

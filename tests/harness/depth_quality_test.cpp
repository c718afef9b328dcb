#include "harness/score/depth_quality.h"

#include <gtest/gtest.h>

namespace waretwin {
namespace {

// A wall at 2 m with an object at 1 m before it, columns 40 to 59.
struct Pictures {
  cv::Mat ideal{50, 100, CV_32FC1, cv::Scalar(2.0)};
  cv::Mat instances{50, 100, CV_16UC1, cv::Scalar(0)};
  cv::Mat field{50, 100, CV_8UC1, cv::Scalar(255)};
  cv::Mat sensor;
  Pictures() {
    ideal.colRange(40, 60).setTo(1.0);
    instances.colRange(40, 60).setTo(7);
    sensor = ideal.clone();
  }
  DepthQuality quality() const {
    DepthQualityMeter meter;
    meter.add(sensor, ideal, instances, field, 0.5, 3.0);
    return meter.result();
  }
};

TEST(DepthQuality, TrueDepthHasNoErrors) {
  const DepthQuality q = Pictures().quality();
  EXPECT_EQ(q.valid_share, 1.0);
  EXPECT_EQ(q.object_missing_share, 0.0);
  EXPECT_EQ(q.flying_share, 0.0);
  EXPECT_EQ(q.p95_abs_error_m, 0.0);
}

TEST(DepthQuality, CountsMissingPixelsInFieldAndRangeOnly) {
  Pictures p;
  p.sensor.colRange(50, 60).setTo(0);
  EXPECT_NEAR(p.quality().valid_share, 0.9, 1e-12);
  EXPECT_NEAR(p.quality().object_missing_share, 0.5, 1e-12);
  p.field.colRange(55, 100).setTo(0);
  EXPECT_NEAR(p.quality().valid_share, 50.0 / 55.0, 1e-12);
  p.ideal.colRange(0, 10).setTo(3.5);
  EXPECT_NEAR(p.quality().valid_share, 40.0 / 45.0, 1e-12);
}

TEST(DepthQuality, FindsFlyingPixelsBetweenTheSurfaces) {
  Pictures p;
  p.sensor.col(40).setTo(1.5);
  // Two pixels either side of two edges are edge pixels.
  EXPECT_NEAR(p.quality().flying_share, 1.0 / 8.0, 1e-12);
  p.sensor.col(40).setTo(1.005);
  EXPECT_EQ(p.quality().flying_share, 0.0);
  p.sensor.col(40).setTo(2.0);  // the other surface, not in between
  EXPECT_EQ(p.quality().flying_share, 0.0);
  p.sensor.col(20).setTo(1.5);  // far from the object
  EXPECT_EQ(p.quality().flying_share, 0.0);
}

TEST(DepthQuality, QuantilesOfTheError) {
  Pictures p;
  p.sensor = p.ideal + 0.004;
  p.sensor.rowRange(0, 5).setTo(2.5);  // a tenth is 0.5 m or 1.5 m off
  EXPECT_NEAR(p.quality().median_abs_error_m, 0.004, 1e-9);
  EXPECT_NEAR(p.quality().p95_abs_error_m, 0.5, 1e-9);
}

TEST(DepthQuality, OfNothingIsZero) {
  const DepthQuality q = DepthQualityMeter().result();
  EXPECT_EQ(q.valid_share, 0.0);
  EXPECT_EQ(q.median_abs_error_m, 0.0);
}

}  // namespace
}  // namespace waretwin

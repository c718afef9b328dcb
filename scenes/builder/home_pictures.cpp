#include "scenes/builder/home_pictures.h"

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "scenes/builder/paint.h"

namespace waretwin::builder {
namespace {

using cv::Mat;
using cv::Point;
using cv::Scalar;

void sky(Mat& p, const Scalar& above, const Scalar& below, int horizon) {
  for (int y = 0; y < horizon; ++y) {
    const double t = static_cast<double>(y) / horizon;
    cv::line(p, {0, y}, {p.cols - 1, y}, above * (1 - t) + below * t);
  }
}

// A ridge of hills from noise, filled down to the lower edge.
void ridge(Mat& p, int base, int rise, const Scalar& colour, const std::string& key) {
  const Mat noise = tiling_noise(p.cols, 8, 3, 4, key);
  for (int x = 0; x < p.cols; ++x) {
    const int top = base - static_cast<int>(rise * static_cast<double>(noise.at<float>(0, x)));
    cv::line(p, {x, top}, {x, p.rows - 1}, colour);
  }
}

}  // namespace

Mat draw_landscape_screen() {
  Mat p(270, 480, CV_8UC3, Scalar(0, 0, 0));
  sky(p, {196, 128, 60}, {190, 206, 240}, 150);
  cv::circle(p, {350, 108}, 24, {200, 236, 255}, cv::FILLED, cv::LINE_AA);
  ridge(p, 168, 90, {150, 110, 92}, "far hills");
  ridge(p, 196, 70, {96, 96, 60}, "near hills");
  cv::rectangle(p, {0, 200}, {479, 269}, {150, 112, 52}, cv::FILLED);
  for (int i = 0; i < 16; ++i) cv::line(p, {300 + 3 * i, 204 + 4 * i}, {390 - i, 204 + 4 * i}, {190, 214, 236}, 1);
  const Point sail[] = {{120, 226}, {120, 158}, {166, 222}};
  cv::fillConvexPoly(p, sail, 3, {236, 238, 240}, cv::LINE_AA);
  const Point hull[] = {{96, 228}, {172, 228}, {156, 242}, {108, 242}};
  cv::fillConvexPoly(p, hull, 4, {40, 44, 120}, cv::LINE_AA);
  put_text(p, "7", 446, 32, 18, {245, 245, 245}, 2);
  return p;
}

Mat draw_hills_painting() {
  Mat p(240, 320, CV_8UC3, Scalar(0, 0, 0));
  sky(p, {214, 186, 150}, {196, 222, 240}, 130);
  ridge(p, 140, 60, {140, 150, 120}, "painted far");
  ridge(p, 178, 50, {80, 140, 110}, "painted middle");
  ridge(p, 222, 60, {60, 150, 190}, "painted near");
  for (int i = 0; i < 5; ++i) {
    const Point foot(40 + 58 * i, 196 + 7 * (i % 2));
    cv::line(p, foot, foot - Point(0, 26), {50, 66, 80}, 4, cv::LINE_AA);
    cv::circle(p, foot - Point(0, 38), 17, {60, 104, 60}, cv::FILLED, cv::LINE_AA);
  }
  return p;
}

Mat draw_shapes_painting() {
  Mat p = mottled(240, 320, {206, 222, 228}, 5, 5, "canvas");
  cv::circle(p, {96, 112}, 62, {60, 96, 190}, cv::FILLED, cv::LINE_AA);
  cv::rectangle(p, {112, 128}, {206, 266}, {132, 96, 48}, cv::FILLED);
  const Point wedge[] = {{24, 286}, {138, 206}, {92, 300}};
  cv::fillConvexPoly(p, wedge, 3, {48, 168, 220}, cv::LINE_AA);
  cv::line(p, {30, 40}, {214, 84}, {30, 30, 34}, 5, cv::LINE_AA);
  cv::circle(p, {182, 50}, 18, {30, 30, 34}, 5, cv::LINE_AA);
  return p;
}

}  // namespace waretwin::builder

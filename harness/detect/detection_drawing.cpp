#include "harness/detect/detection_drawing.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>

#include "core/random.h"
#include "harness/pictures/rasteriser.h"

namespace waretwin {

namespace {

// By the name, so that a class looks the same in every run.
cv::Scalar colour_of_class(const std::string& name) { return colour_of_id(static_cast<int>(hash_text(name) % 1000)); }

void draw_dashed_line(cv::Mat& image, const cv::Point2d& from, const cv::Point2d& to, const cv::Scalar& colour, int thickness) {
  const double dash = 6.0 * thickness, length = std::hypot(to.x - from.x, to.y - from.y);
  for (double at = 0.0; at < length; at += 2.0 * dash) {
    const double end = std::min(at + dash, length);
    cv::line(image, from + (to - from) * (at / length), from + (to - from) * (end / length), colour, thickness, cv::LINE_AA);
  }
}

void draw_dashed(cv::Mat& image, const cv::Rect2d& box, const cv::Scalar& colour, int thickness) {
  const cv::Point2d a = box.tl(), c = box.br(), b(c.x, a.y), d(a.x, c.y);
  for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, d}, std::pair{d, a}}) {
    draw_dashed_line(image, from, to, colour, thickness);
  }
}

}  // namespace

cv::Mat draw_detections(const cv::Mat& colour, const std::vector<Detection>& detections, const std::vector<TrueBox>& truth,
                        const std::vector<std::string>& classes) {
  cv::Mat image = colour.clone();
  const int thickness = std::max(1, static_cast<int>(std::lround(std::max(image.cols, image.rows) / 500.0)));
  const double scale = 0.35 + 0.15 * thickness;
  for (const TrueBox& box : truth) {
    const std::string& name = classes[static_cast<std::size_t>(box.class_index)];
    draw_dashed(image, box.box, cv::Scalar::all(20), thickness + 2);  // a rim, readable on any background
    draw_dashed(image, box.box, box.ignored ? cv::Scalar::all(160) : colour_of_class(name), thickness);
  }
  for (auto detection = detections.rbegin(); detection != detections.rend(); ++detection) {  // the best one on top
    cv::rectangle(image, detection->box, colour_of_class(detection->class_name), thickness, cv::LINE_AA);
    char text[96];
    std::snprintf(text, sizeof text, "%.60s %.2f", detection->class_name.c_str(), static_cast<double>(detection->score));
    int base = 0;
    const cv::Size size = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, scale, 1, &base);
    // Above the box, or inside it at the picture's upper edge; never beyond the right one.
    const int x = std::max(0, std::min(static_cast<int>(detection->box.x) + 2, image.cols - size.width - 2));
    const int above = static_cast<int>(detection->box.y) - 4;
    draw_text(image, {x, above < size.height ? above + size.height + 10 : above}, text, colour_of_class(detection->class_name), scale);
  }
  return image;
}

}  // namespace waretwin

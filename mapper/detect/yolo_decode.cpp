#include "mapper/detect/yolo_decode.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace waretwin {
namespace {

double overlap(const cv::Rect2f& a, const cv::Rect2f& b) {
  const double both = (a & b).area();
  const double either = static_cast<double>(a.area()) + b.area() - both;
  return either > 0.0 ? both / either : 0.0;
}

}  // namespace

cv::Mat rows_of_onnx_output(const cv::Mat& output, int classes, YoloRows& layout) {
  std::string shape;
  for (int i = 0; i < output.dims; ++i) shape += (i ? " x " : "") + std::to_string(output.size[i]);
  if (output.dims == 3 && output.size[0] == 1 && output.type() == CV_32F) {
    const cv::Mat matrix(output.size[1], output.size[2], CV_32F, const_cast<void*>(static_cast<const void*>(output.data)));
    if (matrix.cols == 5 + classes) {
      layout = YoloRows::kObjectness;
      return matrix.clone();
    }
    if (matrix.rows == 4 + classes) {
      layout = YoloRows::kPlain;
      return matrix.t();
    }
  }
  throw Error("the network's output is " + shape + "; with " + std::to_string(classes) + " class names expected 1 x N x " +
              std::to_string(5 + classes) + " (YOLOv5) or 1 x " + std::to_string(4 + classes) + " x N (YOLOv8)");
}

void decode_rows(const cv::Mat& rows, YoloRows layout, const cv::Size& input, const InputPlacement& placement, const cv::Size& picture,
                 double confidence, const std::vector<std::string>& names, std::vector<Detection>& detections) {
  const int first = layout == YoloRows::kPlain ? 4 : 5;
  const int classes = static_cast<int>(names.size());
  WARETWIN_CHECK(rows.cols == first + classes && rows.type() == CV_32F, "a row holds a box and a score per class");
  const double unit_x = layout == YoloRows::kDarknet ? input.width : 1.0;
  const double unit_y = layout == YoloRows::kDarknet ? input.height : 1.0;
  for (int i = 0; i < rows.rows; ++i) {
    const auto* row = rows.ptr<float>(i);
    const auto* best = std::max_element(row + first, row + first + classes);
    const float score = layout == YoloRows::kObjectness ? *best * row[4] : *best;
    if (!(score >= confidence)) continue;
    const double cx = row[0] * unit_x, cy = row[1] * unit_y, w = row[2] * unit_x, h = row[3] * unit_y;
    if (!std::isfinite(cx) || !std::isfinite(cy) || !std::isfinite(w) || !std::isfinite(h)) continue;
    const double x0 = std::clamp((cx - 0.5 * w - placement.offset_x) / placement.scale_x, 0.0, static_cast<double>(picture.width));
    const double x1 = std::clamp((cx + 0.5 * w - placement.offset_x) / placement.scale_x, 0.0, static_cast<double>(picture.width));
    const double y0 = std::clamp((cy - 0.5 * h - placement.offset_y) / placement.scale_y, 0.0, static_cast<double>(picture.height));
    const double y1 = std::clamp((cy + 0.5 * h - placement.offset_y) / placement.scale_y, 0.0, static_cast<double>(picture.height));
    if (!(x1 > x0) || !(y1 > y0)) continue;
    detections.push_back(
        {names[best - row - first],
         cv::Rect2f(static_cast<float>(x0), static_cast<float>(y0), static_cast<float>(x1 - x0), static_cast<float>(y1 - y0)),
         std::min(1.0f, score)});
  }
}

std::vector<Detection> suppress_overlaps(std::vector<Detection> detections, double iou) {
  std::stable_sort(detections.begin(), detections.end(), [](const Detection& a, const Detection& b) { return a.score > b.score; });
  std::vector<Detection> kept;
  for (Detection& detection : detections) {
    const bool covered = std::any_of(kept.begin(), kept.end(), [&](const Detection& better) {
      return better.class_name == detection.class_name && overlap(better.box, detection.box) > iou;
    });
    if (!covered) kept.push_back(std::move(detection));
  }
  return kept;
}

}  // namespace waretwin

// From a YOLO network's numbers to boxes.
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "mapper/detect/detector.h"

namespace waretwin {

// How a picture was laid into the network's input: input = scale * picture + offset, in pixels, axis by axis.
struct InputPlacement {
  double scale_x = 1.0, scale_y = 1.0;
  double offset_x = 0.0, offset_y = 0.0;
};

enum class YoloRows {
  kDarknet,     // cx, cy, w, h as shares of the input; objectness; class scores that hold the objectness already (OpenCV's region layer)
  kObjectness,  // cx, cy, w, h in input pixels; objectness; class scores to be multiplied by it (YOLOv5)
  kPlain        // cx, cy, w, h in input pixels; class scores (YOLOv8)
};

// An ONNX head's output as rows of candidates: (1, N, 5 + C) as it is, (1, 4 + C, N) transposed. Throws Error naming the shape for anything
// else. With 4 + C = N or the like both would fit; the layout that has the candidates in rows and an objectness is then taken.
cv::Mat rows_of_onnx_output(const cv::Mat& output, int classes, YoloRows& layout);

// Candidates of one output (CV_32F, a row each) whose best class reaches `confidence`, in pixels of the picture, cut off at its edges;
// those that end up empty or are not finite are dropped.
void decode_rows(const cv::Mat& rows, YoloRows layout, const cv::Size& input, const InputPlacement& placement, const cv::Size& picture,
                 double confidence, const std::vector<std::string>& names, std::vector<Detection>& detections);

// Greedy non-maximum suppression within each class: best score first (then in the given order), boxes that overlap a kept one by more than
// `iou` go. Returns the kept ones, best first.
std::vector<Detection> suppress_overlaps(std::vector<Detection> detections, double iou);

}  // namespace waretwin

// A picture with what a detector found in it.
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "harness/score/scored_boxes.h"
#include "mapper/detect/detector.h"

namespace waretwin {

// Detections as solid boxes with name and score, coloured by class; true boxes dashed, grey where they are ignored. `classes` are the
// names of true boxes. BGR.
cv::Mat draw_detections(const cv::Mat& colour, const std::vector<Detection>& detections, const std::vector<TrueBox>& truth,
                        const std::vector<std::string>& classes);

}  // namespace waretwin

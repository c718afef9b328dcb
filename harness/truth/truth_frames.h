// The truth of mapped frames as text: what each shows of every true object (truth_frames.jsonl).
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "core/fields.h"
#include "scenes/scene.h"
#include "sim/object_views.h"
#include "sim/simulated_stream.h"

namespace waretwin {

struct TruthFramesConfig {
  bool enabled = true;
  bool masks = true;  // with the amodal masks
  void visit(Fields& f);
};

// One line of JSON, with its line feed. docs/truth.md describes the keys.
std::string truth_frame_line(const FrameTruth& truth, const std::vector<ObjectView>& views, const Scene& scene, bool masks);

// Instances in colours over the darkened picture (CV_8UC3, BGR) with a margin around it; each object's visible box (solid), amodal box
// (dashed) and shares in percent. As large as the picture.
cv::Mat draw_truth(const cv::Mat& colour, const FrameTruth& truth, const std::vector<ObjectView>& views, const Scene& scene);

}  // namespace waretwin

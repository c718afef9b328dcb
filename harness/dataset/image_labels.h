// What a training picture is labelled with.
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "harness/dataset/dataset_config.h"
#include "scenes/scene.h"
#include "sim/object_views.h"

namespace waretwin {

// Of one object. Boxes are in whole pixels; `box` is exactly the extent of the visible pixels, which no other object has.
struct ImageLabel {
  int object_id = 0;    // in its hall
  int class_index = 0;  // into the set's classes
  cv::Rect box;
  int area_px = 0;
  double visible = 1.0, occluded = 0.0, truncated = 0.0;     // ObjectView
  cv::Rect amodal_box;                                       // reaches beyond the picture
  bool crosses_camera_plane = false, leaves_margin = false;  // ObjectView: there is more of it than these say
  std::vector<std::vector<double>> polygons;                 // harness/truth/mask_outlines.h
  std::string runs;                                          // compressed
};

// A visible object without a label: neither to be found nor a mistake if found.
struct LeftOut {
  enum class Why { kHidden, kSmall };  // too little of it visible; too few pixels
  int object_id = 0;
  int class_index = 0;
  cv::Rect box;  // of the visible pixels
  Why why = Why::kHidden;
};

struct ImageLabels {
  std::vector<ImageLabel> labels;  // both in the order of the scene's objects
  std::vector<LeftOut> left_out;
};

// `instances`: the picture's instance image, `views` what it shows of each object. Objects of other classes are passed over.
ImageLabels label_objects(const std::vector<ObjectView>& views, const cv::Mat& instances, const Scene& scene,
                          const std::vector<std::string>& classes, const LabelRule& rule, double polygon_tolerance_px);

}  // namespace waretwin

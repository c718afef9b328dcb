// Constants of association (section 3.3 of the paper).
#pragma once

#include <string>

#include "core/fields.h"

namespace waretwin {

struct AssociateConfig {
  int max_frame_gap = 10;                  // eq. (2): eta < 10, in mapped frames; 0 = no limit (second visits)
  double min_iou_2d = 0.5;                 // eq. (3)
  std::string iou2d_mode = "last_box";     // "last_box": the box stored with the object; "projected": its cuboid seen from here
  double min_correlation = 0.3;            // eq. (4)
  std::string correlation = "normalised";  // "normalised": A.B / (|A| |B|); "literal": A.B / sqrt(|A|^2 + |B|^2) as printed
  double min_iou_3d = 0.5;                 // eq. (5)
  double merge_iou_3d = 0.8;               // above this, objects are one whatever their classes
  double point_voxel_m = 0.01;             // accumulated points are thinned to one a voxel; 0 keeps all
  double heading_step_deg = 1.0;           // of the cuboid's heading search

  void visit(Fields& f) {
    f("max_frame_gap", max_frame_gap, "eta must be below this many mapped frames; 0 = no limit", {.min = 0, .max = 1e9});
    f("min_iou_2d", min_iou_2d, "2D IoU must exceed this; -1 switches the condition off", {.min = -1, .max = 1});
    f("iou2d_mode", iou2d_mode, "the mapped object's 2D box: the one it was last seen in, or its cuboid projected into this frame",
      {.choices = {"last_box", "projected"}});
    f("min_correlation", min_correlation, "correlation of the colour vectors must exceed this; -1 switches the condition off",
      {.min = -1, .max = 1});
    f("correlation", correlation, "how eq. (4) is read", {.choices = {"normalised", "literal"}});
    f("min_iou_3d", min_iou_3d, "3D IoU must exceed this", {.min = 0, .max = 1});
    f("merge_iou_3d", merge_iou_3d, "above this 3D IoU objects are one, whatever their classes", {.min = 0, .max = 1});
    f("point_voxel_m", point_voxel_m, "accumulated points are thinned to one a voxel of this size; 0 keeps all", {.min = 0, .max = 1});
    f("heading_step_deg", heading_step_deg, "step of the cuboid's heading search", {.min = 0.01, .max = 45});
  }
};

}  // namespace waretwin

// Constants of object segmentation by evidence (profile best).
#pragma once

#include "core/fields.h"

namespace waretwin {

// What one frame tells about an object: evidence_segmenter.h.
struct EvidenceRaysConfig {
  double ring_share = 0.3;        // rays are taken this far around the box, relative to its size ...
  double ring_min_px = 40.0;      // ... and at least so many colour pixels
  double box_slack_px = 3.0;      // so near to the box's edge a pixel may belong to the object or not
  double box_slack_share = 0.01;  // the same relative to the box's size; the larger holds
  double max_turn_deg_s = 40.0;   // frames taken in faster rotation tell nothing
  double same_box_iou = 0.7;      // boxes of one class that overlap more are one
  bool native = true;             // rays of the depth camera's own picture, where the stream has it
  int thin = 1;                   // every n-th row and column of the depth image

  void visit(Fields& f) {
    f("ring_share", ring_share, "how far around a box rays are taken, relative to its size", {.min = 0, .max = 5});
    f("ring_min_px", ring_min_px, "the same in colour pixels, at least", {.min = 0, .max = 1e4});
    f("box_slack_px", box_slack_px, "pixels so near to a box's edge are neither object nor other", {.min = 0, .max = 100});
    f("box_slack_share", box_slack_share, "the same relative to the box's size; the larger holds", {.min = 0, .max = 0.4});
    f("max_turn_deg_s", max_turn_deg_s, "frames taken while the camera turned faster are left out", {.min = 0, .max = 1e4});
    f("same_box_iou", same_box_iou, "boxes of one class whose 2D IoU is above this are one", {.min = 0, .max = 1});
    f("native", native, "rays are those of the depth camera's own picture, where the stream has it; false: of the colour view");
    f("thin", thin, "every n-th row and column of the depth image gives rays", {.min = 1, .max = 16});
  }
};

}  // namespace waretwin

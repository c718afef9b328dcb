// Constants of segment-level association (profile voxbloxpp; Grinvald et al. 2019, sections III-C and III-D).
#pragma once

#include "core/fields.h"

namespace waretwin {

struct SegmentsConfig {
  int min_label_voxels = 20;               // the authors' setting
  bool merge = true;                       // as theirs
  double merging_min_overlap_ratio = 0.2;  // theirs; for SceneNN at 1 Hz 0.15
  int merging_min_frame_count = 30;        // theirs, of frames at 30 Hz; for SceneNN at 1 Hz 3
  double background_factor = 0.0;          // theirs
  int min_object_points = 20;
  double heading_step_deg = 1.0;  // of the cuboid's heading search, as in profile paper

  void visit(Fields& f) {
    f("min_label_voxels", min_label_voxels, "fewest voxels of a mapped segment under a segment of the frame that may be it",
      {.min = 1, .max = 1e7});
    f("merge", merge, "mapped segments that frames see as one become one");
    f("merging_min_overlap_ratio", merging_min_overlap_ratio,
      "a segment of a frame joins two mapped ones when each holds this share of its voxels", {.min = 0.001, .max = 0.5});
    f("merging_min_frame_count", merging_min_frame_count, "two mapped segments that this many frames joined become one",
      {.min = 1, .max = 1e6});
    f("background_factor", background_factor,
      "a segment is part of an object seen with it in more than this times the frames that show the segment without the object",
      {.min = 0, .max = 100});
    f("min_object_points", min_object_points, "fewest surface points of an object, one where the surface crosses an edge between voxels",
      {.min = 3, .max = 1e7});
    f("heading_step_deg", heading_step_deg, "step of the cuboid's heading search", {.min = 0.01, .max = 45});
  }
};

}  // namespace waretwin

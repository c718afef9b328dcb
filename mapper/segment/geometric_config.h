// Constants of geometric segmentation (profile voxbloxpp). Where the method's authors publish a value for VGA pictures (focal length 525),
// it is given in their pixels and in ours: thinned by 2, the 1280 x 720 picture has a focal length of 320.
#pragma once

#include <string>

#include "core/fields.h"

namespace waretwin {

// What makes a pixel an edge, and what becomes of the rest: convex_segments.h; what a box says about a segment: geometric_segmenter.h.
struct GeometricConfig {
  int thin = 2;
  int normal_window_px = 9;           // theirs: 13
  double normal_depth_share = 0.05;   // theirs
  int convexity_window_px = 5;        // theirs
  double min_convexity = 0.97;        // theirs, for SceneNN: about 14 deg
  double concave_margin_m = 0.0005;   // theirs
  double discontinuity_share = 0.01;  // theirs
  int min_segment_px = 200;           // theirs: 500
  int grow_px = 6;                    // as wide as both windows reach
  double box_share = 0.8;             // theirs, of masks
  double min_box_fill = 0.0;          // masks need none; MapperConfig::make sets what boxes need

  void visit(Fields& f) {
    f("thin", thin, "segments are sought in every n-th row and column; the keys in px count these", {.min = 1, .max = 16});
    f("normal_window_px", normal_window_px, "edge of the window in which a normal is fitted; odd", {.min = 3, .max = 51});
    f("normal_depth_share", normal_depth_share, "pixels in it whose depth differs by more than this share are left out",
      {.min = 0.001, .max = 1});
    f("convexity_window_px", convexity_window_px, "edge of the window in which concave neighbours are sought; odd", {.min = 3, .max = 51});
    f("min_convexity", min_convexity, "a neighbour in a concave corner makes an edge where the cosine between normals is lower",
      {.min = -1, .max = 1});
    f("concave_margin_m", concave_margin_m, "both points together lie before each other's plane by more than this in a concave corner",
      {.min = 0, .max = 1});
    f("discontinuity_share", discontinuity_share,
      "a direct neighbour farther from the pixel's plane than this share of the depth makes an edge", {.min = 0.0001, .max = 1});
    f("min_segment_px", min_segment_px, "fewest pixels of a segment", {.min = 1, .max = 1e7});
    f("grow_px", grow_px, "edge pixels up to this far from a segment are given to it", {.min = 0, .max = 100});
    f("box_share", box_share, "share of a segment that must lie in a mask or box to take its class; less is background",
      {.min = 0.01, .max = 1});
    f("min_box_fill", min_box_fill,
      "without a mask, the share of a box's area that a segment must fill to take its class: scraps of what stands behind are seen through "
      "a box",
      {.min = 0, .max = 1});
    if (normal_window_px % 2 == 0) f.reject("normal_window_px", std::to_string(normal_window_px) + "; expected an odd number");
    if (convexity_window_px % 2 == 0) f.reject("convexity_window_px", std::to_string(convexity_window_px) + "; expected an odd number");
  }
};

}  // namespace waretwin

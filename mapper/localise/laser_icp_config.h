// Constants of laser localisation by ICP (section 4.3 of the paper names Censi 2008; the numbers the text leaves open are ours).
#pragma once

#include <string>

#include "core/fields.h"

namespace waretwin {

// How one scan is laid onto another: match_scans().
struct ScanMatchConfig {
  std::string lines = "fitted";       // "fitted" | "two_points" (Censi's own lines)
  double line_radius_m = 0.3;         // fitted: how far along the reference scan a line reaches from its point
  double max_correspondence_m = 0.4;  // farther reference points are no correspondence
  double keep_fraction = 0.95;        // Censi 2008: the worst correspondences beyond this share are dropped ...
  double adaptive_order = 0.7;        // ... and so is what exceeds adaptive_factor times the residual at this quantile
  double adaptive_factor = 3.0;
  double min_matched_fraction = 0.35;  // of the scan's points, below which a match is not believed
  double max_residual_m = 0.06;        // root mean square of the kept residuals, above which a match is not believed
  int max_iterations = 60;
  double translation_epsilon_m = 1e-4;  // an iteration that moves less than both ends the search
  double rotation_epsilon_deg = 3e-3;

  void visit(Fields& f) {
    f("lines", lines, "what a point is matched to: lines fitted over neighbouring reference points, or Censi's lines through two points",
      {.choices = {"fitted", "two_points"}});
    f("line_radius_m", line_radius_m, "fitted lines: reach along the reference scan", {.min = 0.02, .max = 2});
    f("max_correspondence_m", max_correspondence_m, "largest distance between corresponding points", {.min = 0.01, .max = 10});
    f("keep_fraction", keep_fraction, "share of correspondences that are kept, best first", {.min = 0.1, .max = 1});
    f("adaptive_order", adaptive_order, "quantile of the residuals that sets the adaptive limit", {.min = 0.1, .max = 1});
    f("adaptive_factor", adaptive_factor, "residuals above this many times that quantile are outliers", {.min = 1, .max = 100});
    f("min_matched_fraction", min_matched_fraction, "smallest believable share of matched points", {.min = 0, .max = 1});
    f("max_residual_m", max_residual_m, "largest believable root mean square residual", {.min = 0.001, .max = 10});
    f("max_iterations", max_iterations, "iterations at most", {.min = 1, .max = 1000});
    f("translation_epsilon_m", translation_epsilon_m, "steps below this and rotation_epsilon_deg end the iteration", {.min = 0, .max = 1});
    f("rotation_epsilon_deg", rotation_epsilon_deg, "see translation_epsilon_m", {.min = 0, .max = 10});
  }
};

struct LaserIcpConfig {
  ScanMatchConfig match;
  double keyframe_distance_m = 0.5;
  double keyframe_angle_deg = 30.0;
  bool reuse_keyframes = true;  // back near an old keyframe, match against that one again instead of making a new one
  double min_range_m = 0.1;     // readings below are the vehicle itself or dirt on the window

  void visit(Fields& f) {
    f.group("match", match, "laying one scan onto another");
    f("keyframe_distance_m", keyframe_distance_m, "a new keyframe after this distance; 0 matches scan to scan", {.min = 0, .max = 100});
    f("keyframe_angle_deg", keyframe_angle_deg, "a new keyframe after this rotation", {.min = 0, .max = 180});
    f("reuse_keyframes", reuse_keyframes, "match against the oldest keyframe near enough before making a new one");
    f("min_range_m", min_range_m, "shorter ranges are ignored", {.min = 0, .max = 100});
  }
};

}  // namespace waretwin

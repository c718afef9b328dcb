// Constants of laser localisation against a local map (profile `best`).
#pragma once

#include <string>

#include "core/fields.h"

namespace waretwin {

// From a scan's readings to points with a direction of their surface: scan_points().
struct ScanPointsConfig {
  double min_range_m = 0.1;      // readings below are the vehicle itself or dirt on the window
  bool deskew = true;            // false: all beams are taken as measured at once, in the middle of the turn
  double line_radius_m = 0.25;   // how far along the scan a point's surface is looked at
  double edge_gap_m = 0.06;      // neighbours farther apart than this, and than edge_slope allows, are two surfaces ...
  double edge_slope = 5.0;       // ... that is, than this many times the width between two beams (5: incidence of 79 deg)
  double max_line_rms_m = 0.03;  // neighbourhoods that are less straight have no direction

  void visit(Fields& f) {
    f("min_range_m", min_range_m, "shorter ranges are ignored", {.min = 0, .max = 100});
    f("deskew", deskew, "beams are brought to the middle of the turn by the vehicle's motion");
    f("line_radius_m", line_radius_m, "reach along the scan of the line at each point", {.min = 0.02, .max = 2});
    f("edge_gap_m", edge_gap_m, "a gap between neighbours up to this is no edge", {.min = 0, .max = 2});
    f("edge_slope", edge_slope, "a gap up to this many beam widths is no edge; points at edges are left out", {.min = 1, .max = 100});
    f("max_line_rms_m", max_line_rms_m, "neighbourhoods that scatter more about their line are left out", {.min = 0.001, .max = 1});
  }
};

// Laying a scan onto the local map: match_to_map().
struct MapMatchConfig {
  double max_distance_m = 0.4;        // farther points do not correspond while the search is still rough ...
  double fine_distance_m = 0.12;      // ... and once it is nearly done
  double max_normal_angle_deg = 40;   // surfaces that are turned more against each other do not correspond
  double min_scale_m = 0.012;         // smallest scale of the robust weights; they follow the residuals' own spread above it
  double min_sigma_m = 0.004;         // smallest standard deviation that residuals are given
  double independent_share = 0.35;    // beams on one wall err together: so many of them count for one that stands alone
  double min_matched_fraction = 0.4;  // of the scan's points that lie on the map, below which a match is not believed
  double max_residual_m = 0.05;       // root mean square of the matched points, above which a match is not believed
  bool degeneracy = true;
  double degenerate_beams = 8;  // fewer points than this that hold the vehicle in a direction: odometry alone decides there
  int max_iterations = 30;
  double translation_epsilon_m = 5e-5;
  double rotation_epsilon_deg = 2e-3;

  void visit(Fields& f) {
    f("max_distance_m", max_distance_m, "largest distance between corresponding points at first", {.min = 0.01, .max = 10});
    f("fine_distance_m", fine_distance_m, "largest distance between corresponding points at last", {.min = 0.01, .max = 10});
    f("max_normal_angle_deg", max_normal_angle_deg, "largest angle between corresponding surfaces", {.min = 1, .max = 180});
    f("min_scale_m", min_scale_m, "residuals well below this have full weight", {.min = 0.001, .max = 1});
    f("min_sigma_m", min_sigma_m, "smallest standard deviation of a residual", {.min = 0.0001, .max = 1});
    f("independent_share", independent_share, "share of the beams that errs on its own, for covariances", {.min = 0.001, .max = 1});
    f("min_matched_fraction", min_matched_fraction, "smallest believable share of matched points", {.min = 0, .max = 1});
    f("max_residual_m", max_residual_m, "largest believable root mean square residual", {.min = 0.001, .max = 10});
    f("degeneracy", degeneracy, "false: what little a scan tells along a corridor is used");
    f("degenerate_beams", degenerate_beams, "points that must hold a direction, else odometry decides there", {.min = 0, .max = 1000});
    f("max_iterations", max_iterations, "iterations at most", {.min = 1, .max = 1000});
    f("translation_epsilon_m", translation_epsilon_m, "steps below this and rotation_epsilon_deg end the iteration", {.min = 0, .max = 1});
    f("rotation_epsilon_deg", rotation_epsilon_deg, "see translation_epsilon_m", {.min = 0, .max = 10});
  }
};

// Finding a scan in the map without a good guess: search_map().
struct MapSearchConfig {
  bool enabled = true;
  double cell_m = 0.05;
  double blur_m = 0.1;       // a point this far from the map's counts half
  double window_m = 0.6;     // half the side of the square that is searched at first; it grows with each scan that is not found
  double window_deg = 30.0;  // the same for the heading
  double max_window_m = 6.0;
  int points = 150;         // of the scan that are looked at
  double min_score = 0.55;  // mean of the points' values in [0, 1], below which a place is no candidate

  void visit(Fields& f) {
    f("enabled", enabled, "false: after a bad match odometry alone carries on");
    f("cell_m", cell_m, "step of the search", {.min = 0.01, .max = 1});
    f("blur_m", blur_m, "distance from the map at which a point counts half", {.min = 0.01, .max = 1});
    f("window_m", window_m, "half the side of the square that is searched first", {.min = 0, .max = 100});
    f("window_deg", window_deg, "largest turn that is searched first", {.min = 0, .max = 180});
    f("max_window_m", max_window_m, "how far the window grows while the vehicle is lost", {.min = 0, .max = 100});
    f("points", points, "points of the scan that are looked at", {.min = 10, .max = 10000});
    f("min_score", min_score, "smallest believable mean value of the points", {.min = 0, .max = 1});
  }
};

// How far odometry is trusted from one scan to the next. Standard deviations; they grow by themselves where the scans disagree.
struct MotionTrustConfig {
  double floor_m = 0.0003;
  double distance_share = 0.03;  // of the distance
  double distance_sd_m = 0.012;  // after one metre, growing with the square root
  double floor_deg = 0.01;
  double turn_share = 0.03;          // of the turn
  double turn_sd_per_m_deg = 0.7;    // after one metre, growing with the square root
  double turn_sd_per_rad_deg = 1.3;  // after one radian, growing with the square root
  double disbelief = 5.0;            // a match this many standard deviations off is repeated without odometry
  double doubtful =
      4.0;  // while its errors are this many times their variance, the last velocity is a second guess, and corridors ask the scan

  void visit(Fields& f) {
    f("floor_m", floor_m, "standard deviation of a standstill", {.min = 1e-6, .max = 1});
    f("distance_share", distance_share, "relative error of a distance", {.min = 0, .max = 1});
    f("distance_sd_m", distance_sd_m, "random error after one metre", {.min = 0, .max = 1});
    f("floor_deg", floor_deg, "standard deviation of a standstill", {.min = 1e-5, .max = 90});
    f("turn_share", turn_share, "relative error of a turn", {.min = 0, .max = 1});
    f("turn_sd_per_m_deg", turn_sd_per_m_deg, "random error of the heading after one metre", {.min = 0, .max = 90});
    f("turn_sd_per_rad_deg", turn_sd_per_rad_deg, "random error of the heading after one radian", {.min = 0, .max = 90});
    f("doubtful", doubtful, "variance of recent errors over the expected, from which on odometry decides nothing alone",
      {.min = 1, .max = 1e6});
    f("disbelief", disbelief, "standard deviations between scan and odometry from which on odometry is left out", {.min = 1, .max = 1000});
  }
};

struct LocalMapConfig {
  ScanPointsConfig scan;
  MapMatchConfig match;
  MapSearchConfig search;
  MotionTrustConfig motion;
  double keyframe_distance_m = 0.3;
  double keyframe_angle_deg = 25.0;
  int keyframe_scans = 12;     // scans that a keyframe gathers while the vehicle stands still on it
  double map_radius_m = 10.0;  // keyframes within this distance make up the local map ...
  double map_path_m = 25.0;    // ... if the way to them along the graph of keyframes is not longer than this
  int map_keyframes = 60;      // at most: the older first, they have drifted least
  double map_cell_m = 0.05;    // points of the local map are averaged over cells of this size
  bool estimate_bias = true;   // the laser's constant range error is a state
  double bias_sd_m = 0.015;    // what is known of it beforehand
  double bias_step_m = 0.001;  // a change beyond this re-lays the keyframes
  bool loops = true;
  double loop_radius_m = 3.0;  // keyframes this near, and far along the graph, may be a place seen before

  void visit(Fields& f) {
    f.group("scan", scan, "points of a scan");
    f.group("match", match, "laying a scan onto the local map");
    f.group("search", search, "finding a scan in the map after a bad match");
    f.group("motion", motion, "how far odometry is trusted");
    f("keyframe_distance_m", keyframe_distance_m, "a new keyframe where none is within this distance", {.min = 0.01, .max = 100});
    f("keyframe_angle_deg", keyframe_angle_deg, "or none of them within this turn", {.min = 1, .max = 180});
    f("keyframe_scans", keyframe_scans, "scans that a keyframe gathers while the vehicle stands on it", {.min = 1, .max = 1000});
    f("map_radius_m", map_radius_m, "keyframes within this distance make up the local map", {.min = 0.1, .max = 1000});
    f("map_path_m", map_path_m, "and not farther away along the path driven", {.min = 0.1, .max = 1e6});
    f("map_keyframes", map_keyframes, "keyframes in the local map at most; 1: the newest alone", {.min = 1, .max = 10000});
    f("map_cell_m", map_cell_m, "cells over which the local map's points are averaged", {.min = 0.005, .max = 1});
    f("estimate_bias", estimate_bias, "the laser's constant range error is estimated on the way");
    f("bias_sd_m", bias_sd_m, "standard deviation of that error before anything is seen", {.min = 1e-4, .max = 1});
    f("bias_step_m", bias_step_m, "a change beyond this lays all keyframes anew", {.min = 1e-5, .max = 1});
    f("loops", loops, "the graph of keyframes is straightened when a place is seen again");
    f("loop_radius_m", loop_radius_m, "keyframes this near may show a place seen before", {.min = 0.1, .max = 100});
  }
};

}  // namespace waretwin

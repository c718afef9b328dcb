// Constants of object mapping by evidence (profile best).
#pragma once

#include "core/fields.h"

namespace waretwin {

struct EvidenceConfig {
  double cell_m = 0.005;         // edge of a cell in x and y, where the object is small enough
  double slice_m = 0.01;         // height of a cell
  double end_slack_m = 0.004;    // a ray passes space up to so near to its end: the noise of a range
  double end_path_m = 0.03;      // over this length before its end a ray is followed step by step
  int max_cells = 1500000;       // larger objects get larger cells
  double margin_m = 0.10;        // the grid reaches this far beyond what may be the object
  double max_extent_m = 6.0;     // nothing larger is an object
  double min_hits_share = 0.15;  // cells with fewer hits than this share of the median cell's are noise
  int min_hits = 3;
  double outside_weight = 3.0;      // a hit seen outside the box says so many times as much about a cell as one inside
  double join_m = 0.02;             // parts nearer than this are one
  double bridge_m = 0.5;            // so are parts up to this far away ...
  double bridge_share = 0.8;        // ... that are no smaller piece of what goes on outside the object's boxes than this ...
  double bridge_gain = 0.005;       // ... and with which the boxes are matched better by so much 2D IoU
  int box_views = 32;               // boxes are kept of at least so many views; 0: none, the part with most hits is the object
  double edge_support_m2 = 0.0006;  // a face stands where at least this much of the outline seen against it reaches it
  double top_area_m2 = 0.004;       // the top is the highest level that at least this much of the footprint reaches ...
  double top_area_share = 0.04;     // ... and at least this share of it
  double foot_clearance_m = 0.012;  // hits no higher above the support may be its own
  double support_share = 0.4;       // the object stands on a support that so many of its frames found; else on the ground
  double foot_gap_m = 0.08;         // an object whose lowest cell is nearer to its support stands on it
  double heading_step_deg = 0.1;
  int shape_every = 5;  // the cuboid is searched again after so many more observations, or a fifth of those it has
  // Association
  double min_overlap = 0.3;  // share of a detection's points inside a mapped cuboid, grown by overlap_margin_m
  double overlap_margin_m = 0.05;
  double same_object_share = 0.6;  // a detection with more of its points inside an object that has one already is no other object
  double merge_overlap = 0.5;      // of the smaller of two mapped cuboids, above which they are one object
  double same_boxes_match = 0.5;   // so are two of which one's cuboid matches the other's boxes so well, and better than its own
  double stray_reach_m = 1.0;      // if they are no farther apart than this
  double neighbour_share = 0.3;    // of two in one place seen side by side now and then, up to this share of frames, the worse goes
  int min_observations = 3;        // fewer are no object at the end
  double min_presence = 0.3;       // detections over frames in which the object was in full view

  void visit(Fields& f) {
    f("cell_m", cell_m, "edge of a cell in x and y", {.min = 0.001, .max = 0.1});
    f("slice_m", slice_m, "height of a cell", {.min = 0.001, .max = 0.1});
    f("end_slack_m", end_slack_m, "a ray passes space up to so near to its end", {.min = 0, .max = 0.1});
    f("end_path_m", end_path_m, "over this length before its end a ray is followed step by step", {.min = 0, .max = 1});
    f("max_cells", max_cells, "cells of one object at most; larger objects get larger cells", {.min = 1000, .max = 1e8});
    f("margin_m", margin_m, "how far the grid reaches beyond what may be the object", {.min = 0.02, .max = 1});
    f("max_extent_m", max_extent_m, "nothing larger is an object", {.min = 0.1, .max = 100});
    f("min_hits_share", min_hits_share, "cells with fewer hits than this share of the median cell's are noise", {.min = 0, .max = 1});
    f("min_hits", min_hits, "and cells with fewer than these", {.min = 1, .max = 1000});
    f("outside_weight", outside_weight, "a hit seen outside the box says so many times as much about a cell as one inside",
      {.min = 0, .max = 1000});
    f("join_m", join_m, "parts nearer than this belong together", {.min = 0.001, .max = 1});
    f("bridge_m", bridge_m, "so do parts up to this far away with which the object's boxes are matched better", {.min = 0, .max = 5});
    f("bridge_share", bridge_share, "if they are no smaller share than this of what goes on outside the boxes", {.min = 0, .max = 1});
    f("bridge_gain", bridge_gain, "and the mean 2D IoU with the boxes rises by at least this much", {.min = 0, .max = 1});
    f("box_views", box_views, "an object's boxes are kept of at least so many views; 0: none, the part with most hits is all of it",
      {.min = 0, .max = 1000});
    f("edge_support_m2", edge_support_m2, "a face stands where at least this much of the outline, seen against it, reaches it",
      {.min = 0, .max = 1});
    f("top_area_m2", top_area_m2, "the top is the highest level that at least this much of the footprint reaches", {.min = 0, .max = 10});
    f("top_area_share", top_area_share, "and at least this share of it", {.min = 0, .max = 1});
    f("foot_clearance_m", foot_clearance_m, "hits no higher above the support may be its own", {.min = 0, .max = 1});
    f("support_share", support_share, "share of an object's frames that must have found its support; else it stands on the ground",
      {.min = 0, .max = 1});
    f("foot_gap_m", foot_gap_m, "an object whose lowest cell is nearer to its support stands on it", {.min = 0, .max = 1});
    f("heading_step_deg", heading_step_deg, "finest step of the heading search", {.min = 0.01, .max = 5});
    f("shape_every", shape_every, "the cuboid is searched again after so many more observations, or a fifth of those it has",
      {.min = 1, .max = 1000});
    f("min_overlap", min_overlap, "share of a detection's points inside a mapped cuboid for both to be one; -1: always",
      {.min = -1, .max = 1});
    f("overlap_margin_m", overlap_margin_m, "the cuboid grows by this for that question", {.min = 0, .max = 1});
    f("same_object_share", same_object_share,
      "a detection with more of its points inside an object that has its own in this frame is no other object", {.min = 0, .max = 1});
    f("merge_overlap", merge_overlap, "mapped objects that share more of the smaller one's volume are one", {.min = 0, .max = 1});
    f("same_boxes_match", same_boxes_match, "so are two of which one's cuboid matches the other's boxes so well, and better than its own",
      {.min = 0, .max = 1});
    f("stray_reach_m", stray_reach_m, "if they are no farther apart than this", {.min = 0, .max = 100});
    f("neighbour_share", neighbour_share,
      "of two in one place that at most this share of the less-seen one's frames showed side by side the worse is taken out at the end; "
      "above, both stay",
      {.min = 0, .max = 1});
    f("min_observations", min_observations, "objects seen in fewer frames are taken out at the end", {.min = 1, .max = 1000});
    f("min_presence", min_presence,
      "share of the frames with the object in full view in which it was detected, below which it is taken out", {.min = 0, .max = 1});
  }
};

}  // namespace waretwin

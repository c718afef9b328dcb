// Constants of object segmentation (section 3.2 of the paper); what the text leaves open is chosen here and says why.
#pragma once

#include <string>
#include <vector>

#include "core/fields.h"

namespace waretwin {

// Multi-plane segmentation of the organised cloud (Trevor et al. 2013, as in PCL) and what counts as ground and support.
struct PlaneConfig {
  int stride = 4;                       // planes are sought in every n-th row and column: 320 x 180 of 1280 x 720, about 20 ms
  int min_inliers = 300;                // pixels of the thinned picture
  double angle_deg = 4.0;               // largest angle between normals of neighbours in one plane
  double distance_m = 0.03;             // largest distance of neighbours from one plane
  double normal_smoothing_px = 10.0;    // window of the integral-image normals, in pixels of the thinned picture
  double level_angle_deg = 10.0;        // a plane tilted less is horizontal
  std::string ground = "world_zero";    // "world_zero": the paper's; "lowest_plane": for worlds whose origin is not on the floor
  double ground_height_m = 0.0;         // where the ground lies (world_zero)
  double ground_tolerance_m = 0.08;     // how far from that a plane still is the ground
  std::string remove = "support";       // "support": ground and supporting plane with what lies below; "ground": the literal text
  double clearance_min_m = 0.006;       // points nearer to ground or support than 3 sigma of that plane's own noise are removed,
  double clearance_max_m = 0.03;        // 3 sigma being held between these two
  double support_ring = 0.25;           // how far around the 2D box the support is looked for, as a share of the box's size
  double support_ring_fraction = 0.06;  // share of the ring's pixels that a support must fill
  double support_coverage = 0.6;        // share of the box's part with depth that the points above a support must span

  void visit(Fields& f) {
    f("stride", stride, "planes are sought in every n-th row and column", {.min = 1, .max = 64});
    f("min_inliers", min_inliers, "fewest pixels of a plane, in the thinned picture", {.min = 3, .max = 1e7});
    f("angle_deg", angle_deg, "largest angle between neighbours' normals in a plane", {.min = 0.1, .max = 45});
    f("distance_m", distance_m, "largest distance of neighbours from a common plane", {.min = 0.001, .max = 1});
    f("normal_smoothing_px", normal_smoothing_px, "window of the normal estimation in pixels of the thinned picture",
      {.min = 2, .max = 100});
    f("level_angle_deg", level_angle_deg, "a plane tilted less is horizontal", {.min = 0.1, .max = 45});
    f("ground", ground, "which horizontal plane is the ground", {.choices = {"world_zero", "lowest_plane"}});
    f("ground_height_m", ground_height_m, "height of the ground for ground: world_zero", {.min = -1000, .max = 1000});
    f("ground_tolerance_m", ground_tolerance_m, "how far a plane may lie from the ground's height and still be it", {.min = 0, .max = 1});
    f("remove", remove, "what is taken from an object's points: ground and support with all below it, or the ground alone",
      {.choices = {"support", "ground"}});
    f("clearance_min_m", clearance_min_m, "points within 3 sigma of ground or support are removed; sigma's lower bound times 3",
      {.min = 0, .max = 1});
    f("clearance_max_m", clearance_max_m, "its upper bound", {.min = 0, .max = 1});
    f("support_ring", support_ring, "width of the ring around a box in which its support is looked for, relative to the box",
      {.min = 0.01, .max = 2});
    f("support_ring_fraction", support_ring_fraction, "share of that ring that the support fills at least", {.min = 0, .max = 1});
    f("support_coverage", support_coverage, "share of the box's part with depth that the points above the support span at least",
      {.min = 0, .max = 1});
  }
};

struct SegmentConfig {
  PlaneConfig planes;
  double box_margin = 0.02;    // boxes grow by this share of their size on each side
  double depth_min_m = 0.0;    // 0 = the stream's own limit
  double depth_max_m = 0.0;    // 0 = the stream's own limit
  int min_pixels = 200;        // fewer depth pixels are no object
  double thin_voxel_m = 0.01;  // outliers and clusters are sought among one point a voxel ...
  int thin_points = 8000;      // ... which grows until no more points than these remain
  bool outlier_removal = true;
  int outlier_neighbours = 50;  // k of the statistical outlier removal
  double outlier_sigmas = 3.0;  // 1.0 would take the rim of every face as well: its points have half the neighbours
  bool recover_foot = true;     // points within the clearance above ground or support that lie inside the object's own rectangle come back
  double cluster_tolerance_m = 0.05;
  double cluster_fraction = 0.7;  // the paper's 70 %
  double heading_step_deg = 1.0;
  std::vector<std::string> cut_first = {"table", "diningtable"};  // section 4.2

  void visit(Fields& f) {
    f.group("planes", planes, "ground and support");
    f("box_margin", box_margin, "boxes grow by this share of their size on each side", {.min = -0.4, .max = 1});
    f("depth_min_m", depth_min_m, "nearer depth is ignored; 0 = the camera's own limit", {.min = 0, .max = 100});
    f("depth_max_m", depth_max_m, "farther depth is ignored; 0 = the camera's own limit", {.min = 0, .max = 100});
    f("min_pixels", min_pixels, "fewest depth pixels of an object", {.min = 3, .max = 1e7});
    f("thin_voxel_m", thin_voxel_m, "outliers and clusters are sought among one point a voxel of this size", {.min = 0.001, .max = 1});
    f("thin_points", thin_points, "the voxel doubles until no more points than these remain", {.min = 100, .max = 1e7});
    f("outlier_removal", outlier_removal, "statistical outlier removal");
    f("outlier_neighbours", outlier_neighbours, "its number of neighbours", {.min = 1, .max = 1000});
    f("outlier_sigmas", outlier_sigmas, "its limit in standard deviations", {.min = 0, .max = 100});
    f("recover_foot", recover_foot, "give back the points just above ground or support that lie inside the object's own rectangle");
    f("cluster_tolerance_m", cluster_tolerance_m, "points nearer than this belong to one cluster", {.min = 0.001, .max = 10});
    f("cluster_fraction", cluster_fraction, "share of all points that the one cluster must hold", {.min = 0, .max = 1});
    f("heading_step_deg", heading_step_deg, "step of the cuboid's heading search", {.min = 0.01, .max = 45});
    f("cut_first", cut_first, "classes whose points are cut out before other boxes are looked at");
  }
};

}  // namespace waretwin

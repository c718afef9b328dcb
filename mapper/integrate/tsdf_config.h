// Constants of the volume, its integrator and its mesh (section 3.4; Voxblox's defaults where the paper names none).
#pragma once

#include <string>

#include "core/fields.h"
#include "mapper/integrate/projection_config.h"

namespace waretwin {

struct TsdfConfig {
  std::string method = "rays";
  double voxel_m = 0.02;
  double truncation_voxels = 4.0;
  double label_band_voxels = 2.0;
  bool inverse_square_weight = true;
  double max_weight = 10000.0;
  double max_depth_m = 5.0;
  bool carve = true;
  int clear_frames = 3;
  double mesh_min_weight = 0.05;
  ProjectionConfig projection;

  double truncation_m() const { return truncation_voxels * voxel_m; }

  void visit(Fields& f) {
    f("method", method, "rays: Voxblox's grouped rays (the paper's); projection: voxels looked up in the depth image",
      {.choices = {"rays", "projection"}});
    f("voxel_m", voxel_m, "edge of a voxel", {.min = 0.002, .max = 1.0});
    f("truncation_voxels", truncation_voxels, "distances are kept up to this many voxels before and behind a surface",
      {.min = 1, .max = 32});
    f("label_band_voxels", label_band_voxels, "voxels this near to a measured surface count its label (eq. 6)", {.min = 0.5, .max = 32});
    f("inverse_square_weight", inverse_square_weight, "a point weighs 1 / depth^2; false: all points weigh 1");
    f("max_weight", max_weight, "a voxel's weight grows no further; lower forgets faster", {.min = 1, .max = 1e9});
    f("max_depth_m", max_depth_m, "points farther away are not mapped, and space is not cleared beyond", {.min = 0.1, .max = 100});
    f("carve", carve, "record the space between camera and surfaces as free");
    f("clear_frames", clear_frames,
      "a surface seen through in this many frames, and in twice as many as it was seen in, is taken out; 0: never", {.min = 0, .max = 100});
    f("mesh_min_weight", mesh_min_weight, "voxels of lower weight make no mesh and are unknown", {.min = 0, .max = 1e9});
    f.group("projection", projection, "integration by projection");
  }
};

}  // namespace waretwin

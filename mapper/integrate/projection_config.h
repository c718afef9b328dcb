// Constants of integration by projection; see projective_integrator.h.
#pragma once

#include "core/fields.h"

namespace waretwin {

struct ProjectionConfig {
  int patch_px = 0;
  double max_incidence_deg = 85.0;
  double depth_noise_share = 0.01;
  bool plane_distance = true;
  bool reject_edges = true;
  bool incidence_weight = true;
  double grow_weight = 0.3;
  double behind_voxels = 2.0;
  double along_truncations = 2.0;
  bool forget = true;
  int memory_frames = 15;

  void visit(Fields& f) {
    f("patch_px", patch_px,
      "depth is gathered into patches of so many pixels squared; 0: as many (1, 2, 4 or 8) as are at most half a voxel at 1.5 m",
      {.min = 0, .max = 8});
    f("max_incidence_deg", max_incidence_deg, "patches seen flatter than this from their normal make no surface", {.min = 10, .max = 89});
    f("depth_noise_share", depth_noise_share,
      "neighbouring patches whose depths differ by more than this share from a common plane belong to two surfaces",
      {.min = 0.0001, .max = 0.5});
    f("plane_distance", plane_distance, "distances are taken across the patch's plane; false: along the optical axis");
    f("reject_edges", reject_edges, "no surface from patches that lie between two depths or alone (flying pixels)");
    f("incidence_weight", incidence_weight, "a patch weighs by the cosine of its incidence");
    f("grow_weight", grow_weight,
      "a patch without a surface takes over its nearest neighbour's at this share of the weight, so that rims are whole; 0: never",
      {.min = 0, .max = 1});
    f("behind_voxels", behind_voxels, "distances are kept up to this many voxels behind a surface", {.min = 1, .max = 32});
    f("along_truncations", along_truncations,
      "voxels farther from the surface than this many truncation distances, in depth, are left alone, however near to its plane",
      {.min = 1, .max = 100});
    f("forget", forget, "a voxel seen through more often than its surface was seen loses distance, weight and labels");
    f("memory_frames", memory_frames, "frames for or against a surface count no further than this many (against: four times as many)",
      {.min = 1, .max = 60});
  }
};

}  // namespace waretwin

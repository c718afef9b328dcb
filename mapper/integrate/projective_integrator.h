// Integration by projection: each voxel near what a frame shows is looked up in the depth image, instead of rays being cast at it.
//
// The depth image is made into small planes first (surface_patches.h). A voxel whose centre p (camera's frame) projects into a patch with
// the plane n . p = h is updated by
//   distance d = h - n . p, across the plane and so right at any incidence, for -behind <= d <= truncation, and no farther from the plane
//   along the optical axis than along_truncations times that reach; weight w = the patch's (1 / depth^2, cosine of incidence, share of its
//   pixels that are valid), falling linearly to 0 from one voxel behind the surface to behind_voxels; both averaged into the voxel by
//   weight, as is the patch's colour.
// Eq. (6): where |d| is within the label band, the voxel's count of the patch's label rises by one.
//
// A voxel that is not updated counts as seen through when all valid depths around it lie more than a truncation distance behind it
// (free_space.h says why). Evidence for a surface (updates with d >= -1 voxel) and against it (seen through, or seen more than two voxels
// before another surface) is counted per voxel, each frame for taking back two against; both stop at a limit, so that what came or left
// late is noticed as soon as what did early. Where more than twice as much speaks against a surface as for it, the voxel forgets distance,
// weight, colour and labels: things that moved leave nothing behind. Voxels more than one voxel before a surface are not forgotten: to be
// free is what they say.
//
// The same at any number of threads: blocks are found in order, each is worked on by one thread, and new ones are put into the volume in
// that order.
#pragma once

#include "mapper/integrate/integrator.h"
#include "mapper/integrate/tsdf_config.h"

namespace waretwin {

class ProjectiveIntegrator : public Integrator {
 public:
  explicit ProjectiveIntegrator(const TsdfConfig& config) : config_(config) {}

  // Throws Error when the volume has another voxel size or truncation than this configuration (a map that is resumed with other
  // settings), and when the pose leads out of the volume's reach (8 million voxels).
  void integrate(const RgbdFrame& frame, const Intrinsics& intrinsics, const std::vector<std::int32_t>& labels, const Pose& X_WC,
                 TsdfVolume& volume) override;

 private:
  TsdfConfig config_;
};

}  // namespace waretwin

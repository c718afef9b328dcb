// Voxblox's grouped ray casting with labels (section 3.4; Oleynikova et al. 2017).
//
// All points of a frame that fall into one voxel are one group: mean position (weighted as below), mean colour, and the label that most
// of them carry (of equally many the smallest). One ray a group runs from the camera's centre through the mean position and updates
// the voxels it crosses between one truncation distance before and one behind it:
//   distance d = |p| - c . p / |p|   with p the mean position and c the voxel's centre, both from the camera's centre, cut to +-
//   truncation; weight   w = sum of 1 / depth^2 over the group's points (or their number), falling linearly to 0 from one voxel behind the
//   surface
//                to the truncation distance behind it;
//   both averaged into the voxel by weight, as is the colour.
// Eq. (6): a voxel's count of a label rises by one in a frame, however many rays with that label pass it within the label band.
// Free space is recorded apart from the distances; see free_space.h.
//
// The result is the same at any number of threads: rays are cast in fixed pieces in the order of their voxels, and the updates of a
// block are applied in that order.
#pragma once

#include "mapper/integrate/integrator.h"
#include "mapper/integrate/tsdf_config.h"

namespace waretwin {

class GroupedRayIntegrator : public Integrator {
 public:
  explicit GroupedRayIntegrator(const TsdfConfig& config) : config_(config) {}

  // Throws Error when the volume has another voxel size or truncation than this configuration (a map that is resumed with other
  // settings), and when the pose leads out of the volume's reach (8 million voxels).
  void integrate(const RgbdFrame& frame, const Intrinsics& intrinsics, const std::vector<std::int32_t>& labels, const Pose& X_WC,
                 TsdfVolume& volume) override;

 private:
  TsdfConfig config_;
};

}  // namespace waretwin

// Open3D's VoxelBlockGrid on the benchmark's frames, where libopen3d-dev is there: the peer whose ratio the integration is judged by.
#pragma once

#include <memory>

#include "core/pose.h"
#include "sensors/intrinsics.h"
#include "sensors/measurements.h"

namespace waretwin::bench {

class Open3dPeer {
 public:
  // Blocks of 16 voxels of 2 cm, truncation 8 cm, 16-bit weights and colours: Open3D's fast mode.
  explicit Open3dPeer(const Intrinsics& intrinsics);
  ~Open3dPeer();
  // Makes the frame ready (16-bit depth, red before blue); not counted.
  void prepare(const RgbdFrame& frame, const Pose& X_WC);
  // Finds the frame's blocks and integrates depth and colour.
  void integrate();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace waretwin::bench

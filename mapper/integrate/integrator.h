// Stage 5 of the pipeline (section 3.4): labelled points into the TSDF volume.
#pragma once

#include <cstdint>
#include <vector>

#include "core/pose.h"
#include "mapper/integrate/tsdf_volume.h"
#include "sensors/intrinsics.h"
#include "sensors/measurements.h"

namespace waretwin {

class Integrator {
 public:
  virtual ~Integrator() = default;
  // `labels` holds one map id per pixel, row by row, 0 = background; empty means all background.
  virtual void integrate(const RgbdFrame& frame, const Intrinsics& intrinsics, const std::vector<std::int32_t>& labels, const Pose& X_WC,
                         TsdfVolume& volume) = 0;
};

}  // namespace waretwin

// A depth image as small plane patches: what the projective integrator updates voxels with.
//
// Seen by a pinhole camera, the inverse depth of a plane is a linear function of the pixel: with q = n / h of the plane n . p = h, the
// pixel's ray r (z = 1) meets it where q . r = 1 / z. So averages and slopes of inverse depth, which are cheap, are those of planes,
// without bias from perspective. Per patch of patch_px squared pixels:
//   1. mean of inverse depth over the valid pixels; where they belong to two depths (spread beyond any slope), over the larger part;
//   2. its slopes along u and v from the neighbouring patches; where the two sides disagree (an edge, a crease) the flatter one alone;
//   3. the slopes averaged with those neighbours that lie on the same plane.
// A patch makes no surface when it is seen flatter than max_incidence, when fewer than two of its eight neighbours lie on its plane, or
// when its own pixels spread more than its slope explains: flying pixels between two surfaces fail one of these.
//   4. beside a surface (above, below, left, right), a patch without one takes over the nearest such neighbour's, with label and colour, at
//      a small share of its weight (grow_weight): no patch else shows the voxels at the rim of a thing, and a mesh needs all eight corners
//      of a cell. Not from neighbours that cover more than two voxels, which would reach far. Measurements of other frames outweigh it.
#pragma once

#include <cstdint>
#include <vector>

#include "mapper/integrate/tsdf_config.h"
#include "sensors/intrinsics.h"
#include "sensors/measurements.h"

namespace waretwin {

// One patch: the plane n . p_C = h in the camera's frame, h > 0, n unit and away from the camera.
struct SurfacePatch {
  float nx = 0.0f, ny = 0.0f, nz = 0.0f;
  float h = 0.0f;       // metres
  float weight = 0.0f;  // 0: no surface here
  std::uint8_t red = 0, green = 0, blue = 0, unused = 0;
  std::int32_t label = 0;  // of most of its pixels; of equally many the smallest
  float depth = 0.0f;      // metres along the optical axis, at its middle
};

// The same plane alone, for a first look at a voxel; h far below 0 where the patch makes no surface.
struct PatchPlane {
  static constexpr float kNoSurface = -1e9f;
  float nx = 0.0f, ny = 0.0f, nz = 0.0f, h = kNoSurface;
};

struct PatchImage {
  int patch_px = 0;                   // pixels along an edge
  int width = 0, height = 0;          // patches
  std::vector<SurfacePatch> patches;  // row by row, and one more at the end that makes no surface
  std::vector<PatchPlane> planes;     // one a patch

  const SurfacePatch& at(int x, int y) const {
    return patches[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  }
};

// What patch_px = 0 stands for.
int chosen_patch_px(const TsdfConfig& config, const Intrinsics& intrinsics);

// `labels` holds one id per pixel or is empty. Pixels beyond config.max_depth_m are left out.
PatchImage make_patches(const RgbdFrame& frame, const Intrinsics& intrinsics, const std::vector<std::int32_t>& labels,
                        const TsdfConfig& config);

}  // namespace waretwin

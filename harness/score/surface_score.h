// How well the map's surface is the hall's: score.json's `surface`.
#pragma once

#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "core/pose.h"
#include "mapper/integrate/mesher.h"
#include "sensors/camera_config.h"

namespace waretwin {

class RayCaster;

struct SurfaceScore {
  // Distance of the mesh's vertices to the nearest true surface, as the hall stands at the end (metres; at most 1 m).
  int vertices = 0;
  double mean_m = 0.0, median_m = 0.0, p95_m = 0.0;
  double share_over_30mm = 0.0;         // of the vertices: ghosts of what moved, sheets at the rims of things, flying pixels
  std::vector<float> distances_m = {};  // of each vertex, in the mesh's order
  // Share of the true surface that the mapped frames saw and the mesh has within 3 cm.
  int seen_points = 0;
  double found = 0.0;
};

// Collects what the mapped frames could see: every 8th pixel along both axes, cast at the true hall without noise, that lies in the depth
// field and range and shows a surface no flatter than 80 deg. One point is kept per cell of 2 cm. Points whose surface is gone at the end
// do not count.
class SurfaceMeter {
 public:
  explicit SurfaceMeter(std::shared_ptr<const RayCaster> ray_caster);

  // A frame that was mapped; the hall stands as it did then.
  void add_frame(const CameraConfig& camera, const Pose& X_WC);
  // Against the hall as it stands now. Zeros for an empty mesh.
  SurfaceScore result(const SurfaceMesh& mesh) const;

 private:
  std::shared_ptr<const RayCaster> ray_caster_;
  std::unordered_map<std::uint64_t, std::uint32_t> cells_;
  std::vector<Eigen::Vector3f> points_W_;
};

}  // namespace waretwin

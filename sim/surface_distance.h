// How far points lie from a surface of triangles (Embree 3's point queries).
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace waretwin {

class RayCaster;

struct TriangleSoup {
  std::vector<Eigen::Vector3f> vertices;                // metres
  std::vector<std::array<std::uint32_t, 3>> triangles;  // indices into vertices
};

// All triangles of the instances that are there, as they stand now (in the middle of the shutter), in the world's frame. Holes of
// alpha-masked surfaces are not cut out.
TriangleSoup world_triangles(const RayCaster& ray_caster);

class SurfaceDistance {
 public:
  explicit SurfaceDistance(TriangleSoup soup);
  ~SurfaceDistance();
  SurfaceDistance(const SurfaceDistance&) = delete;
  SurfaceDistance& operator=(const SurfaceDistance&) = delete;

  // Distance in metres to the nearest point of any triangle; `farthest` where none lies nearer. May run from several threads at once.
  float to(const Eigen::Vector3f& p, float farthest) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// Distance of a point to a triangle (Ericson, Real-Time Collision Detection, 5.1.5).
float distance_to_triangle(const Eigen::Vector3f& p, const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c);

}  // namespace waretwin

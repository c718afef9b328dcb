// Rays against a hall's triangles (Embree 3).
//
// Sensors see both sides of every triangle, whatever its material says: a thin panel modelled as one sheet is as solid as the real one.
// Parts of an alpha-masked surface below the cutoff are holes. Results are the same at any thread count: the trees are built by one
// thread, and a ray's result depends on nothing but the ray and the packet of eight that it travels in.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>

#include "core/fields.h"
#include "scenes/scene.h"

namespace waretwin {

struct RayCasterOptions {
  // sse2, sse4.2, avx, avx2 or avx512. One fixed set by default: each set rounds differently in the last bits.
  std::string isa = "avx2";
  void visit(Fields& f);
};

// In the world frame. The direction need not be a unit vector; distances count in its lengths.
struct Ray {
  Eigen::Vector3f origin = Eigen::Vector3f::Zero();
  float near = 0.0f;
  Eigen::Vector3f direction = Eigen::Vector3f::UnitX();
  float far = std::numeric_limits<float>::infinity();

  Eigen::Vector3f at(float distance) const { return origin + distance * direction; }
};

struct Hit {
  float distance = std::numeric_limits<float>::infinity();  // in lengths of the ray's direction
  int instance = -1;                                        // index into Scene::instances; -1 = nothing hit
  int primitive = -1;                                       // triangle of the instance's mesh
  float u = 0.0f, v = 0.0f;                                 // barycentric weights of the triangle's second and third corner

  bool valid() const { return instance >= 0; }
};

// How alike the rays of a packet are; decides how the tree is walked, never what is hit.
enum class Coherence { kCoherent, kIncoherent };

// Where an instance stands, with what shading needs of it at every hit.
struct Placement {
  Placement() = default;
  explicit Placement(const Eigen::Affine3f& X);

  Eigen::Affine3f X_WM = Eigen::Affine3f::Identity();
  Eigen::Matrix3f cofactors = Eigen::Matrix3f::Identity();  // takes normals from M to W, also where X_WM scales unevenly; not unit
  float mean_scale = 1.0f;                                  // by which X_WM stretches lengths
};

class RayCaster {
 public:
  // Throws Error for a scene without triangles, an unknown instruction set, or one that this CPU lacks (naming it).
  explicit RayCaster(std::shared_ptr<const Scene> scene, const RayCasterOptions& options = {});
  ~RayCaster();
  RayCaster(const RayCaster&) = delete;
  RayCaster& operator=(const RayCaster&) = delete;

  const Scene& scene() const;
  std::shared_ptr<const Scene> shared_scene() const;

  // First surface between the ray's near and far. All queries may run from several threads at once.
  Hit cast(const Ray& ray) const;
  // Many rays, in packets of eight from the front; as many hits as rays.
  void cast(std::span<const Ray> rays, std::span<Hit> hits, Coherence coherence = Coherence::kIncoherent) const;
  // Whether anything lies between near and far.
  bool occluded(const Ray& ray) const;
  // blocked[i] becomes 1 or 0. A ray whose far is below its near is not traced and counts as free.
  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked, Coherence coherence = Coherence::kIncoherent) const;

  // Moves an instance; takes effect with commit(). Neither may run while rays are cast.
  void set_transform(int instance, const Eigen::Affine3f& X_WM);
  void commit();
  const Eigen::Affine3f& transform(int instance) const { return placement(instance).X_WM; }
  const Placement& placement(int instance) const;
  // Bounds of all instances at their present places.
  Eigen::AlignedBox3f bounds() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace waretwin

// Rays against a hall's triangles (Embree 3).
//
// Sensors see both sides of every triangle, whatever its material says: a thin panel modelled as one sheet is as solid as the real one.
// Parts of an alpha-masked surface below the cutoff are holes. Results are the same at any thread count: the trees are built by one
// thread, and a ray's result depends on nothing but the ray and the packet of eight that it travels in.
// The vehicle's own model (Scene::vehicle) is not there until somebody places it.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>

#include "core/fields.h"
#include "core/stamp.h"
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
  float time = 0.5f;  // when it travels, as a share of the shutter: 0 = begin, 1 = end (RayCaster::time_of)

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
  // The same as cast in a hall where nothing stands but the instances of one object (an index into Scene::objects). An object's tree is
  // made when it is first asked for.
  void cast_object(int object, std::span<const Ray> rays, std::span<Hit> hits, Coherence coherence = Coherence::kIncoherent) const;

  // What follows changes the hall; it takes effect with commit(), which costs nothing where nothing has changed. None of it may run while
  // rays are cast.
  // Puts an instance where it stands during the whole shutter.
  void set_transform(int instance, const Eigen::Affine3f& X_WM);
  // Moves an instance evenly during the shutter: its matrix is interpolated linearly between the two, by Ray::time.
  void set_motion(int instance, const Eigen::Affine3f& X_WM_begin, const Eigen::Affine3f& X_WM_end);
  // Instances are there (the default) or not.
  void set_present(int instance, bool present);
  void commit();

  // The stretch of time that rays are cast in; Ray::time counts within it. Changes no instance by itself.
  void set_shutter(Stamp begin, Stamp end);
  // Ray::time of a moment; clamped to the shutter. 0.5 for an empty shutter, the default.
  float time_of(Stamp moment) const;

  // Where an instance stands in the middle of the shutter; normals and textures are looked up there.
  const Eigen::Affine3f& transform(int instance) const { return placement(instance).X_WM; }
  const Placement& placement(int instance) const;
  // Bounds of a present instance over the whole shutter; empty for one that is not there or has no triangles.
  Eigen::AlignedBox3f bounds(int instance) const;
  // Bounds of all present instances, over the whole shutter.
  Eigen::AlignedBox3f bounds() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace waretwin

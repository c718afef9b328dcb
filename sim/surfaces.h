// What a ray sees where it hits: position, normals, and the material's values there.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "sim/ray_caster.h"
#include "sim/texture_sampler.h"

namespace waretwin {

struct SurfacePoint {
  Eigen::Vector3f position;     // p_W
  Eigen::Vector3f face_normal;  // of the triangle, unit, towards where the ray came from
  Eigen::Vector3f normal;       // for shading: interpolated and bent by the normal map; unit, on the same side as face_normal
  Eigen::Vector3f base_colour;  // linear RGB in [0, 1]
  float metallic = 0.0f, roughness = 1.0f;
  Eigen::Vector3f emissive;  // radiance, linear RGB
};

class Surfaces {
 public:
  explicit Surfaces(std::shared_ptr<const RayCaster> ray_caster);

  // `spread` is the angle in radians that one sample covers; it picks the texture size. The hit must be valid.
  SurfacePoint at(const Ray& ray, const Hit& hit, float spread) const;
  // The same for a hit of the same triangle about a pixel from `near`, which at() gave: its normals are taken to be those of `near`.
  SurfacePoint beside(const SurfacePoint& near, const Ray& ray, const Hit& hit, float spread) const;
  const Material& material(const Hit& hit) const;
  // Interpolated texture coordinates of set 0 or 1, before any texture transform; zero where the mesh has none.
  Eigen::Vector2f uv(const Hit& hit, int set) const;
  // Normal of the hit triangle's plane in the world, unit, towards where the ray came from.
  Eigen::Vector3f face_normal(const Ray& ray, const Hit& hit) const;

 private:
  struct Use {  // a material's texture
    const TextureSampler* sampler = nullptr;
    int uv_set = 0;
    Eigen::Matrix<float, 2, 3> transform;
    float scale = 1.0f;  // of lengths in uv units by the transform
  };
  struct MaterialUse {
    Use base_colour, metallic_roughness, normal, emissive;
    bool textured = false;
  };
  struct Corners {
    std::uint32_t i[3];
    float w[3];
  };
  // A hit with what belongs to it.
  struct Place {
    const Instance& instance;
    const Mesh& mesh;
    const Material& material;
    const MaterialUse& use;
    const Placement& placement;
    Corners corners;
  };
  // How much of a texture a pixel covers.
  struct Footprint {
    float size_M = 0.0f, per_metre = 0.0f;
  };

  Place place(const Hit& hit) const;
  Footprint footprint(const Place& at, const Ray& ray, const Hit& hit, const Eigen::Vector3f& face_normal, float spread) const;
  static Eigen::Vector3f base_colour(const Place& at, const Footprint& footprint);

  Use make_use(const TextureUse& use, TextureSampler::Encoding encoding);
  Corners corners(const Mesh& mesh, const Hit& hit) const;
  static Eigen::Vector4f sample(const Use& use, const Mesh& mesh, const Corners& c, float footprint_M, float uv_density);
  void bend(SurfacePoint& point, const Use& use, float normal_scale, const Mesh& mesh, const Corners& c, const Eigen::Affine3f& X_WM,
            float footprint_M, float uv_density) const;

  std::shared_ptr<const RayCaster> ray_caster_;
  std::vector<std::unique_ptr<TextureSampler>> colour_samplers_, data_samplers_;  // by texture; made where used
  std::vector<MaterialUse> materials_;
  std::vector<std::vector<float>> uv_density_;  // by mesh, by triangle: uv lengths per metre of the mesh, set 0
};

}  // namespace waretwin

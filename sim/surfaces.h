// What a ray sees where it hits: position, normals, and the material's values there.
#pragma once

#include <Eigen/Core>
#include <cstdint>
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

// Base colours of one triangle for hits about a pixel from each other.
class FaceColours {
 public:
  // Linear RGB in [0, 1]; the fourth number means nothing. The hit must be of the same triangle.
  Eigen::Vector4f at(const Hit& hit) const {
    Eigen::Vector4f colour = first_ + hit.u * to_second_ + hit.v * to_third_;
    if (sampler_ != nullptr) {
      colour = colour.cwiseProduct(sampler_->sample_level(uv_first_ + hit.u * uv_to_second_ + hit.v * uv_to_third_, level_));
    }
    return colour.cwiseMax(0.0f).cwiseMin(1.0f);
  }
  bool is_constant() const { return constant_; }

 private:
  friend class Surfaces;
  bool constant_ = true;
  // At the triangle's first corner, and how much they change towards the others.
  Eigen::Vector4f first_, to_second_ = Eigen::Vector4f::Zero(), to_third_ = Eigen::Vector4f::Zero();
  const TextureSampler* sampler_ = nullptr;
  int level_ = 0;
  Eigen::Vector2f uv_first_, uv_to_second_, uv_to_third_;
};

class Surfaces {
 public:
  explicit Surfaces(std::shared_ptr<const RayCaster> ray_caster);

  // `spread` is the angle in radians that one sample covers; it picks the texture size. The hit must be valid.
  SurfacePoint at(const Ray& ray, const Hit& hit, float spread) const;
  // Whether the hit's material has one roughness, emission and shape of normals all over, so that nothing but the base colour differs
  // between neighbouring hits of a triangle.
  bool only_colour_varies(const Hit& hit) const;
  // Colours around a hit; `point` is what at() gave for it.
  FaceColours face_colours(const Ray& ray, const Hit& hit, const SurfacePoint& point, float spread) const;
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
    bool textured = false, only_colour_varies = true;
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

  const Mesh& mesh(const Hit& hit) const;
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

#include "sim/tile_shader.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace waretwin {

namespace {

// Light hardly changes from pixel to pixel of one triangle, or of one smooth surface, unless its depth does. This much of it over a packet,
// twice as much over a quad, leaves four pixels of a thousand more than 3 % off (tile_shader_test.cpp); most are in highlights.
constexpr float kDepthStep = 0.01f;
constexpr float kSameNormal = 0.9998f;  // cosine
// A rougher surface's highlight hardly changes over four pixels, either.
constexpr float kBroadLobe = 0.45f;
constexpr std::size_t kQuad = 4, kPacket = 8;  // pixels

bool near_in_depth(float depth, float other, std::size_t count) {
  return std::abs(depth - other) < (count == kPacket ? kDepthStep : 2.0f * kDepthStep) * other;
}

Eigen::Vector4f with_zero(const Eigen::Vector3f& v) { return {v.x(), v.y(), v.z(), 0.0f}; }

// What a surface sends to the viewer for base colours from black to white, all else settled: affine in the colour for what is either
// metal or not.
struct ColourRamp {
  Eigen::Vector4f black, rise;
  Eigen::Vector4f at(const Eigen::Vector4f& colour) const { return black + rise.cwiseProduct(colour); }
};

}  // namespace

TileShader::TileShader(const RayCaster& ray_caster, const Surfaces& surfaces, const DirectLight& lights, bool shadows, float spread,
                       std::uint32_t seed, LitPicture& picture)
    : ray_caster_(ray_caster), surfaces_(surfaces), lights_(lights), shadows_(shadows), spread_(spread), points_(seed), picture_(picture) {}

void TileShader::shade(const PixelTile& tile) {
  ray_count_ = 0;
  for (std::size_t first = 0; first < PixelTile::kPixels; first += kPacket) {
    if (on_one_face(tile, first, kPacket) && surfaces_.material(tile.hits[first]).roughness >= kBroadLobe) {
      shade_face(tile, first, kPacket);
      continue;
    }
    for (const std::size_t quad : {first, first + kQuad}) {
      if (on_one_face(tile, quad, kQuad)) {
        shade_face(tile, quad, kQuad);
      } else {
        shade_apart(tile, quad);
      }
    }
  }
  if (ray_count_ > 0) cast_shadows();
}

// Whether all pixels of a quad or packet show one triangle, where nothing but the base colour differs.
bool TileShader::on_one_face(const PixelTile& tile, std::size_t first, std::size_t count) const {
  const PixelTile::Offset& last = PixelTile::kOrder[first + count - 1];
  if (tile.left + last.x >= picture_.width || tile.top + last.y >= picture_.height) return false;
  const auto hits = std::span(tile.hits).subspan(first, count);
  const Hit& one = hits.front();
  return one.valid() &&
         std::all_of(hits.begin() + 1, hits.end(),
                     [&one, count](const Hit& hit) {
                       return hit.instance == one.instance && hit.primitive == one.primitive &&
                              near_in_depth(hit.distance, one.distance, count);
                     }) &&
         surfaces_.only_colour_varies(one);
}

TileShader::Look TileShader::look(const Ray& ray, const Hit& hit) const {
  Look out;
  out.point = surfaces_.at(ray, hit, spread_);
  out.v = -ray.direction.normalized();
  out.n_dot_v = std::max(out.point.normal.dot(out.v), 1e-3f);
  out.reflection = reflection_of(out.point, out.n_dot_v);
  out.cosine = std::max(out.point.face_normal.dot(out.v), 0.05f);
  out.depth = hit.distance;
  const Eigen::Vector3f& n = out.point.face_normal;
  out.normal = packed_normal(n.x(), n.y(), n.z());
  return out;
}

// All but the light itself. `position` is the pixel's own; the look may be a neighbour's.
[[gnu::always_inline]] inline void TileShader::write_surface(int x, int y, const Hit& hit, const Look& look,
                                                             const Eigen::Vector3f& position, float time) {
  const std::size_t p = picture_.index(x, y);
  picture_.glows[p] = look.point.emissive.isZero(0.0f) ? 0 : 1;
  if (picture_.glows[p]) picture_.emitted[p] = look.point.emissive;
  picture_.guide.depth[p] = hit.distance;
  picture_.guide.tolerance[p] = hit.distance * (1.5f * spread_ / look.cosine + 0.001f);
  picture_.guide.normal[p] = look.normal;
  if (((x | y) & 1) == 0) {
    const std::size_t h = picture_.half_index(x, y);
    picture_.half_guide.depth[h] = hit.distance;
    picture_.half_guide.tolerance[h] = 2.0f * picture_.guide.tolerance[p];
    picture_.half_guide.normal[h] = look.normal;
    picture_.half_positions[h] = lifted(position, look.point.face_normal);
    picture_.half_normals[h] = look.point.face_normal;
    picture_.half_times[h] = time;
  }
}

[[gnu::always_inline]] inline void TileShader::look_for_light(int x, int y, const Look& look, const Eigen::Vector3f& position, float time) {
  const std::size_t p = picture_.index(x, y);
  picture_.visible[p] = 1.0f;
  if (!shadows_ || !(parts_.total > 0.0f)) return;
  if (!SpreadPoints::looks_from(x, y)) {
    picture_.visible[p] = kUnknown;
    return;
  }
  const SpreadPoint sample = points_.at(x, y);
  const int light = DirectLight::choose(parts_, sample.a);
  Shadow& shadow = rays_[ray_count_++];
  shadow = {light, p, lights_.shadow_ray(light, lifted(position, look.point.face_normal), sample.b, sample.c)};
  shadow.ray.time = time;
}

void TileShader::shade_face(const PixelTile& tile, std::size_t first, std::size_t count) {
  const std::size_t middle = first + count / 2 - 1;
  const Look look = this->look(tile.rays[middle], tile.hits[middle]);
  lights_.irradiate(look.point, look.reflection, look.v, parts_);
  const Eigen::Vector3f& around = ray_caster_.scene().ambient;
  const auto direct_of = [&](const Reflection& r) { return with_zero(parts_.reflected_by(r)); };
  const auto ambient_of = [&](const Reflection& r) { return with_zero(around.cwiseProduct(r.diffuse + r.glossy_albedo)); };
  const FaceColours colours = surfaces_.face_colours(tile.rays[middle], tile.hits[middle], look.point, spread_);
  const bool plain = colours.is_constant(), affine = look.point.metallic <= 0.0f || look.point.metallic >= 1.0f;
  ColourRamp direct{direct_of(look.reflection), Eigen::Vector4f::Zero()}, ambient{ambient_of(look.reflection), Eigen::Vector4f::Zero()};
  if (!plain && affine) {
    SurfacePoint point = look.point;
    point.base_colour.setZero();
    const Reflection black = reflection_of(point, look.n_dot_v);
    point.base_colour.setOnes();
    const Reflection white = reflection_of(point, look.n_dot_v);
    direct = {direct_of(black), direct_of(white) - direct_of(black)};
    ambient = {ambient_of(black), ambient_of(white) - ambient_of(black)};
  }
  for (std::size_t i = first; i < first + count; ++i) {
    const int x = tile.left + PixelTile::kOrder[i].x, y = tile.top + PixelTile::kOrder[i].y;
    const std::size_t p = picture_.index(x, y);
    const Hit& hit = tile.hits[i];
    if (plain || affine) {
      const Eigen::Vector4f colour = plain ? Eigen::Vector4f(Eigen::Vector4f::Zero()) : colours.at(hit);
      picture_.direct[p] = direct.at(colour);
      picture_.ambient[p] = ambient.at(colour);
    } else {
      SurfacePoint point = look.point;
      point.base_colour = colours.at(hit).head<3>();
      const Reflection reflection = reflection_of(point, look.n_dot_v);
      picture_.direct[p] = direct_of(reflection);
      picture_.ambient[p] = ambient_of(reflection);
    }
    const Eigen::Vector3f position = tile.rays[i].at(hit.distance);
    write_surface(x, y, hit, look, position, tile.rays[i].time);
    look_for_light(x, y, look, position, tile.rays[i].time);
  }
}

// Pixels of a quad that have more than one face, or one whose material varies in more than colour. Those of one smooth surface share the
// light that falls on it.
void TileShader::shade_apart(const PixelTile& tile, std::size_t first) {
  std::array<Look, 4> looks;
  const Look* lit = nullptr;  // what parts_ is of
  int lit_instance = -1;
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t i = first + k;
    const int x = tile.left + PixelTile::kOrder[i].x, y = tile.top + PixelTile::kOrder[i].y;
    if (x >= picture_.width || y >= picture_.height) continue;
    const Hit& hit = tile.hits[i];
    if (!hit.valid()) {
      write_background(x, y);
      continue;
    }
    const Look& own = looks[k] = look(tile.rays[i], hit);
    const bool shared = lit != nullptr && lit_instance == hit.instance && lit->reflection.roughness == own.reflection.roughness &&
                        lit->point.normal.dot(own.point.normal) > kSameNormal && near_in_depth(lit->depth, hit.distance, kQuad);
    if (!shared) {
      lights_.irradiate(own.point, own.reflection, own.v, parts_);
      lit = &own;
      lit_instance = hit.instance;
    }
    const std::size_t p = picture_.index(x, y);
    picture_.direct[p] = with_zero(parts_.reflected_by(own.reflection));
    picture_.ambient[p] = with_zero(ray_caster_.scene().ambient.cwiseProduct(own.reflection.diffuse + own.reflection.glossy_albedo));
    write_surface(x, y, hit, own, own.point.position, tile.rays[i].time);
    look_for_light(x, y, own, own.point.position, tile.rays[i].time);
  }
}

void TileShader::write_background(int x, int y) {
  const std::size_t p = picture_.index(x, y);
  picture_.visible[p] = 1.0f;
  picture_.direct[p].setZero();
  picture_.ambient[p].setZero();
  picture_.glows[p] = 1;
  picture_.emitted[p] = ray_caster_.scene().background;
  picture_.guide.depth[p] = picture_.guide.tolerance[p] = 0.0f;
  picture_.guide.normal[p] = 0;
  if (((x | y) & 1) != 0) return;
  const std::size_t h = picture_.half_index(x, y);
  picture_.half_guide.depth[h] = picture_.half_guide.tolerance[h] = 0.0f;
  picture_.half_guide.normal[h] = 0;
}

void TileShader::cast_shadows() {
  // Rays to one light travel together.
  std::array<std::uint8_t, PixelTile::kPixels> order;
  place_.assign(lights_.count() + 1, 0);
  const auto shadows = std::span(rays_).first(ray_count_);
  for (const Shadow& shadow : shadows) ++place_[static_cast<std::size_t>(shadow.light) + 1];
  for (std::size_t light = 1; light < place_.size(); ++light) place_[light] = static_cast<std::uint8_t>(place_[light] + place_[light - 1]);
  for (std::size_t i = 0; i < shadows.size(); ++i)
    order[place_[static_cast<std::size_t>(shadows[i].light)]++] = static_cast<std::uint8_t>(i);
  std::array<Ray, PixelTile::kPixels> rays_by_light;
  std::array<std::uint8_t, PixelTile::kPixels> blocked;
  for (std::size_t i = 0; i < shadows.size(); ++i) rays_by_light[i] = shadows[order[i]].ray;
  ray_caster_.occluded(std::span(rays_by_light.data(), shadows.size()), std::span(blocked.data(), shadows.size()), Coherence::kCoherent);
  for (std::size_t i = 0; i < shadows.size(); ++i) {
    if (blocked[i]) picture_.visible[shadows[order[i]].pixel] = 0.0f;
  }
}

}  // namespace waretwin

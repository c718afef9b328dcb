#include "sim/renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"
#include "sensors/tone_curve.h"
#include "sim/direct_light.h"
#include "sim/guided_filter.h"
#include "sim/path_tracer.h"
#include "sim/pixel_random.h"
#include "sim/pixel_rays.h"
#include "sim/reflection.h"
#include "sim/surfaces.h"

namespace waretwin {

namespace {

// Pictures are made in tiles of 16 x 8 pixels, whose rays travel in packets of 4 x 2.
constexpr int kTileWidth = 16, kTileHeight = 8, kTilePixels = kTileWidth * kTileHeight;
constexpr int kPacketWidth = 4, kPacketHeight = 2;

// Ambient light is blocked by what is nearer than this (metres), less so the farther it is.
constexpr float kOcclusionReach = 1.6f;
constexpr int kOcclusionRays = 1;
constexpr int kShadowRadius = 4, kOcclusionRadius = 4;

struct PixelOffset {
  int x, y;
};

// Pixel of the i-th ray of a tile: packet by packet, in each the 2 x 2 quads one after the other.
constexpr std::array<PixelOffset, kTilePixels> make_tile_order() {
  std::array<PixelOffset, kTilePixels> order{};
  int i = 0;
  for (int py = 0; py < kTileHeight; py += kPacketHeight) {
    for (int px = 0; px < kTileWidth; px += kPacketWidth) {
      for (int qx = 0; qx < kPacketWidth; qx += 2) {
        for (int k = 0; k < 4; ++k) order[static_cast<std::size_t>(i++)] = {px + qx + (k & 1), py + (k >> 1)};
      }
    }
  }
  return order;
}
constexpr auto kTileOrder = make_tile_order();

// What the rays of one tile hit, in the order of kTileOrder; those beyond the picture's border are there too.
struct Tile {
  int left = 0, top = 0;
  std::array<Ray, kTilePixels> rays;
  std::array<Hit, kTilePixels> hits;
};

// Pixels in Z-order: every aligned block of 2^n x 2^n pixels holds consecutive numbers.
std::uint32_t spread_bits(std::uint32_t v) {
  v = (v | v << 8) & 0x00ff00ffu;
  v = (v | v << 4) & 0x0f0f0f0fu;
  v = (v | v << 2) & 0x33333333u;
  return (v | v << 1) & 0x55555555u;
}
std::uint32_t z_order(int x, int y) { return spread_bits(static_cast<std::uint32_t>(x)) | spread_bits(static_cast<std::uint32_t>(y)) << 1; }

// Well spread points for neighbouring pixels: the k-th point of a rank-1 sequence in three dimensions (M. Roberts, "The unreasonable
// effectiveness of quasirandom sequences", 2018), dealt out along the Z-order, so that whatever a filter averages is nearly even (Ahmed
// and Wonka, "Screen-space blue-noise diffusion of Monte Carlo sampling error via hierarchical ordering of pixels", 2020). Each coordinate
// in [0, 1).
struct SpreadPoint {
  float a, b, c;
};
class SpreadPoints {
 public:
  explicit SpreadPoints(std::uint32_t seed) {
    PixelRandom random(seed, 0);
    for (std::uint32_t& shift : shift_) shift = static_cast<std::uint32_t>(random.uniform() * 0x1p32f);
  }
  SpreadPoint at(std::uint32_t k) const {
    const auto unit = [](std::uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; };
    return {unit(shift_[0] + k * 3518319155u), unit(shift_[1] + k * 2882110345u), unit(shift_[2] + k * 2360945575u)};
  }

 private:
  std::uint32_t shift_[3];
};

// Into whichever pictures were asked for.
struct LightRow {
  LightRow(FrameImages& images, int y)
      : colour(images.colour.empty() ? nullptr : images.colour.ptr<cv::Vec3b>(y)),
        radiance(images.radiance.empty() ? nullptr : images.radiance.ptr<cv::Vec4f>(y)) {}
  void set(int x, const Eigen::Vector3f& light) const {
    if (colour != nullptr) colour[x] = {tone_mapped(light.z()), tone_mapped(light.y()), tone_mapped(light.x())};
    if (radiance != nullptr) radiance[x] = {light.x(), light.y(), light.z(), 0.0f};
  }
  cv::Vec3b* colour;
  cv::Vec4f* radiance;
};

}  // namespace

struct Renderer::State {
  State(std::shared_ptr<const RayCaster> caster, const RenderOptions& render_options);

  std::shared_ptr<const RayCaster> ray_caster;
  RenderOptions options;
  Surfaces surfaces;
  DirectLight lights;
  std::vector<std::uint16_t> object_of_instance, class_of_instance;

  // Of the picture being made, row-major.
  int width = 0, height = 0;
  std::vector<Eigen::Vector3f> direct, ambient;
  std::vector<std::uint8_t> glows;  // 1: the pixel has a value in `emitted`, which few have
  std::vector<Eigen::Vector3f> emitted;
  std::vector<float> visible, openness, scratch;
  SurfaceGuide guide, half_guide;
  std::vector<Eigen::Vector3f> half_positions, half_normals;
  std::vector<float> half_times;

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
  void prepare(bool shaded);
  void look(const PixelRays& pixel_rays, const RenderRequest& request, const std::uint32_t* shadow_seed, FrameImages& images);
  void write_geometry(const Tile& tile, const PixelRays& pixel_rays, const RenderRequest& request, FrameImages& images) const;
  void shade(const Tile& tile, float spread, std::uint32_t seed, LightParts& parts);
  void find_openness(std::uint32_t seed);
  void compose(FrameImages& images) const;
  void trace_paths(const PixelRays& pixel_rays, std::uint32_t seed, FrameImages& images) const;
};

Renderer::State::State(std::shared_ptr<const RayCaster> caster, const RenderOptions& render_options)
    : ray_caster(caster), options(render_options), surfaces(caster), lights(caster->scene().lights) {
  const Scene& scene = ray_caster->scene();
  const std::vector<std::string> names = class_names(scene);
  for (const Instance& instance : scene.instances) {
    if (instance.object < 0) {
      object_of_instance.push_back(0);
      class_of_instance.push_back(0);
      continue;
    }
    const TrueObject& object = scene.objects[static_cast<std::size_t>(instance.object)];
    if (object.id < 1 || object.id > 65535)
      throw Error("object id " + std::to_string(object.id) + " does not fit an instance image; expected 1 to 65535");
    object_of_instance.push_back(static_cast<std::uint16_t>(object.id));
    class_of_instance.push_back(static_cast<std::uint16_t>(std::find(names.begin(), names.end(), object.class_name) - names.begin()));
  }
}

void Renderer::State::prepare(bool shaded) {
  if (!shaded) return;
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  direct.resize(pixels);
  ambient.resize(pixels);
  glows.resize(pixels);
  emitted.resize(pixels);
  visible.resize(pixels);
  guide.resize(width, height);
  half_guide.resize((width + 1) / 2, (height + 1) / 2);
  half_positions.resize(half_guide.depth.size());
  half_normals.resize(half_guide.depth.size());
  half_times.resize(half_guide.depth.size());
}

// Geometry and, with a seed for the shadow rays, light before shadows are smoothed. A tile's hits are used while they are in the cache.
void Renderer::State::look(const PixelRays& pixel_rays, const RenderRequest& request, const std::uint32_t* shadow_seed,
                           FrameImages& images) {
  prepare(shadow_seed != nullptr);
  images.depth.create(height, width, CV_32FC1);
  images.instances.create(height, width, CV_16UC1);
  if (request.classes) images.classes.create(height, width, CV_16UC1);
  if (request.normals) images.normals.create(height, width, CV_32FC3);
  const std::size_t tile_rows = static_cast<std::size_t>((height + kTileHeight - 1) / kTileHeight);
  parallel_for(tile_rows, 1, [&](std::size_t begin, std::size_t end) {
    Tile tile;
    LightParts parts;
    for (tile.top = static_cast<int>(begin) * kTileHeight; tile.top < static_cast<int>(end) * kTileHeight; tile.top += kTileHeight) {
      for (tile.left = 0; tile.left < width; tile.left += kTileWidth) {
        for (std::size_t i = 0; i < kTilePixels; ++i) {
          tile.rays[i] = pixel_rays.at(tile.left + kTileOrder[i].x, tile.top + kTileOrder[i].y);
        }
        ray_caster->cast(tile.rays, tile.hits, Coherence::kCoherent);
        write_geometry(tile, pixel_rays, request, images);
        if (shadow_seed != nullptr) shade(tile, pixel_rays.spread(), *shadow_seed, parts);
      }
    }
  });
}

void Renderer::State::write_geometry(const Tile& tile, const PixelRays& pixel_rays, const RenderRequest& request,
                                     FrameImages& images) const {
  for (std::size_t i = 0; i < kTilePixels; ++i) {
    const int x = tile.left + kTileOrder[i].x, y = tile.top + kTileOrder[i].y;
    if (x >= width || y >= height) continue;
    const Hit& hit = tile.hits[i];
    const auto instance = static_cast<std::size_t>(hit.instance);
    images.depth.ptr<float>(y)[x] = hit.valid() ? hit.distance : 0.0f;
    images.instances.ptr<std::uint16_t>(y)[x] = hit.valid() ? object_of_instance[instance] : std::uint16_t{0};
    if (request.classes) images.classes.ptr<std::uint16_t>(y)[x] = hit.valid() ? class_of_instance[instance] : std::uint16_t{0};
    if (request.normals) {
      Eigen::Vector3f n = Eigen::Vector3f::Zero();
      if (hit.valid()) n = pixel_rays.R_CW(y) * surfaces.face_normal(tile.rays[i], hit);
      images.normals.ptr<cv::Vec3f>(y)[x] = {n.x(), n.y(), n.z()};
    }
  }
}

void Renderer::State::shade(const Tile& tile, float spread, std::uint32_t seed, LightParts& parts) {
  const Scene& scene = ray_caster->scene();
  const SpreadPoints points(seed);
  struct Shadow {
    int light;
    std::size_t pixel;
    Ray ray;
  };
  std::array<Shadow, kTilePixels> shadows;
  // The last pixel that was shaded on its own, for those of its quad that look alike.
  struct {
    int x = -1, y = -1, instance = -1, primitive = -1;
    SurfacePoint point;
    Reflection reflection;
    Eigen::Vector3f v;  // to the viewer, unit
    float n_dot_v = 0.0f, cosine = 0.0f, depth = 0.0f;
    std::uint32_t normal = 0;  // of the face, packed
  } quad;
  std::size_t count = 0;
  for (std::size_t i = 0; i < kTilePixels; ++i) {
    const int x = tile.left + kTileOrder[i].x, y = tile.top + kTileOrder[i].y;
    if (x >= width || y >= height) continue;
    const std::size_t p = index(x, y);
    const std::size_t h = static_cast<std::size_t>(y / 2) * static_cast<std::size_t>(half_guide.width) + static_cast<std::size_t>(x / 2);
    const bool in_half = (x & 1) == 0 && (y & 1) == 0;
    const Hit& hit = tile.hits[i];
    visible[p] = 1.0f;
    if (!hit.valid()) {
      direct[p] = ambient[p] = Eigen::Vector3f::Zero();
      glows[p] = 1;
      emitted[p] = scene.background;
      guide.depth[p] = guide.tolerance[p] = 0.0f;
      guide.normal[p] = 0;
      if (in_half) {
        half_guide.depth[h] = half_guide.tolerance[h] = 0.0f;
        half_guide.normal[h] = 0;
      }
      continue;
    }
    const Ray& ray = tile.rays[i];
    const bool same_quad = quad.x == x / 2 && quad.y == y / 2 && quad.instance == hit.instance;
    // Neighbours on one triangle differ in texture alone.
    const bool same_face = same_quad && quad.primitive == hit.primitive;
    const SurfacePoint point = same_face ? surfaces.beside(quad.point, ray, hit, spread) : surfaces.at(ray, hit, spread);
    const Eigen::Vector3f v = same_face ? quad.v : Eigen::Vector3f(-ray.direction.normalized());
    const float n_dot_v = same_face ? quad.n_dot_v : std::max(point.normal.dot(v), 1e-3f);
    const Reflection reflection =
        same_face && point.base_colour == quad.point.base_colour ? quad.reflection : reflection_of(point, n_dot_v);
    // Light hardly changes within a quad of one smooth surface: its pixels share the lamps' irradiance, each with its own texture.
    const bool shared = same_quad && quad.reflection.roughness == reflection.roughness && quad.point.normal.dot(point.normal) > 0.9998f &&
                        std::abs(quad.depth - hit.distance) < 0.02f * hit.distance;
    if (!shared) lights.irradiate(point, reflection, v, parts);
    if (!shared || !same_face) {
      quad = {x / 2,
              y / 2,
              hit.instance,
              hit.primitive,
              point,
              reflection,
              v,
              n_dot_v,
              std::max(point.face_normal.dot(v), 0.05f),
              hit.distance,
              packed_normal(point.face_normal.x(), point.face_normal.y(), point.face_normal.z())};
    }
    direct[p] = parts.reflected_by(reflection);
    ambient[p] = scene.ambient.cwiseProduct(reflection.diffuse + reflection.glossy_albedo);
    glows[p] = point.emissive.isZero(0.0f) ? 0 : 1;
    if (glows[p]) emitted[p] = point.emissive;

    guide.depth[p] = hit.distance;
    guide.tolerance[p] = hit.distance * (1.5f * spread / quad.cosine + 0.001f);
    guide.normal[p] = quad.normal;
    if (in_half) {
      half_guide.depth[h] = guide.depth[p];
      half_guide.tolerance[h] = 2.0f * guide.tolerance[p];
      half_guide.normal[h] = guide.normal[p];
      half_positions[h] = lifted(point);
      half_normals[h] = point.face_normal;
      half_times[h] = ray.time;
    }
    if (!options.shadows || !(parts.total > 0.0f)) continue;
    // Every other pixel, as on a chessboard; the filter fills the rest.
    if (((x ^ y) & 1) != 0) {
      visible[p] = kUnknown;
      continue;
    }
    // Of each quad the first and the last pixel are left: two numbers a quad.
    const SpreadPoint sample = points.at(z_order(x, y) >> 2 << 1 | static_cast<std::uint32_t>(x & 1));
    const int light = DirectLight::choose(parts, sample.a);
    shadows[count] = {light, p, lights.shadow_ray(light, point, sample.b, sample.c)};
    shadows[count++].ray.time = ray.time;
  }
  if (count == 0) return;
  // Rays to one light travel together.
  std::array<std::uint8_t, kTilePixels> order;
  std::vector<std::uint8_t> place(lights.count() + 1, 0);
  for (std::size_t i = 0; i < count; ++i) ++place[static_cast<std::size_t>(shadows[i].light) + 1];
  for (std::size_t light = 1; light < place.size(); ++light) place[light] = static_cast<std::uint8_t>(place[light] + place[light - 1]);
  for (std::size_t i = 0; i < count; ++i) order[place[static_cast<std::size_t>(shadows[i].light)]++] = static_cast<std::uint8_t>(i);
  std::array<Ray, kTilePixels> rays_by_light;
  std::array<std::uint8_t, kTilePixels> blocked;
  for (std::size_t i = 0; i < count; ++i) rays_by_light[i] = shadows[order[i]].ray;
  ray_caster->occluded(std::span(rays_by_light.data(), count), std::span(blocked.data(), count), Coherence::kCoherent);
  for (std::size_t i = 0; i < count; ++i) {
    if (blocked[i]) visible[shadows[order[i]].pixel] = 0.0f;
  }
}

void Renderer::State::find_openness(std::uint32_t seed) {
  const int half_width = half_guide.width;
  openness.assign(half_guide.depth.size(), 1.0f);
  const SpreadPoints spread(seed);
  constexpr std::size_t kRowsAtOnce = 4;
  parallel_for(static_cast<std::size_t>(half_guide.height), kRowsAtOnce, [&](std::size_t begin, std::size_t end) {
    std::vector<Ray> tile_rays;
    std::vector<std::uint8_t> blocked;
    std::vector<std::size_t> pixels;
    for (int left = 0; left < half_width; left += kTileWidth) {
      tile_rays.clear();
      pixels.clear();
      for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
        for (int x = left; x < std::min(left + kTileWidth, half_width); ++x) {
          const std::size_t h = static_cast<std::size_t>(y) * static_cast<std::size_t>(half_width) + static_cast<std::size_t>(x);
          if (half_guide.depth[h] == 0.0f) continue;
          Eigen::Vector3f a, b;
          make_basis(half_normals[h], a, b);
          pixels.push_back(h);
          for (int k = 0; k < kOcclusionRays; ++k) {
            const SpreadPoint sample = spread.at(z_order(x, y) * kOcclusionRays + static_cast<std::uint32_t>(k));
            const float radius = std::sqrt(sample.a);
            const Eigen::Vector2f around = circle(sample.b);
            Ray ray;
            ray.origin = half_positions[h];
            ray.time = half_times[h];
            ray.direction =
                radius * around.x() * a + radius * around.y() * b + std::sqrt(std::max(0.0f, 1.0f - sample.a)) * half_normals[h];
            // A random reach makes blocking fade with distance at the price of one yes-or-no ray.
            ray.far = kOcclusionReach * sample.c;
            tile_rays.push_back(ray);
          }
        }
      }
      blocked.resize(tile_rays.size());
      ray_caster->occluded(tile_rays, blocked, Coherence::kIncoherent);
      for (std::size_t i = 0; i < pixels.size(); ++i) {
        int hit = 0;
        for (std::size_t k = 0; k < kOcclusionRays; ++k) hit += blocked[i * kOcclusionRays + k];
        openness[pixels[i]] = 1.0f - static_cast<float>(hit) / kOcclusionRays;
      }
    }
  });
  smooth(half_guide, kOcclusionRadius, openness, scratch);
}

void Renderer::State::compose(FrameImages& images) const {
  const auto exposure = static_cast<float>(options.exposure);
  parallel_for(static_cast<std::size_t>(height), 8, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      const LightRow out(images, y);
      for (int x = 0; x < width; ++x) {
        const std::size_t p = index(x, y);
        const float open = options.occlusion && guide.depth[p] > 0.0f ? upsampled(guide, half_guide, openness, x, y) : 1.0f;
        Eigen::Vector3f radiance = visible[p] * direct[p] + open * ambient[p];
        if (glows[p]) radiance += emitted[p];
        out.set(x, exposure * radiance);
      }
    }
  });
}

void Renderer::State::trace_paths(const PixelRays& pixel_rays, std::uint32_t seed, FrameImages& images) const {
  const PathTracer tracer(*ray_caster, surfaces, lights, options.bounces);
  const auto exposure = static_cast<float>(options.exposure);
  parallel_for(static_cast<std::size_t>(height), 2, [&](std::size_t begin, std::size_t end) {
    LightParts parts;
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      const LightRow out(images, y);
      for (int x = 0; x < width; ++x) {
        PixelRandom random(seed, static_cast<std::uint32_t>(index(x, y)));
        Eigen::Vector3f sum = Eigen::Vector3f::Zero();
        for (int s = 0; s < options.samples; ++s) {
          const double dx = static_cast<double>(random.uniform()) - 0.5, dy = static_cast<double>(random.uniform()) - 0.5;
          // Each sample has a part of the exposure to itself.
          float moment = 0.5f;
          if (pixel_rays.lasts()) moment = (static_cast<float>(s) + random.uniform()) / static_cast<float>(options.samples);
          sum += tracer.radiance(pixel_rays.at(x + dx, y + dy, moment), pixel_rays.spread(), random, parts);
        }
        out.set(x, sum * (exposure / static_cast<float>(options.samples)));
      }
    }
  });
}

Renderer::Renderer(std::shared_ptr<const RayCaster> ray_caster, const RenderOptions& options) {
  if (options.quality != "fast" && options.quality != "path") {
    throw Error("quality '" + options.quality + "' is not known; expected fast or path");
  }
  state_ = std::make_unique<State>(std::move(ray_caster), options);
}

Renderer::~Renderer() = default;

const Surfaces& Renderer::surfaces() const { return state_->surfaces; }

const RayCaster& Renderer::ray_caster() const { return *state_->ray_caster; }
const RenderOptions& Renderer::options() const { return state_->options; }

FrameImages Renderer::render(const Intrinsics& intrinsics, const Pose& X_WC, const RenderRequest& request) {
  return render(PixelRays(intrinsics, X_WC, state_->ray_caster->time_of(request.stamp)), request);
}

FrameImages Renderer::render(const PixelRays& pixel_rays, const RenderRequest& request) {
  State& s = *state_;
  s.width = pixel_rays.width();
  s.height = pixel_rays.height();
  FrameImages images;
  const auto seed = [&request](const char* purpose) {
    return picture_seed(RandomStream(request.seed, request.sensor, purpose, request.stamp));
  };
  const bool by_paths = s.options.quality == "path", lit = request.colour || request.radiance;
  const std::uint32_t shadow_seed = seed("render.shadow");
  s.look(pixel_rays, request, lit && !by_paths ? &shadow_seed : nullptr, images);
  if (!lit) return images;
  if (request.colour) images.colour.create(s.height, s.width, CV_8UC3);
  if (request.radiance) images.radiance.create(s.height, s.width, CV_32FC4);
  if (by_paths) {
    s.trace_paths(pixel_rays, seed("render.path"), images);
    return images;
  }
  if (s.options.shadows) smooth(s.guide, kShadowRadius, s.visible, s.scratch);
  if (s.options.occlusion) s.find_openness(seed("render.occlusion"));
  s.compose(images);
  return images;
}

}  // namespace waretwin

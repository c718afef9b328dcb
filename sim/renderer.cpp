#include "sim/renderer.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"
#include "sensors/tone_curve.h"
#include "sim/ambient_occlusion.h"
#include "sim/direct_light.h"
#include "sim/guided_filter.h"
#include "sim/lit_picture.h"
#include "sim/path_tracer.h"
#include "sim/pixel_random.h"
#include "sim/pixel_tile.h"
#include "sim/spread_points.h"
#include "sim/tile_shader.h"

namespace waretwin {

namespace {

constexpr int kShadowRadius = 4;  // of the smoothing, in pixels
static_assert(2 * kShadowRadius == SpreadPoints::kTile, "what is averaged holds every point once");
constexpr int kPathsAtOnce = 64;

// Into whichever pictures were asked for.
struct LightRow {
  LightRow(FrameImages& images, int y)
      : colour(images.colour.empty() ? nullptr : images.colour.ptr<cv::Vec3b>(y)),
        radiance(images.radiance.empty() ? nullptr : images.radiance.ptr<cv::Vec4f>(y)) {}
  void set(int x, const Eigen::Vector4f& light) const {
    if (colour != nullptr) colour[x] = {tone_mapped(light.z()), tone_mapped(light.y()), tone_mapped(light.x())};
    if (radiance != nullptr) radiance[x] = {light.x(), light.y(), light.z(), 0.0f};
  }
  cv::Vec3b* colour;
  cv::Vec4f* radiance;
};

// The s-th of a pixel's samples: anywhere in the pixel and, since each has a part of the exposure to itself, at its time.
LightPath first_piece(const PixelRays& pixel_rays, int x, int y, int s, int samples, std::uint32_t seed) {
  const std::uint64_t pixel =
      static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(pixel_rays.width()) + static_cast<std::uint64_t>(x);
  const std::uint64_t path = pixel * static_cast<std::uint64_t>(samples) + static_cast<std::uint64_t>(s);
  // Many samples of a large picture are more than 32 bits tell apart.
  PixelRandom random(seed + 0x9e3779b9u * static_cast<std::uint32_t>(path >> 32), static_cast<std::uint32_t>(path));
  const double dx = static_cast<double>(random.uniform()) - 0.5, dy = static_cast<double>(random.uniform()) - 0.5;
  float moment = 0.5f;
  if (pixel_rays.lasts()) moment = (static_cast<float>(s) + random.uniform()) / static_cast<float>(samples);
  return {pixel_rays.at(x + dx, y + dy, moment), random};
}

}  // namespace

struct Renderer::State {
  State(std::shared_ptr<const RayCaster> caster, const RenderOptions& render_options);

  std::shared_ptr<const RayCaster> ray_caster;
  RenderOptions options;
  Surfaces surfaces;
  DirectLight lights;
  std::vector<std::uint16_t> object_of_instance, class_of_instance;

  LitPicture lit;  // the picture being made, quality fast
  std::vector<float> openness, scratch;

  void look(const PixelRays& pixel_rays, const RenderRequest& request, const std::uint32_t* shadow_seed, FrameImages& images);
  void write_geometry(const PixelTile& tile, const PixelRays& pixel_rays, const RenderRequest& request, FrameImages& images) const;
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

// Geometry and, with a seed for the shadow rays, light before shadows are smoothed. A tile's hits are used while they are in the cache.
void Renderer::State::look(const PixelRays& pixel_rays, const RenderRequest& request, const std::uint32_t* shadow_seed,
                           FrameImages& images) {
  const int width = pixel_rays.width(), height = pixel_rays.height();
  if (shadow_seed != nullptr) lit.resize(width, height);
  images.depth.create(height, width, CV_32FC1);
  images.instances.create(height, width, CV_16UC1);
  if (request.classes) images.classes.create(height, width, CV_16UC1);
  if (request.normals) images.normals.create(height, width, CV_32FC3);
  constexpr int kTileHeight = PixelTile::kHeight;
  const std::size_t tile_rows = static_cast<std::size_t>((height + kTileHeight - 1) / kTileHeight);
  parallel_for(tile_rows, 1, [&](std::size_t begin, std::size_t end) {
    PixelTile tile;
    std::optional<TileShader> shader;
    if (shadow_seed != nullptr) shader.emplace(*ray_caster, surfaces, lights, options.shadows, pixel_rays.spread(), *shadow_seed, lit);
    for (tile.top = static_cast<int>(begin) * kTileHeight; tile.top < static_cast<int>(end) * kTileHeight; tile.top += kTileHeight) {
      for (tile.left = 0; tile.left < width; tile.left += PixelTile::kWidth) {
        for (std::size_t i = 0; i < PixelTile::kPixels; ++i) {
          tile.rays[i] = pixel_rays.at(tile.left + PixelTile::kOrder[i].x, tile.top + PixelTile::kOrder[i].y);
        }
        ray_caster->cast(tile.rays, tile.hits, Coherence::kCoherent);
        write_geometry(tile, pixel_rays, request, images);
        if (shader) shader->shade(tile);
      }
    }
  });
}

void Renderer::State::write_geometry(const PixelTile& tile, const PixelRays& pixel_rays, const RenderRequest& request,
                                     FrameImages& images) const {
  for (std::size_t i = 0; i < PixelTile::kPixels; ++i) {
    const int x = tile.left + PixelTile::kOrder[i].x, y = tile.top + PixelTile::kOrder[i].y;
    if (x >= pixel_rays.width() || y >= pixel_rays.height()) continue;
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

void Renderer::State::compose(FrameImages& images) const {
  const auto exposure = static_cast<float>(options.exposure);
  parallel_for(static_cast<std::size_t>(lit.height), 8, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      const LightRow out(images, y);
      for (int x = 0; x < lit.width; ++x) {
        const std::size_t p = lit.index(x, y);
        const float open = options.occlusion && lit.guide.depth[p] > 0.0f ? upsampled(lit.guide, lit.half_guide, openness, x, y) : 1.0f;
        Eigen::Vector4f radiance = lit.visible[p] * lit.direct[p] + open * lit.ambient[p];
        if (lit.glows[p]) radiance.head<3>() += lit.emitted[p];
        out.set(x, exposure * radiance);
      }
    }
  });
}

void Renderer::State::trace_paths(const PixelRays& pixel_rays, std::uint32_t seed, FrameImages& images) const {
  const auto exposure = static_cast<float>(options.exposure);
  const int width = pixel_rays.width(), samples = options.samples;
  // Paths of as many neighbouring pixels as fill some packets.
  const int at_once = std::clamp(kPathsAtOnce / samples, 1, width);
  parallel_for(static_cast<std::size_t>(pixel_rays.height()), 2, [&](std::size_t begin, std::size_t end) {
    PathTracer tracer(*ray_caster, surfaces, lights, options.bounces, pixel_rays.spread());
    std::vector<LightPath> paths;
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      const LightRow out(images, y);
      for (int first = 0; first < width; first += at_once) {
        const int last = std::min(first + at_once, width);
        paths.clear();
        for (int s = 0; s < samples; ++s) {
          for (int x = first; x < last; ++x) paths.push_back(first_piece(pixel_rays, x, y, s, samples, seed));
        }
        tracer.trace(paths);
        for (int x = first; x < last; ++x) {
          Eigen::Vector3f sum = Eigen::Vector3f::Zero();
          for (std::size_t i = static_cast<std::size_t>(x - first); i < paths.size(); i += static_cast<std::size_t>(last - first)) {
            sum += paths[i].radiance;
          }
          sum *= exposure / static_cast<float>(samples);
          out.set(x, {sum.x(), sum.y(), sum.z(), 0.0f});
        }
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
  const cv::Size size(pixel_rays.width(), pixel_rays.height());
  FrameImages images;
  const auto seed = [&request](const char* purpose) {
    return picture_seed(RandomStream(request.seed, request.sensor, purpose, request.stamp));
  };
  const bool by_paths = s.options.quality == "path", lit = request.colour || request.radiance;
  const std::uint32_t shadow_seed = seed("render.shadow");
  s.look(pixel_rays, request, lit && !by_paths ? &shadow_seed : nullptr, images);
  if (!lit) return images;
  if (request.colour) images.colour.create(size, CV_8UC3);
  if (request.radiance) images.radiance.create(size, CV_32FC4);
  if (by_paths) {
    s.trace_paths(pixel_rays, seed("render.path"), images);
    return images;
  }
  if (s.options.shadows) smooth(s.lit.guide, kShadowRadius, s.lit.visible, s.scratch);
  if (s.options.occlusion) find_openness(*s.ray_caster, s.lit, seed("render.occlusion"), s.openness, s.scratch);
  s.compose(images);
  return images;
}

}  // namespace waretwin

#include "sim/ambient_occlusion.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "sim/direct_light.h"
#include "sim/spread_points.h"

namespace waretwin {

namespace {

constexpr float kReach = 1.6f;  // metres: what is nearer blocks light, less so the farther it is
constexpr int kRadius = 4;      // of the smoothing, in pixels of the half-size picture
static_assert(2 * kRadius == SpreadPoints::kTile, "what is averaged holds every point once");
constexpr int kRowsAtOnce = 4, kColumnsAtOnce = 16;

}  // namespace

void find_openness(const RayCaster& ray_caster, const LitPicture& picture, std::uint32_t seed, std::vector<float>& openness,
                   std::vector<float>& scratch) {
  const SurfaceGuide& guide = picture.half_guide;
  openness.assign(guide.depth.size(), 1.0f);
  const SpreadPoints points(seed);
  parallel_for(static_cast<std::size_t>(guide.height), kRowsAtOnce, [&](std::size_t begin, std::size_t end) {
    std::vector<Ray> rays;
    std::vector<std::uint8_t> blocked;
    std::vector<std::size_t> pixels;
    for (int left = 0; left < guide.width; left += kColumnsAtOnce) {
      rays.clear();
      pixels.clear();
      for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
        for (int x = left; x < std::min(left + kColumnsAtOnce, guide.width); ++x) {
          const std::size_t h = static_cast<std::size_t>(y) * static_cast<std::size_t>(guide.width) + static_cast<std::size_t>(x);
          if (guide.depth[h] == 0.0f) continue;
          if (!SpreadPoints::looks_from(x, y)) {
            openness[h] = kUnknown;
            continue;
          }
          const Eigen::Vector3f& normal = picture.half_normals[h];
          Eigen::Vector3f a, b;
          make_basis(normal, a, b);
          const SpreadPoint sample = points.at(x, y);
          const float radius = std::sqrt(sample.a);
          const Eigen::Vector2f around = circle(sample.b);
          pixels.push_back(h);
          Ray& ray = rays.emplace_back();
          ray.origin = picture.half_positions[h];
          ray.time = picture.half_times[h];
          ray.direction = radius * around.x() * a + radius * around.y() * b + std::sqrt(std::max(0.0f, 1.0f - sample.a)) * normal;
          // A random reach makes blocking fade with distance at the price of one yes-or-no ray.
          ray.far = kReach * sample.c;
        }
      }
      blocked.resize(rays.size());
      ray_caster.occluded(rays, blocked, Coherence::kIncoherent);
      for (std::size_t i = 0; i < pixels.size(); ++i) openness[pixels[i]] = blocked[i] ? 0.0f : 1.0f;
    }
  });
  smooth(guide, kRadius, openness, scratch);
}

}  // namespace waretwin

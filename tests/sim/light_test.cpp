// Light against closed forms: inverse squares, shadow edges, energy.
#include <gtest/gtest.h>

#include <cmath>

#include "sensors/tone_curve.h"
#include "sim/direct_light.h"
#include "sim/path_tracer.h"
#include "sim/renderer.h"
#include "sim/surfaces.h"
#include "tests/sim/fixtures.h"

namespace waretwin {
namespace {

using fixtures::add_instance;
using fixtures::add_material;
using fixtures::add_mesh;
using fixtures::placed;

SurfacePoint floor_at(float x, float y) {
  SurfacePoint point;
  point.position = {x, y, 0};
  point.face_normal = point.normal = Eigen::Vector3f::UnitZ();
  point.base_colour = {0.6f, 0.5f, 0.4f};
  point.emissive.setZero();
  return point;
}

Eigen::Vector3f unshadowed(const DirectLight& direct, const SurfacePoint& point, const Reflection& reflection, LightParts& parts) {
  direct.irradiate(point, reflection, Eigen::Vector3f::UnitZ(), parts);
  return parts.reflected_by(reflection);
}

// A purely diffuse surface of the given albedo.
Reflection lambert(const Eigen::Vector3f& albedo) { return {albedo, Eigen::Vector3f::Zero(), 1.0f, Eigen::Vector3f::Zero()}; }

TEST(DirectLight, InverseSquareAndCosineOfAPointLight) {
  const std::vector<Light> lights = {fixtures::point_light({1, 0, 3}, 50), fixtures::point_light({-2, 4, 2}, 20)};
  const DirectLight direct(lights);
  LightParts parts;
  for (const float x : {0.0f, 1.0f, 2.5f, 6.0f}) {
    const Eigen::Vector3f sum = unshadowed(direct, floor_at(x, 0), lambert({0.5f, 0.5f, 0.5f}), parts);
    const auto irradiance = [x](double lx, double ly, double lz, double candela) {
      const double d2 = (x - lx) * (x - lx) + ly * ly + lz * lz;
      return candela / d2 * lz / std::sqrt(d2);
    };
    const double expected = 0.5 / std::numbers::pi * (irradiance(1, 0, 3, 50) + irradiance(-2, 4, 2, 20));
    EXPECT_NEAR(sum.x(), expected, 1e-5 * expected);
    const Eigen::Vector3f first = direct.radiance(0, lambert({0.5f, 0.5f, 0.5f}), parts);
    EXPECT_NEAR(first.y(), 0.5 / std::numbers::pi * irradiance(1, 0, 3, 50), 1e-5 * expected);
    // Chosen in proportion.
    EXPECT_EQ(DirectLight::choose(parts, 0.999f * first.y() / sum.y()), 0);
    EXPECT_EQ(DirectLight::choose(parts, 1.001f * first.y() / sum.y()), 1);
  }
}

TEST(DirectLight, DirectionalAndSpotAndRange) {
  Light sun;
  sun.kind = Light::Kind::kDirectional;
  sun.direction = Eigen::Vector3f(1, 0, -1).normalized();
  sun.intensity = {2, 2, 2};
  LightParts parts;
  const Eigen::Vector3f albedo(1, 1, 1);
  const std::vector<Light> suns = {sun};
  EXPECT_NEAR(unshadowed(DirectLight(suns), floor_at(3, 1), lambert(albedo), parts).x(), 2 * std::sqrt(0.5) / std::numbers::pi, 1e-6);

  Light spot = fixtures::point_light({0, 0, 2}, 8);
  spot.kind = Light::Kind::kSpot;
  spot.inner_cone = 0.2f;
  spot.outer_cone = 0.4f;
  const std::vector<Light> spots = {spot};
  EXPECT_NEAR(unshadowed(DirectLight(spots), floor_at(0, 0), lambert(albedo), parts).x(), 2 / std::numbers::pi, 1e-5);
  EXPECT_EQ(unshadowed(DirectLight(spots), floor_at(2 * std::tan(0.41f), 0), lambert(albedo), parts).x(), 0.0f);
  EXPECT_GT(unshadowed(DirectLight(spots), floor_at(2 * std::tan(0.39f), 0), lambert(albedo), parts).x(), 0.0f);

  Light near = fixtures::point_light({0, 0, 2}, 8);
  near.range = 2.0f;
  const std::vector<Light> ranges = {near};
  EXPECT_EQ(unshadowed(DirectLight(ranges), floor_at(0, 0), lambert(albedo), parts).x(), 0.0f);
}

// A light 4 m above the floor over a square plate of 1 m at half its height casts a shadow of 2 m.
TEST(Renderer, ShadowEdgeOfAPointLight) {
  for (const char* quality : {"fast", "path"}) {
    Scene scene;
    const int grey = add_material(scene, {0.5f, 0.5f, 0.5f});
    Mesh floor;
    fixtures::add_quad(floor, {-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0});
    add_instance(scene, add_mesh(scene, floor, grey));
    Mesh plate;
    fixtures::add_quad(plate, {-0.5f, -0.5f, 2}, {0.5f, -0.5f, 2}, {0.5f, 0.5f, 2}, {-0.5f, 0.5f, 2});
    add_instance(scene, add_mesh(scene, plate, grey));
    scene.lights.push_back(fixtures::point_light({0, 0, 4}, 30));
    RenderOptions options;
    options.quality = quality;
    options.bounces = 0;
    options.samples = 1;
    // From under the plate, straight down and 1.9 m high, nothing hides the floor.
    Pose X_WC = Pose::Identity();
    X_WC.linear() = Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX()).toRotationMatrix();
    X_WC.translation() = Eigen::Vector3d(0, 0, 1.9);
    const Intrinsics k = Intrinsics::from_field_of_view(400, 400, to_radians(90), to_radians(90));
    Renderer renderer(std::make_shared<const RayCaster>(std::make_shared<const Scene>(std::move(scene))), options);
    const FrameImages images = renderer.render(k, X_WC, {});
    for (int v = 0; v < 400; ++v) {
      for (int u = 0; u < 400; ++u) {
        const Eigen::Vector3d p = X_WC * (1.9 * k.ray(u, v));
        const double from_edge = std::max(std::abs(p.x()), std::abs(p.y())) - 1.0;
        if (std::abs(from_edge) < 0.055) continue;  // more than the filter reaches
        ASSERT_EQ(images.colour.at<cv::Vec3b>(v, u)[0] > 20, from_edge > 0) << quality << " at " << p.transpose();
      }
    }
  }
}

TEST(Renderer, SoftShadowIsAsWideAsTheEmitterMakesIt) {
  // A straight edge at half height: the penumbra is as wide as the emitter. Brightness is monotonic through it.
  Scene scene;
  const int grey = add_material(scene, {0.5f, 0.5f, 0.5f});
  Mesh floor;
  fixtures::add_quad(floor, {-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0});
  add_instance(scene, add_mesh(scene, floor, grey));
  Mesh plate;
  fixtures::add_quad(plate, {-5, -5, 2}, {0, -5, 2}, {0, 5, 2}, {-5, 5, 2});
  add_instance(scene, add_mesh(scene, plate, grey));
  scene.lights.push_back(fixtures::point_light({0, 0, 4}, 30, 0.5f));
  const auto caster = std::make_shared<const RayCaster>(std::make_shared<const Scene>(scene));
  const DirectLight direct(caster->scene().lights);
  const auto visible = [&](float x) {
    int count = 0;
    for (int i = 0; i < 40; ++i) {
      for (int j = 0; j < 40; ++j) {
        count += caster->occluded(
                     direct.shadow_ray(0, lifted(floor_at(x, 0)), (static_cast<float>(i) + 0.5f) / 40, (static_cast<float>(j) + 0.5f) / 40))
                     ? 0
                     : 1;
      }
    }
    return count / 1600.0;
  };
  // The plate's edge halves the way, so seen from x on the floor it cuts the disc at -x: a circular segment remains.
  for (const float x : {-0.55f, -0.4f, -0.2f, 0.0f, 0.2f, 0.4f, 0.55f}) {
    const double cut = std::clamp(-x / 0.5, -1.0, 1.0);
    const double expected = (std::acos(cut) - cut * std::sqrt(1 - cut * cut)) / std::numbers::pi;
    EXPECT_NEAR(visible(x), expected, 0.03) << x;
  }
}

double mean_radiance(const Scene& scene, int samples, int bounces) {
  const auto caster = std::make_shared<const RayCaster>(std::make_shared<const Scene>(scene));
  const Surfaces surfaces(caster);
  const DirectLight direct(caster->scene().lights);
  PathTracer tracer(*caster, surfaces, direct, bounces, 1e-3f);
  std::vector<LightPath> paths;
  for (int i = 0; i < samples; ++i) {
    Ray ray;
    ray.origin = {0.2f, 0.1f, 1.3f};
    ray.direction = Eigen::Vector3f(std::sin(0.7f * static_cast<float>(i)), std::cos(0.7f * static_cast<float>(i)),
                                    std::sin(0.31f * static_cast<float>(i)))
                        .normalized();
    paths.push_back({ray, PixelRandom(11, static_cast<std::uint32_t>(i))});
  }
  tracer.trace(paths);
  double sum = 0.0;
  for (const LightPath& path : paths) sum += static_cast<double>(path.radiance.mean());
  return sum / samples;
}

TEST(PathTracer, ClosedFurnaceRoomStaysAtOne) {
  // Every wall emits one half and reflects one half: radiance is 1 everywhere. Of a rough surface's reflectance 0.0157 is the glossy
  // layer's (its fit at roughness 1), the rest the base colour's.
  const float glossy = 0.04f * 0.4524f - 0.0024f;
  const float base = (0.5f - glossy) / (1.0f - glossy);
  Scene scene = fixtures::room(-2, 3, -2, 2, 2.5f, {base, base, base});
  scene.materials[0].emissive = {0.5f, 0.5f, 0.5f};
  EXPECT_NEAR(mean_radiance(scene, 20000, 100), 1.0, 0.02);
}

// A closed room whose walls emit and reflect so much that radiance is 1 everywhere, seen by a camera in quality path: the mean of every
// block of 8 x 8 pixels.
void expect_furnace(Scene scene, int bounces, const std::string& what) {
  scene.ambient = scene.background = {0, 0, 0};
  RenderOptions options;
  options.quality = "path";
  options.bounces = bounces;
  options.samples = 200;
  Renderer renderer(fixtures::caster_of(std::move(scene)), options);
  RenderRequest request;
  request.colour = false;
  request.radiance = true;
  Pose X_WC = Pose::Identity();
  X_WC.linear() = rotation_from_rpy(0.0, 0.3, 0.2) * optical_from_forward();
  X_WC.translation() = Eigen::Vector3d(-1.5, 0.2, 1.6);
  const cv::Mat radiance = renderer.render(Intrinsics::from_field_of_view(40, 24, to_radians(90), to_radians(59)), X_WC, request).radiance;
  for (int top = 0; top < 24; top += 8) {
    for (int left = 0; left < 40; left += 8) {
      cv::Vec4d sum(0, 0, 0, 0);
      for (int v = top; v < top + 8; ++v) {
        for (int u = left; u < left + 8; ++u) sum += cv::Vec4d(radiance.at<cv::Vec4f>(v, u));
      }
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c] / 64.0, 1.0, 0.02) << what << ", block at " << left << " " << top << ", colour " << c;
    }
  }
}

// Walls of roughness 1 whose albedo, both layers together, is rho: the glossy one's does not depend on the direction there.
Scene furnace(float rho) {
  const float glossy = 0.04f * 0.4524f - 0.0024f;
  const float base = (rho - glossy) / (1.0f - glossy);
  Scene scene = fixtures::room(-2, 3, -2, 2, 2.5f, {base, base, base});
  scene.materials[0].emissive = Eigen::Vector3f::Constant(1.0f - rho);
  return scene;
}

TEST(PathTracer, EveryPartOfAFurnaceRoomStaysAtOne) {
  // With few bounces the series 1 + rho + rho^2 ... ends early: at rho = 0.4 it lacks rho^5 = 1 % after the default of four.
  expect_furnace(furnace(0.4f), RenderOptions().bounces, "four bounces");
  expect_furnace(furnace(0.5f), 100, "rho 0.5");
  expect_furnace(furnace(0.8f), 400, "rho 0.8");
}

TEST(PathTracer, WhiteGlossyThingsVanishInAFurnaceRoom) {
  for (const float roughness : {0.1f, 0.4f, 1.0f}) {
    Scene scene = furnace(0.5f);
    const int white = add_material(scene, {1, 1, 1}, roughness);
    add_instance(scene, add_mesh(scene, fixtures::unit_sphere(24), white), placed({0.5f, 0.3f, 1}, {0.6f, 0.6f, 0.6f}));
    add_instance(scene, add_mesh(scene, fixtures::unit_box(), white), placed({-0.5f, -1.5f, 0.1f}, {0.7f, 0.8f, 0.9f}, 0.4f));
    expect_furnace(std::move(scene), 400, "roughness " + std::to_string(roughness));
  }
}

TEST(PathTracer, WhiteThingsVanishInUniformLight) {
  // A white sphere, box and floor under a sky of 1 return all they receive, at any roughness.
  for (const float roughness : {0.1f, 0.5f, 1.0f}) {
    Scene scene;
    const int white = add_material(scene, {1, 1, 1}, roughness);
    add_instance(scene, add_mesh(scene, fixtures::unit_sphere(24), white), placed({2, 0, 1}, {0.7f, 0.7f, 0.7f}));
    add_instance(scene, add_mesh(scene, fixtures::unit_box(), white), placed({-2, -2, 0}, {1, 4, 1}));
    scene.ambient = scene.background = {1, 1, 1};
    EXPECT_NEAR(mean_radiance(scene, 20000, 200), 1.0, 0.02) << roughness;
  }
}

TEST(ToneCurve, MonotonicFromBlackToWhite) {
  EXPECT_EQ(tone_mapped(0.0f), 0);
  EXPECT_EQ(tone_mapped(-1.0f), 0);
  EXPECT_EQ(tone_mapped(std::nanf("")), 0);
  EXPECT_EQ(tone_mapped(1e9f), 255);
  int before = 0;
  for (int i = 0; i < 4000; ++i) {
    const int now = tone_mapped(static_cast<float>(i) * 0.004f);
    EXPECT_GE(now, before);
    before = now;
  }
  // Middle grey: the fit gives 0.1284 for 0.18, sRGB 101.
  const double x = 0.6 * 0.18, y = x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
  EXPECT_NEAR(tone_mapped(0.18f), 255 * (1.055 * std::pow(y, 1 / 2.4) - 0.055), 1.0);
}

}  // namespace
}  // namespace waretwin

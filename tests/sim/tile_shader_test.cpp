// Quality fast, which shades four or eight pixels at once, beside light that is found for each pixel on its own.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/direct_light.h"
#include "sim/renderer.h"
#include "sim/surfaces.h"
#include "tests/sim/fixtures.h"

namespace waretwin {
namespace {

Texture stripes() {
  Texture texture;
  texture.width = texture.height = 32;
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) {
      for (const int value : {40 + 6 * x, 230 - 5 * y, 90 + 40 * (x / 8 % 2), 255}) {
        texture.rgba.push_back(static_cast<std::uint8_t>(value));
      }
    }
  }
  return texture;
}

// A textured floor whose texture is turned and repeated, with vertex colours; a metal and a half-metal wall, a smooth ball, a glowing
// plate.
Scene many_materials() {
  Scene scene = fixtures::room(-2, 3, -2, 2, 2.5f, {0.6f, 0.5f, 0.4f});
  scene.textures.push_back(stripes());
  Mesh floor;
  fixtures::add_quad(floor, {-2, -2, 0.01f}, {3, -2, 0.01f}, {3, 2, 0.01f}, {-2, 2, 0.01f});
  for (const Eigen::Vector3f& p : floor.positions) floor.colours.emplace_back(0.5f + 0.1f * p.x(), 0.8f, 0.7f + 0.1f * p.y(), 1.0f);
  const int painted = fixtures::add_material(scene, {0.9f, 0.8f, 0.7f}, 0.6f);
  scene.materials.back().base_colour_texture.texture = 0;
  scene.materials.back().base_colour_texture.uv_transform << 2.0f, 1.0f, 0.3f, -1.0f, 3.0f, 0.6f;
  fixtures::add_instance(scene, fixtures::add_mesh(scene, floor, painted));
  for (const float metallic : {1.0f, 0.5f}) {
    Mesh panel;
    const float y = metallic == 1.0f ? -1.0f : 0.6f;
    fixtures::add_quad(panel, {2.5f, y, 0.2f}, {2.5f, y, 1.6f}, {2.5f, y + 0.8f, 1.6f}, {2.5f, y + 0.8f, 0.2f});
    const int material = fixtures::add_material(scene, {0.9f, 0.7f, 0.5f}, 0.4f, metallic);
    scene.materials.back().base_colour_texture.texture = 0;
    fixtures::add_instance(scene, fixtures::add_mesh(scene, panel, material));
  }
  const int ball = fixtures::add_material(scene, {0.2f, 0.3f, 0.8f}, 0.5f);
  fixtures::add_instance(scene, fixtures::add_mesh(scene, fixtures::unit_sphere(24), ball),
                         fixtures::placed({1.2f, -0.2f, 0.5f}, {0.4f, 0.4f, 0.4f}));
  Mesh plate;
  fixtures::add_quad(plate, {1.0f, 1.0f, 0.05f}, {1.4f, 1.0f, 0.05f}, {1.4f, 1.4f, 0.05f}, {1.0f, 1.4f, 0.05f});
  const int glowing = fixtures::add_material(scene, {0.1f, 0.1f, 0.1f});
  scene.materials.back().emissive = {0.3f, 0.6f, 0.2f};
  fixtures::add_instance(scene, fixtures::add_mesh(scene, plate, glowing));
  scene.ambient = {0.2f, 0.25f, 0.3f};
  scene.lights = {fixtures::point_light({0.5f, 0.4f, 2.2f}, 6.0f), fixtures::point_light({2.0f, -1.0f, 2.0f}, 4.0f)};
  return scene;
}

Eigen::Vector3f light_towards(const RayCaster& caster, const Surfaces& surfaces, const DirectLight& lights, const Ray& ray, float spread) {
  const Hit hit = caster.cast(ray);
  if (!hit.valid()) return caster.scene().background;
  const SurfacePoint point = surfaces.at(ray, hit, spread);
  const Eigen::Vector3f v = -ray.direction.normalized();
  const Reflection reflection = reflection_of(point, std::max(point.normal.dot(v), 1e-3f));
  LightParts parts;
  lights.irradiate(point, reflection, v, parts);
  return parts.reflected_by(reflection) + caster.scene().ambient.cwiseProduct(reflection.diffuse + reflection.glossy_albedo) +
         point.emissive;
}

TEST(TileShader, NeighboursLookLikeTheirPixelsOneByOne) {
  const auto caster = fixtures::caster_of(many_materials());
  RenderOptions options;
  options.shadows = options.occlusion = false;
  options.exposure = 1.0;
  Renderer renderer(caster, options);
  RenderRequest request;
  request.colour = false;
  request.radiance = true;
  const Pose X_WC = fixtures::looking({-1.7, -0.1, 1.6}, 0.1, 0.4);
  // Odd sizes: the last column and row have no whole quads.
  const Intrinsics k = Intrinsics::from_field_of_view(641, 359, to_radians(90), to_radians(59));
  const cv::Mat radiance = renderer.render(k, X_WC, request).radiance;

  const DirectLight lights(caster->scene().lights);
  const PixelRays rays(k, X_WC);
  double sum = 0.0, largest = 0.0;
  int far_off = 0;
  for (int v = 0; v < k.height; ++v) {
    for (int u = 0; u < k.width; ++u) {
      const Eigen::Vector3f expected = light_towards(*caster, renderer.surfaces(), lights, rays.at(u, v), rays.spread());
      const cv::Vec4f& got = radiance.at<cv::Vec4f>(v, u);
      const double off = (Eigen::Vector3f(got[0], got[1], got[2]) - expected).norm() / (0.05 + expected.norm());
      sum += off;
      largest = std::max(largest, off);
      far_off += off > 0.03;
    }
  }
  const double pixels = static_cast<double>(k.width) * k.height;
  EXPECT_LT(sum / pixels, 0.004);
  EXPECT_LT(far_off / pixels, 0.004);  // highlights
  EXPECT_LT(largest, 0.25);
}

TEST(Surfaces, FaceColoursAreThoseOfSinglePoints) {
  const auto caster = fixtures::caster_of(many_materials());
  const Surfaces surfaces(caster);
  Ray ray;
  ray.origin = {0.0f, 0.0f, 1.5f};
  const auto towards = [&](float x, float y) {
    ray.direction = Eigen::Vector3f(x, y, 0.01f) - ray.origin;
    return caster->cast(ray);
  };
  const Hit first = towards(0.5f, -0.7f);
  ASSERT_TRUE(surfaces.only_colour_varies(first));
  const FaceColours colours = surfaces.face_colours(ray, first, surfaces.at(ray, first, 1e-3f), 1e-3f);
  EXPECT_FALSE(colours.is_constant());
  for (int i = 0; i < 50; ++i) {
    const Hit hit = towards(0.5f + 0.004f * static_cast<float>(i % 7), -0.7f + 0.003f * static_cast<float>(i % 11));
    ASSERT_EQ(hit.primitive, first.primitive);
    const Eigen::Vector3f expected = surfaces.at(ray, hit, 1e-3f).base_colour;
    EXPECT_LT((colours.at(hit).head<3>() - expected).norm(), 1e-4f);
  }
}

}  // namespace
}  // namespace waretwin

// The surface score against meshes whose errors are known.
#include "harness/score/surface_score.h"

#include <gtest/gtest.h>

#include "core/random.h"
#include "sim/surface_distance.h"
#include "tests/sim/fixtures.h"

namespace waretwin {
namespace {

// The least over many points of the triangle, from above within half a step.
double sampled_distance(const Eigen::Vector3f& p, const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c) {
  constexpr int kSteps = 150;
  double nearest = 1e9;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; i + j <= kSteps; ++j) {
      const Eigen::Vector3f q = a + (b - a) * (static_cast<float>(i) / kSteps) + (c - a) * (static_cast<float>(j) / kSteps);
      nearest = std::min(nearest, static_cast<double>((p - q).norm()));
    }
  }
  return nearest;
}

TEST(SurfaceDistance, IsThatToTheNearestPointOfAnyTriangle) {
  const RandomStream random(3, "triangles", "test");
  const auto point = [&](std::uint64_t i) {
    return Eigen::Vector3f(static_cast<float>(random.uniform(3 * i)), static_cast<float>(random.uniform(3 * i + 1)),
                           static_cast<float>(random.uniform(3 * i + 2)));
  };
  TriangleSoup soup;
  for (std::uint32_t i = 0; i < 12; ++i) {
    for (std::uint64_t k = 0; k < 3; ++k) soup.vertices.push_back(point(3 * i + k));
    soup.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const TriangleSoup all = soup;
  const SurfaceDistance surface(std::move(soup));
  for (std::uint64_t i = 0; i < 60; ++i) {
    const Eigen::Vector3f p = 2.0f * point(1000 + i) - Eigen::Vector3f::Constant(0.5f);
    double expected = 1e9;
    for (const auto& t : all.triangles) {
      const double d = sampled_distance(p, all.vertices[t[0]], all.vertices[t[1]], all.vertices[t[2]]);
      expected = std::min(expected, d);
      EXPECT_NEAR(distance_to_triangle(p, all.vertices[t[0]], all.vertices[t[1]], all.vertices[t[2]]), d, 0.01);
    }
    EXPECT_NEAR(surface.to(p, 10.0f), expected, 0.01);
    EXPECT_LE(surface.to(p, 0.05f), 0.05f);
  }
}

// A floor of 4 x 4 m with a box on it.
struct Hall {
  std::shared_ptr<RayCaster> caster;
  int box = 0;
};

Hall make_hall() {
  Scene scene;
  const int material = fixtures::add_material(scene, {0.5f, 0.5f, 0.5f});
  Mesh floor;
  fixtures::add_quad(floor, {-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0});
  fixtures::add_instance(scene, fixtures::add_mesh(scene, floor, material));
  const int box = fixtures::add_instance(scene, fixtures::add_mesh(scene, fixtures::unit_box(), material),
                                         fixtures::placed({0.5f, -0.2f, 0}, {0.4f, 0.4f, 0.4f}));
  return {std::make_shared<RayCaster>(std::make_shared<const Scene>(scene), RayCasterOptions{.isa = "sse4.2"}), box};
}

// A grid of vertices every 2 cm, shifted up.
SurfaceMesh floor_mesh(float from_x, float to_x, float z) {
  SurfaceMesh mesh;
  const int columns = static_cast<int>(std::lround((to_x - from_x) / 0.02f)) + 1, rows = 201;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      mesh.vertices.emplace_back(from_x + 0.02f * static_cast<float>(i), -2.0f + 0.02f * static_cast<float>(j), z);
      if (i == 0 || j == 0) continue;
      const auto v = static_cast<std::uint32_t>(j * columns + i), w = static_cast<std::uint32_t>(columns);
      mesh.triangles.push_back({v - w - 1, v - w, v});
      mesh.triangles.push_back({v - w - 1, v, v - 1});
    }
  }
  return mesh;
}

CameraConfig down_camera() {
  CameraConfig camera = CameraConfig::make("ideal");
  camera.depth_min_m = 0.1;
  camera.depth_max_m = 6.0;
  return camera;
}

Pose from_above(double x) {
  Pose X_WC = Pose::Identity();
  X_WC.linear() << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  X_WC.translation() = Eigen::Vector3d(x, 0, 1.0);
  return X_WC;
}

TEST(SurfaceMeter, MeasuresHowFarVerticesAreAndWhatIsMissing) {
  const Hall hall = make_hall();
  SurfaceMeter meter(hall.caster);
  meter.add_frame(down_camera(), from_above(-0.9));  // sees x from -1.9 to 0.1: floor alone
  const SurfaceScore all = meter.result(floor_mesh(-2.0f, 2.0f, 0.004f));
  EXPECT_NEAR(all.median_m, 0.004, 1e-5);
  EXPECT_EQ(all.share_over_30mm, 0.0);
  EXPECT_EQ(all.found, 1.0);
  EXPECT_GT(all.seen_points, 3000);
  const SurfaceScore half = meter.result(floor_mesh(-2.0f, -0.93f, 0.0f));
  EXPECT_NEAR(half.median_m, 0.0, 1e-6);
  EXPECT_NEAR(half.found, 0.5, 0.03);
  SurfaceMesh ghosts = floor_mesh(-2.0f, 2.0f, 0.0f);
  const std::size_t real = ghosts.vertices.size();
  for (std::size_t i = 0; i < real / 3; ++i) ghosts.vertices.emplace_back(-1.0f, 0.0f, 0.05f);
  EXPECT_NEAR(meter.result(ghosts).share_over_30mm, 0.25, 1e-3);
  const SurfaceScore nothing = meter.result({});
  EXPECT_EQ(nothing.vertices, 0);
  EXPECT_EQ(nothing.found, 0.0);
}

TEST(SurfaceMeter, LooksAtTheHallAsItStandsInTheEnd) {
  const Hall hall = make_hall();
  SurfaceMeter meter(hall.caster);
  meter.add_frame(down_camera(), from_above(0.7));
  const SurfaceMesh floor = floor_mesh(-2.0f, 2.0f, 0.0f);
  const SurfaceScore before = meter.result(floor);
  EXPECT_LT(before.found, 0.95);  // the box's top is not in the mesh
  hall.caster->set_present(hall.box, false);
  hall.caster->commit();
  const SurfaceScore after = meter.result(floor);
  EXPECT_EQ(after.found, 1.0);
  EXPECT_LT(after.seen_points, before.seen_points);
}

}  // namespace
}  // namespace waretwin

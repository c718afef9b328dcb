// The mesh kit against closed forms: volumes by the divergence theorem say that shapes are closed and face outwards.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scenes/builder/finishes.h"
#include "scenes/builder/shape.h"

namespace waretwin::builder {
namespace {

constexpr double kPi = std::numbers::pi;

double volume(const Shape& s) {
  double six = 0;
  for (std::size_t t = 0; t < s.triangles.size(); t += 3) {
    six += s.positions[s.triangles[t]].dot(s.positions[s.triangles[t + 1]].cross(s.positions[s.triangles[t + 2]]));
  }
  return six / 6;
}

double area(const Shape& s) {
  double twice = 0;
  for (std::size_t t = 0; t < s.triangles.size(); t += 3) {
    const Vector3d a = s.positions[s.triangles[t]];
    twice += (s.positions[s.triangles[t + 1]] - a).cross(s.positions[s.triangles[t + 2]] - a).norm();
  }
  return twice / 2;
}

double polygon_share(int sides) { return sides / (2 * kPi) * std::sin(2 * kPi / sides); }  // area of an n-gon in its circle

TEST(Shape, BoxHasItsVolumeAnywhere) {
  EXPECT_NEAR(volume(box(2, 3, 4)), 24, 1e-12);
  EXPECT_NEAR(area(box(2, 3, 4)), 52, 1e-12);
  EXPECT_NEAR(volume(box(2, 3, 4).rotate({1, 2, 3}, 40).move(5, 6, 7)), 24, 1e-9);
}

TEST(Shape, BevelCutsEdgesAndCorners) {
  // Twelve edges lose prisms of b^2 / 2, eight corners lose the rest: exactly 24 - b^2 / 2 * sum of (edge - 2 b) - 8 * (5/6) b^3.
  const double b = 0.1;
  const double edges = 4 * ((2 - 2 * b) + (3 - 2 * b) + (4 - 2 * b));
  EXPECT_NEAR(volume(bevelled_box(2, 3, 4, b)), 24 - b * b / 2 * edges - 8 * 5.0 / 6.0 * b * b * b, 1e-12);
}

TEST(Shape, CylinderAndTurnedProfiles) {
  const Vector3d from(1, 2, 3), to(1.5, 2.5, 3.1);
  EXPECT_NEAR(volume(cylinder(from, to, 0.2, 24)), kPi * 0.04 * (to - from).norm() * polygon_share(24), 1e-9);
  // A cup: outside 0.3, inside 0.25, floor 0.05 thick.
  const Shape cup = turned({{0, 0}, {0.3, 0}, {0.3, 1}, {0.25, 1}, {0.25, 0.05}, {0, 0.05}}, 32);
  EXPECT_NEAR(volume(cup), kPi * (0.09 - 0.0625 * 0.95) * polygon_share(32), 1e-9);
}

TEST(Shape, TubeAlongAStraightPathIsACylinder) {
  EXPECT_NEAR(volume(tube({{0, 0, 0}, {0, 1, 0}, {0, 2, 0}}, 0.1, 16)), kPi * 0.01 * 2 * polygon_share(16), 1e-9);
}

TEST(Shape, SmoothPathPassesThroughItsPoints) {
  const std::vector<Vector3d> points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {2, 1, 1}};
  const std::vector<Vector3d> path = smooth_path(points, 5);
  ASSERT_EQ(path.size(), 16u);
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_LT((path[5 * i] - points[i]).norm(), 1e-12);
}

TEST(Shape, ExtrudedConcaveProfile) {
  // An L: 2 x 2 without a corner of 1 x 1.
  const Profile l = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  EXPECT_NEAR(volume(extruded(l, 1.5)), 4.5, 1e-12);
  EXPECT_NEAR(area(extruded(l, 1.5)), 2 * 3 + 8 * 1.5, 1e-12);
}

TEST(Shape, SweptRing) {
  const Profile section = {{1.0, 0}, {1.2, 0}, {1.2, 0.1}, {1.0, 0.1}};
  // Chords instead of arcs: each step's sector of angle a has area r^2 / 2 sin(a).
  const int steps = 15;
  const double a = kPi / 2 / steps;
  EXPECT_NEAR(volume(swept(section, 90, steps)), steps * 0.5 * std::sin(a) * (1.44 - 1.0) * 0.1, 1e-12);
}

TEST(Shape, TextureCoordinatesOfABoxAreMetres) {
  const Shape s = box(2, 3, 4);
  for (std::size_t t = 0; t < s.triangles.size(); t += 3) {
    const auto edge = [&](std::size_t i, std::size_t k) {
      const auto a = s.triangles[t + i], b = s.triangles[t + k];
      EXPECT_NEAR((s.uv[a] - s.uv[b]).norm(), (s.positions[a] - s.positions[b]).norm(), 1e-12);
    };
    edge(0, 1);
    edge(1, 2);
  }
}

TEST(Shape, PicturesAreNotMirrored) {
  // u grows along the first edge, v from the upper edge down; seen from the front the first edge must run to the right.
  const Shape s = picture({0, 0, 0}, {1, 0, 0}, {0, 0, 1});
  EXPECT_TRUE(s.normals[0].isApprox(Vector3d(0, -1, 0)));
  EXPECT_EQ(s.uv[0], Vector2d(0, 1));
  EXPECT_EQ(s.uv[2], Vector2d(1, 0));
}

TEST(Finishes, AllCanBeMade) {
  for (const std::string& name : finish_names()) {
    const Finish finish = make_finish(name);
    EXPECT_EQ(finish.name, name);
    EXPECT_GT(finish.reflectivity_850nm, 0.0);
    EXPECT_LT(finish.reflectivity_850nm, 1.0);
    EXPECT_GE(finish.colour.minCoeff(), 0.0);
    if (!finish.texture.empty()) {
      EXPECT_GT(finish.texture_width_m, 0.0) << name;
    }
  }
}

}  // namespace
}  // namespace waretwin::builder

// The halls that are shipped: rebuilding gives what is committed, and they hold what they should.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "core/error.h"
#include "core/files.h"
#include "core/pose.h"
#include "core/random.h"
#include "scenes/builder/halls.h"
#include "scenes/scenario.h"
#include "tests/support/test_data.h"

namespace waretwin {
namespace {

struct Hall {
  Scenario scenario;
  Scene scene;
};

Hall load(const std::string& name) {
  Scenario scenario = load_scenario(test::repository() / "scenes" / name / "scenario.yaml");
  Scene scene = build_scene(scenario);
  return {std::move(scenario), std::move(scene)};
}

// An upright box that stands anywhere, for overlap with triangles.
struct Solid {
  Eigen::Vector3d centre, half;
  double yaw;
};

Solid solid_of(const Cuboid& c, double shrink_xy, double bottom, double top) {
  return {{c.centre.x(), c.centre.y(), 0.5 * (bottom + top)},
          {0.5 * c.size.x() - shrink_xy, 0.5 * c.size.y() - shrink_xy, 0.5 * (top - bottom)},
          c.yaw};
}

// Separating axes of a box and a triangle (Akenine-Moeller): three faces, the triangle's plane, nine products of edges.
bool overlaps(const Solid& s, const Eigen::Vector3d& a_W, const Eigen::Vector3d& b_W, const Eigen::Vector3d& c_W) {
  const Eigen::AngleAxisd R_SW(-s.yaw, Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d v[3] = {R_SW * (a_W - s.centre), R_SW * (b_W - s.centre), R_SW * (c_W - s.centre)};
  const auto separates = [&](const Eigen::Vector3d& axis) {
    if (axis.squaredNorm() < 1e-18) return false;
    const double p0 = axis.dot(v[0]), p1 = axis.dot(v[1]), p2 = axis.dot(v[2]);
    const double reach = s.half.dot(axis.cwiseAbs());
    return std::min({p0, p1, p2}) > reach || std::max({p0, p1, p2}) < -reach;
  };
  const Eigen::Vector3d edges[3] = {v[1] - v[0], v[2] - v[1], v[0] - v[2]};
  for (int k = 0; k < 3; ++k) {
    if (separates(Eigen::Vector3d::Unit(k))) return false;
  }
  if (separates(edges[0].cross(edges[1]))) return false;
  for (int k = 0; k < 3; ++k) {
    for (const Eigen::Vector3d& edge : edges) {
      if (separates(Eigen::Vector3d::Unit(k).cross(edge))) return false;
    }
  }
  return true;
}

// Names of the instances outside any object that reach into the solid; the floor's marks and the floor itself lie below 2 mm.
std::set<std::string> background_in(const Scene& scene, const Solid& solid) {
  std::set<std::string> names;
  const double reach = solid.half.norm();
  for (const Instance& instance : scene.instances) {
    if (instance.object >= 0) continue;
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
    Eigen::AlignedBox3f box;
    for (const Eigen::Vector3f& p_M : mesh.positions) box.extend(instance.X_WM * p_M);
    const Eigen::Vector3d nearest = solid.centre.cwiseMax(box.min().cast<double>()).cwiseMin(box.max().cast<double>());
    if ((nearest - solid.centre).norm() > reach) continue;
    for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) {
      const auto corner = [&](std::size_t k) {
        return Eigen::Vector3d((instance.X_WM * mesh.positions[mesh.triangles[t + k]]).cast<double>());
      };
      if (!overlaps(solid, corner(0), corner(1), corner(2))) continue;
      names.insert(instance.name);
      break;
    }
  }
  return names;
}

std::string joined(const std::set<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += name + " ";
  return text;
}

class ShippedHall : public testing::TestWithParam<std::string> {};

TEST_P(ShippedHall, IsWhatTheBuilderMakes) {
  for (const builder::HallFile& file : builder::build_hall(GetParam())) {
    const std::string committed = read_file(test::repository() / "scenes" / GetParam() / file.name);
    EXPECT_LT(committed.size(), 4u << 20);
    // Not EXPECT_EQ: a failure would print megabytes.
    EXPECT_TRUE(committed == file.glb) << file.name << ": run waretwin_build_halls scenes and commit what changes";
  }
}

TEST_P(ShippedHall, LoadsWithoutNotesAndIsModerate) {
  const Hall hall = load(GetParam());
  EXPECT_TRUE(hall.scene.notes.empty()) << hall.scene.notes.front();
  EXPECT_GT(hall.scene.triangle_count(), 20'000u);
  EXPECT_LT(hall.scene.triangle_count(), 400'000u);
  EXPECT_GE(hall.scene.lights.size(), 6u);
  for (const Light& light : hall.scene.lights) EXPECT_GT(light.radius, 0.1f) << light.name;
  for (const Mesh& mesh : hall.scene.meshes) {
    const Material& material = hall.scene.materials[static_cast<std::size_t>(mesh.material)];
    EXPECT_GE(material.reflectivity_850nm, 0.05f) << material.name;
    EXPECT_LE(material.reflectivity_850nm, 0.95f) << material.name;
  }
}

TEST_P(ShippedHall, MeshesAreSound) {
  const Hall hall = load(GetParam());
  for (const Mesh& mesh : hall.scene.meshes) {
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size()) << mesh.name;
    for (const Eigen::Vector3f& n : mesh.normals) ASSERT_NEAR(n.norm(), 1.0f, 2e-3f) << mesh.name;
    std::size_t against = 0, counted = 0;
    for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) {
      const Eigen::Vector3f &a = mesh.positions[mesh.triangles[t]], &b = mesh.positions[mesh.triangles[t + 1]],
                            &c = mesh.positions[mesh.triangles[t + 2]];
      const Eigen::Vector3f face = (b - a).cross(c - a);
      if (face.norm() < 1e-8f) continue;
      ++counted;
      against += face.dot(mesh.normals[mesh.triangles[t]]) < 0.0f ? 1 : 0;
    }
    EXPECT_EQ(against, 0u) << mesh.name << ": of " << counted << " triangles that many face against their normals";
  }
}

TEST_P(ShippedHall, ConveyorsStandOnSomethingAndHoldNothing) {
  const Hall hall = load(GetParam());
  for (const TrueObject& object : hall.scene.objects) {
    EXPECT_EQ(object.class_name, "conveyor") << object.name;
    const Cuboid& c = object.cuboid;
    const Solid below = solid_of(c, 0.05, c.bottom() - 0.002, c.bottom() + 0.0005);
    EXPECT_FALSE(background_in(hall.scene, below).empty()) << object.name << " floats";
    // A curve's box holds more than the curve; floor-standing ones may carry parcels above their running surface.
    if (object.name.find("curve") != std::string::npos) continue;
    const bool table_top = c.size.z() < 0.3;
    const Solid inside = solid_of(c, 0.003, c.bottom() + 0.003, table_top ? c.top() + 0.05 : c.top() - 0.08);
    const std::set<std::string> found = background_in(hall.scene, inside);
    EXPECT_TRUE(found.empty()) << object.name << " is cut by " << joined(found);
  }
}

TEST_P(ShippedHall, ConveyorsDoNotMeet) {
  const Hall hall = load(GetParam());
  const auto& objects = hall.scene.objects;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    for (std::size_t k = i + 1; k < objects.size(); ++k) {
      if ((objects[i].name + objects[k].name).find("curve") != std::string::npos) continue;
      EXPECT_EQ(intersection_volume(objects[i].cuboid, objects[k].cuboid), 0.0) << objects[i].name << ", " << objects[k].name;
    }
  }
}

// The body, 3 cm wider on every side, at each turn in steps of 3 deg and along each straight piece.
TEST_P(ShippedHall, RouteIsClear) {
  const Hall hall = load(GetParam());
  const RobotConfig& robot = hall.scenario.robot;
  const double margin = 0.03, low = 0.005, high = 1.45;  // up to the camera
  std::set<std::string> met;
  const auto check = [&](const Eigen::Vector2d& at, double length, double yaw) {
    const Solid body{{at.x(), at.y(), 0.5 * (low + high)}, {0.5 * length + margin, 0.5 * robot.width_m + margin, 0.5 * (high - low)}, yaw};
    for (const std::string& name : background_in(hall.scene, body)) {
      met.insert(name + " at (" + std::to_string(at.x()) + ", " + std::to_string(at.y()) + ") yaw " + std::to_string(to_degrees(yaw)));
    }
    for (const TrueObject& object : hall.scene.objects) {
      Cuboid box;
      box.centre = body.centre;
      box.size = 2 * body.half;
      box.yaw = yaw;
      if (intersection_volume(box, object.cuboid) > 0) met.insert(object.name);
    }
  };
  const auto turn = [&](const Eigen::Vector2d& at, double from, double to) {
    const double angle = wrap_angle(to - from);
    const int steps = 1 + static_cast<int>(std::abs(angle) / to_radians(3.0));
    for (int k = 1; k <= steps; ++k) check(at, robot.length_m, from + angle * k / steps);
  };
  Eigen::Vector2d at(robot.route[0].x_m, robot.route[0].y_m);
  ASSERT_TRUE(robot.route[0].heading_deg.has_value());
  double yaw = to_radians(*robot.route[0].heading_deg);
  check(at, robot.length_m, yaw);
  for (std::size_t i = 1; i < robot.route.size(); ++i) {
    const Waypoint& next = robot.route[i];
    const Eigen::Vector2d to(next.x_m, next.y_m), way = to - at;
    const double heading = std::atan2(way.y(), way.x()) + (next.reverse ? std::numbers::pi : 0.0);
    turn(at, yaw, heading);
    check(0.5 * (at + to), robot.length_m + way.norm(), heading);
    yaw = heading;
    at = to;
    if (next.heading_deg) {
      turn(at, yaw, to_radians(*next.heading_deg));
      yaw = to_radians(*next.heading_deg);
    }
  }
  EXPECT_TRUE(met.empty()) << joined(met);
}

INSTANTIATE_TEST_SUITE_P(All, ShippedHall, testing::ValuesIn(builder::hall_names()), [](const auto& tested) { return tested.param; });

TEST(AgiprobotHall, HoldsFourTableTopConveyors) {
  const Hall hall = load("agiprobot");
  const Eigen::Vector3d expected[] = {{0.60, 0.40, 0.15}, {0.64, 0.40, 0.15}, {0.58, 0.38, 0.15}, {0.62, 0.42, 0.16}};
  ASSERT_EQ(hall.scene.objects.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    const TrueObject& object = hall.scene.objects[i];
    EXPECT_EQ(object.name, "conveyor_" + std::to_string(i + 1));
    EXPECT_TRUE(object.cuboid.size.isApprox(expected[i], 1e-3)) << object.cuboid.size.transpose();
    EXPECT_NEAR(object.cuboid.bottom(), 0.75, 1e-3);
    // Not along the walls, by a few degrees.
    const double off = angle_distance(object.cuboid.yaw, 0.0, std::numbers::pi);
    EXPECT_GT(off, to_radians(2.0));
    EXPECT_LT(off, to_radians(10.0));
  }
}

TEST(AgiprobotHall, KeepsClutterFiveCentimetresFromEachConveyor) {
  const Hall hall = load("agiprobot");
  for (const TrueObject& object : hall.scene.objects) {
    const Cuboid& c = object.cuboid;
    const std::set<std::string> found = background_in(hall.scene, solid_of(c, -0.05, c.bottom() + 0.01, c.top()));
    EXPECT_TRUE(found.empty()) << object.name << " is near " << joined(found);
  }
}

TEST(AgiprobotHall, IsSixByTwelveMetresWithAFloorAtZero) {
  const Hall hall = load("agiprobot");
  const Eigen::AlignedBox3f box = hall.scene.bounds();
  EXPECT_NEAR(box.min().z(), 0.0f, 1e-4f);
  EXPECT_NEAR(box.sizes().x(), 12.0f, 0.3f);  // windows and doors are set into the walls
  EXPECT_NEAR(box.sizes().y(), 6.0f, 0.3f);
}

TEST(WarehouseHall, HoldsStraightAndCurvedConveyorsOnTheFloor) {
  const Hall hall = load("warehouse");
  EXPECT_GE(hall.scene.objects.size(), 12u);
  int curves = 0;
  for (const TrueObject& object : hall.scene.objects) {
    curves += object.name.find("curve") != std::string::npos ? 1 : 0;
    EXPECT_NEAR(object.cuboid.bottom(), 0.0, 1e-3) << object.name;
  }
  EXPECT_EQ(curves, 2);
  const Eigen::AlignedBox3f box = hall.scene.bounds();
  EXPECT_NEAR(box.sizes().x(), 40.0f, 0.3f);
  EXPECT_NEAR(box.sizes().y(), 25.0f, 0.3f);
}

TEST(ShippedHalls, RejectAnUnknownName) { EXPECT_THROW(builder::build_hall("castle"), Error); }

// The overlap test above against points: a triangle overlaps a box exactly when one of many points on it lies inside, up to a thin shell.
TEST(TriangleBoxOverlap, AgreesWithSampledPoints) {
  const RandomStream random(7, "test", "triangles");
  int inside_count = 0;
  for (std::uint64_t i = 0; i < 400; ++i) {
    const auto draw = [&](std::uint32_t k) { return 2.4 * random.uniform(i, k) - 1.2; };
    const Solid solid{{0.1, -0.2, 0.3}, {0.5, 0.3, 0.2}, draw(0)};
    const Eigen::Vector3d a(draw(1), draw(2), draw(3)), b(draw(4), draw(5), draw(6)), c(draw(7), draw(8), draw(9));
    bool inside = false;
    constexpr int kSteps = 60;
    for (int u = 0; u <= kSteps; ++u) {
      for (int v = 0; u + v <= kSteps; ++v) {
        const Eigen::Vector3d p = a + (b - a) * u / kSteps + (c - a) * v / kSteps - solid.centre;
        const Eigen::Vector3d q = Eigen::AngleAxisd(-solid.yaw, Eigen::Vector3d::UnitZ()) * p;
        inside = inside || (q.cwiseAbs() - solid.half).maxCoeff() <= 0;
      }
    }
    inside_count += inside ? 1 : 0;
    if (inside) {
      EXPECT_TRUE(overlaps(solid, a, b, c));
    }
    // A sampled miss allows an overlap no deeper than the samples' spacing.
    const Solid smaller{solid.centre, solid.half - Eigen::Vector3d::Constant(0.06), solid.yaw};
    if (!inside) {
      EXPECT_FALSE(overlaps(smaller, a, b, c));
    }
  }
  EXPECT_GT(inside_count, 40);
}

}  // namespace
}  // namespace waretwin

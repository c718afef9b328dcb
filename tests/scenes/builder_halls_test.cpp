// The halls that are shipped: rebuilding gives what is committed, and they hold what they should.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "core/error.h"
#include "core/files.h"
#include "core/pose.h"
#include "core/random.h"
#include "scenes/builder/halls.h"
#include "scenes/scenario.h"
#include "tests/scenes/hall_checks.h"
#include "tests/support/test_data.h"

namespace waretwin {
namespace {

using test::background_in;
using test::joined;
using test::on_the_route;
using test::overlaps;
using test::Solid;
using test::solid_of;

struct Hall {
  Scenario scenario;
  Scene scene;
};

Hall load(const std::string& name) {
  Scenario scenario = load_scenario(test::repository() / "scenes" / name / "scenario.yaml");
  Scene scene = build_scene(scenario);
  return {std::move(scenario), std::move(scene)};
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

class ConveyorHall : public testing::TestWithParam<std::string> {};

TEST_P(ConveyorHall, ConveyorsStandOnSomethingAndHoldNothing) {
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

TEST_P(ConveyorHall, ConveyorsDoNotMeet) {
  const Hall hall = load(GetParam());
  const auto& objects = hall.scene.objects;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    for (std::size_t k = i + 1; k < objects.size(); ++k) {
      if ((objects[i].name + objects[k].name).find("curve") != std::string::npos) continue;
      EXPECT_EQ(intersection_volume(objects[i].cuboid, objects[k].cuboid), 0.0) << objects[i].name << ", " << objects[k].name;
    }
  }
}

TEST_P(ShippedHall, RouteIsClear) {
  const Hall hall = load(GetParam());
  const std::set<std::string> met = on_the_route(hall.scene, hall.scenario.robot, 0.03);
  EXPECT_TRUE(met.empty()) << joined(met);
}

INSTANTIATE_TEST_SUITE_P(All, ShippedHall, testing::ValuesIn(builder::hall_names()), [](const auto& tested) { return tested.param; });
INSTANTIATE_TEST_SUITE_P(All, ConveyorHall, testing::Values("agiprobot", "warehouse"), [](const auto& tested) { return tested.param; });

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

TEST(FlatHall, HoldsTheNineClassesInBelievableSizes) {
  const Hall hall = load("flat");
  struct Range {
    int count;
    Eigen::Vector3d least, most;  // dx >= dy, and height
  };
  const std::map<std::string, Range> expected = {
      {"bed", {1, {1.9, 0.9, 0.7}, {2.2, 1.9, 1.2}}},        {"chair", {6, {0.4, 0.4, 0.8}, {0.7, 0.7, 1.15}}},
      {"sofa", {2, {0.8, 0.8, 0.75}, {2.4, 1.0, 1.0}}},      {"table", {3, {1.0, 0.5, 0.4}, {1.6, 0.9, 0.8}}},
      {"books", {6, {0.25, 0.15, 0.06}, {1.1, 0.25, 0.3}}},  {"refrigerator", {1, {0.55, 0.5, 1.2}, {0.75, 0.7, 1.9}}},
      {"television", {1, {1.0, 0.1, 0.6}, {1.3, 0.3, 0.8}}}, {"toilet", {1, {0.6, 0.35, 0.7}, {0.75, 0.45, 0.9}}},
      {"bag", {3, {0.3, 0.12, 0.35}, {0.45, 0.35, 0.55}}}};
  std::map<std::string, int> counts;
  std::set<std::string> names;
  for (const TrueObject& object : hall.scene.objects) {
    ASSERT_TRUE(expected.contains(object.class_name)) << object.class_name;
    const Range& range = expected.at(object.class_name);
    ++counts[object.class_name];
    names.insert(object.name);
    EXPECT_TRUE((object.cuboid.size.array() >= range.least.array()).all()) << object.name << ": " << object.cuboid.size.transpose();
    EXPECT_TRUE((object.cuboid.size.array() <= range.most.array()).all()) << object.name << ": " << object.cuboid.size.transpose();
  }
  for (const auto& [name, range] : expected) EXPECT_EQ(counts[name], range.count) << name;
  EXPECT_EQ(names.size(), hall.scene.objects.size()) << "each has a name of its own";
}

TEST(FlatHall, ObjectsStandOnSomethingAndCutIntoNothing) {
  const Hall hall = load("flat");
  for (std::size_t i = 0; i < hall.scene.objects.size(); ++i) {
    const TrueObject& object = hall.scene.objects[i];
    const Cuboid& c = object.cuboid;
    const Solid below = solid_of(c, 0.02, c.bottom() - 0.002, c.bottom() + 0.0005);
    const std::set<std::string> support =
        test::things_in(hall.scene, below, [&](const Instance& instance) { return instance.object != static_cast<int>(i); });
    EXPECT_FALSE(support.empty()) << object.name << " floats";
    const std::set<std::string> cut = test::cuts_into(hall.scene, static_cast<int>(i));
    EXPECT_TRUE(cut.empty()) << object.name << " is cut by " << joined(cut);
  }
}

TEST(FlatHall, IsNineBySevenMetresAndShowsEveryRoom) {
  const Hall hall = load("flat");
  const Eigen::AlignedBox3f box = hall.scene.bounds();
  EXPECT_NEAR(box.min().z(), 0.0f, 1e-4f);
  EXPECT_NEAR(box.sizes().x(), 9.0f, 0.3f);  // windows and doors are set into the walls
  EXPECT_NEAR(box.sizes().y(), 7.0f, 0.3f);
  // Into every room: left and right of the walls between them.
  const auto visits = [&](double x0, double y0, double x1, double y1) {
    const auto& route = hall.scenario.robot.route;
    return std::any_of(route.begin(), route.end(),
                       [&](const Waypoint& w) { return w.heading_deg && w.x_m > x0 && w.x_m < x1 && w.y_m > y0 && w.y_m < y1; });
  };
  EXPECT_TRUE(visits(-4.5, -3.5, 0.9, 0.7)) << "living room";
  EXPECT_TRUE(visits(0.9, -3.5, 4.5, -0.5)) << "kitchen";
  EXPECT_TRUE(visits(0.9, -0.5, 4.5, 3.5)) << "bedroom";
  EXPECT_TRUE(visits(-1.4, 0.7, 0.9, 3.5)) << "bathroom";
  EXPECT_TRUE(visits(-4.5, 0.7, -1.4, 3.5)) << "study";
}

// The check that the flat's test rests on.
TEST(PiercedTriangles, AreThoseThatASegmentPassesThrough) {
  const std::array<Eigen::Vector3d, 3> t = {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0)};
  EXPECT_TRUE(test::pierces({0.2, 0.2, -1}, {0.3, 0.3, 1}, t, 0.001));
  EXPECT_FALSE(test::pierces({0.2, 0.2, 0}, {0.3, 0.3, 1}, t, 0.001)) << "begins on it";
  EXPECT_FALSE(test::pierces({0.8, 0.8, -1}, {0.8, 0.8, 1}, t, 0.001)) << "passes beside it";
  EXPECT_FALSE(test::pierces({0.2, 0.2, 0.5}, {0.3, 0.3, 1}, t, 0.001)) << "ends before it";
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

#include "scenes/scenario.h"

#include <gtest/gtest.h>

#include "scenes/describe.h"
#include "tests/scenes/gltf_writer.h"
#include "tests/support/expect_error.h"
#include "tests/support/test_data.h"

namespace waretwin::test {
namespace {

const char* const kYaml =
    "models:\n"
    "  - file: box.glb\n"
    "  - {file: box.glb, x_m: 5, yaw_deg: 90, class: crate, name: second}\n"
    "truth:\n"
    "  - {pattern: 'conv*', class: conveyor}\n"
    "lighting:\n"
    "  lights: [{kind: spot, position_m: [0, 0, 2], direction: [0, 0, -2], intensity: 10}]\n"
    "robot:\n"
    "  route:\n"
    "    - {x_m: 0, y_m: 0}\n"
    "    - {x_m: 1, y_m: 0, heading_deg: 45, wait_s: 2}\n"
    "sensors:\n"
    "  lasers: {laser: {}}\n";

class ScenarioTest : public ::testing::Test {
 protected:
  ScenarioTest() {
    GltfWriter w;
    w.show(w.cube(), {{"name", "conveyor_1"}, {"scale", {2, 1, 1}}});
    put_file(folder.path() / "box.glb", w.glb());
  }
  std::filesystem::path write(std::string yaml, const std::string& from = "", const std::string& to = "") {
    if (!from.empty()) yaml.replace(yaml.find(from), from.size(), to);
    put_file(folder.path() / "scenario.yaml", yaml);
    return folder.path() / "scenario.yaml";
  }
  TemporaryFolder folder;
};

TEST_F(ScenarioTest, BuildsTheScene) {
  const Scenario scenario = load_scenario(write(kYaml), {{"models.1.y_m", "3"}});
  EXPECT_FALSE(scenario.robot.route[0].heading_deg);
  EXPECT_DOUBLE_EQ(scenario.robot.route[1].heading_deg.value(), 45.0);
  const Scene scene = build_scene(scenario);
  EXPECT_EQ(scene.meshes.size(), 1u);  // one file, placed twice
  EXPECT_EQ(scene.instances.size(), 2u);
  ASSERT_EQ(scene.objects.size(), 2u);
  EXPECT_EQ(scene.objects[0].class_name, "conveyor");
  EXPECT_EQ(scene.objects[0].name, "conveyor_1");
  EXPECT_EQ(scene.objects[1].id, 2);
  EXPECT_EQ(scene.objects[1].class_name, "crate");
  EXPECT_EQ(scene.objects[1].name, "second");
  // x 0..2, y 0..1 in the file's z; turned by 90 deg about (5, 3): x' = 5 - y, y' = 3 + x, where the file's z is -y.
  const Cuboid& c = scene.objects[1].cuboid;
  EXPECT_TRUE((c.centre - Eigen::Vector3d(5.5, 4.0, 0.5)).norm() < 1e-6) << c.centre.transpose();
  EXPECT_NEAR(c.yaw, 1.5707963, 1e-5);
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_TRUE(scene.lights[0].direction.isApprox(-Eigen::Vector3f::UnitZ()));
  const std::string text = describe_scenario(scenario);
  EXPECT_NE(text.find("crate 'second'"), std::string::npos) << text;
}

TEST_F(ScenarioTest, ResolvedValuesReadBack) {
  Scenario scenario = load_scenario(write(kYaml));
  const std::string text = write_config([&](Fields& f) { scenario.visit(f); });
  Scenario again;
  read_config_text(text, "again", [&](Fields& f) { again.visit(f); });
  EXPECT_EQ(text, write_config([&](Fields& f) { again.visit(f); }));
  EXPECT_FALSE(again.robot.route[0].heading_deg);
}

const char* const kMotion =
    "motion:\n"
    "  belts:\n"
    "    - {object: second, speed_mps: 0.4, changes: [{at_s: 1, speed_mps: 0}, {at_s: 2, speed_mps: 0.4}]}\n"
    "  streams:\n"
    "    - {file: plain.glb, x_m: 1, y_m: 2, z_m: 0.5, most: 3}\n"
    "  clutter:\n"
    "    - {name: tool, file: plain.glb, count: 2, x_m: 0, y_m: 0}\n"
    "  walkers:\n"
    "    - {file: plain.glb, path: [{x_m: 3, y_m: 3}]}\n"
    "  held:\n"
    "    - {name: sign, file: plain.glb, stand: plain.glb, places: [{x_m: 1, y_m: 0, z_m: 1}, {x_m: 2, y_m: 0, z_m: 1}]}\n";

TEST_F(ScenarioTest, MoversStandInOrderAndAreNoObjects) {
  GltfWriter w;
  w.show(w.cube(), {{"name", "anything"}});
  put_file(folder.path() / "plain.glb", w.glb());
  const Scenario scenario = load_scenario(write(kYaml + std::string(kMotion)));
  const Scene scene = build_scene(scenario);
  ASSERT_EQ(scene.movers.size(), 8u);
  EXPECT_EQ(scene.movers[0].name, "plain");
  EXPECT_EQ(scene.movers[3].name, "tool");
  EXPECT_EQ(scene.movers[5].name, "plain");
  EXPECT_EQ(scene.movers[6].name, "sign");
  EXPECT_EQ(scene.movers[7].name, "plain") << "its stand";
  EXPECT_EQ(scene.objects.size(), 2u);
  for (const Mover& mover : scene.movers) {
    ASSERT_EQ(mover.instances.size(), 1u);
    EXPECT_EQ(scene.instances[static_cast<std::size_t>(mover.instances[0])].object, -1);
  }
  EXPECT_EQ(scene.meshes.size(), 2u) << "copies share their mesh";
  const std::string text = describe_scenario(scenario);
  for (const char* part : {"second: 0.4 m/s", "2 x tool", "1 places", "at most 3", "sign: plain.glb in 2 places"})
    EXPECT_NE(text.find(part), std::string::npos) << text;

  const std::string all = kYaml + std::string(kMotion);
  EXPECT_ERROR(load_scenario(write(all, "{file: plain.glb, x_m: 1", "{file: plan.glb, x_m: 1")), "motion.streams.0.file", "no such file");
  EXPECT_ERROR(load_scenario(write(all, "at_s: 2", "at_s: 1")), "motion.belts.0.changes", "in order");
  EXPECT_ERROR(load_scenario(write(all, "path: [{x_m: 3, y_m: 3}]", "path: []")), "motion.walkers.0.path", "at least one");
  EXPECT_ERROR(load_scenario(write(all, "stand: plain.glb", "stand: plan.glb")), "motion.held.0.stand", "no such file");
  EXPECT_ERROR(load_scenario(write(all, "places: [{x_m: 1, y_m: 0, z_m: 1}, {x_m: 2, y_m: 0, z_m: 1}]", "places: []")),
               "motion.held.0.places", "at least one");
  EXPECT_ERROR(load_scenario(write(all, "most: 3", "most: 0")), "motion.streams.0.most", "1");
  // A node that the file itself makes a true object cannot move.
  GltfWriter classed;
  classed.show(classed.cube(), {{"name", "c"}, {"extras", {{"waretwin", {{"class", "conveyor"}}}}}});
  put_file(folder.path() / "plain.glb", classed.glb());
  EXPECT_ERROR(build_scene(load_scenario(write(all))), "plain.glb", "no true object");
}

TEST_F(ScenarioTest, ErrorsNameFileLineAndKey) {
  put_file(folder.path() / "other.txt", "");
  EXPECT_ERROR(load_scenario(write(kYaml, "file: box.glb\n", "file: bax.glb\n")), "scenario.yaml:2", "models.0.file", "no such file");
  EXPECT_ERROR(load_scenario(write(kYaml, "file: box.glb\n", "file: ../box.glb\n")), "scenario.yaml:2", "inside the scenario's folder");
  EXPECT_ERROR(load_scenario(write(kYaml, "file: box.glb\n", "file: /tmp/box.glb\n")), "scenario.yaml:2", "relative");
  EXPECT_ERROR(load_scenario(write(kYaml, "file: box.glb\n", "file: other.txt\n")), "scenario.yaml:2", ".glb");
  EXPECT_ERROR(load_scenario(write(kYaml, "class: conveyor", "class: ''")), "scenario.yaml:5", "class");
  EXPECT_ERROR(load_scenario(write(kYaml, "wait_s", "wiat_s")), "scenario.yaml:11", "wait_s");
  EXPECT_ERROR(load_scenario(write(kYaml, "direction: [0, 0, -2]", "direction: [0, 0, 0]")), "scenario.yaml:7", "direction");
  EXPECT_ERROR(load_scenario(write(kYaml, "lasers: {laser: {}}", "lasers: {}")), "sensors", "camera");
  EXPECT_ERROR(load_scenario(write("models: []\nrobot: {route: [{x_m: 0, y_m: 0}]}\n")), "scenario.yaml", "models");
  EXPECT_ERROR(load_scenario(write(kYaml), {{"models.0.file", "bax.glb"}}), "models.0.file", "bax.glb");
  EXPECT_ERROR(load_scenario(write(kYaml), {{"robot.model", "cart.stl"}}), "robot.model", ".gltf or .glb");
  EXPECT_ERROR(load_scenario(write(kYaml), {{"robot.model", "../cart.glb"}}), "robot.model", "inside the scenario's folder");
  EXPECT_ERROR(build_scene(load_scenario(write(kYaml, "conv*", "crane*"))), "truth.0.pattern", "crane*", "matches no node");
  EXPECT_ERROR(load_scenario(folder.path() / "none.yaml"), "none.yaml", "no such file");
}

}  // namespace
}  // namespace waretwin::test

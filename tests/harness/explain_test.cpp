#include "harness/score/explain.h"

#include <gtest/gtest.h>

#include "core/pose.h"

namespace waretwin {
namespace {

ListedObject object(int id, double x, double y, double yaw_deg = 10.0, const Eigen::Vector3d& size = {0.6, 0.4, 0.15}, double bottom = 0.75,
                    const std::string& name = "conveyor") {
  return {id, name, {{x, y, bottom + 0.5 * size.z()}, to_radians(yaw_deg), size, "world"}, 1.0, 0.9};
}

std::vector<Explanation> explained(const std::vector<ListedObject>& mapped, const std::vector<ListedObject>& truth) {
  return explain(mapped, truth, score_objects(mapped, truth));
}

// The only line's text.
std::string why(const std::vector<ListedObject>& mapped, const std::vector<ListedObject>& truth) {
  const auto lines = explained(mapped, truth);
  EXPECT_EQ(lines.size(), 1u);
  return lines.empty() ? "" : lines[0].text;
}

TEST(Explain, SaysNothingOfGoodObjects) { EXPECT_TRUE(explained({object(4, 0.003, 0)}, {object(1, 0, 0)}).empty()); }

TEST(Explain, NeverDetected) {
  EXPECT_EQ(why({}, {object(1, 0, 0)}), "not in the map, though 0.90 of its surface was seen");
  const auto lines = explained({object(7, 1.5, 0)}, {object(1, 0, 0)});
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0].text,
            "not in the map where it stands, though 0.90 of its surface was seen; the nearest mapped conveyor (7) is 1.50 m away");
  EXPECT_EQ(lines[0].truth_id, 1);
  EXPECT_EQ(lines[1].map_id, 7);
  EXPECT_EQ(lines[1].text, "nothing of its class there: the nearest true conveyor (1) is 1.50 m away");
}

TEST(Explain, HalfSeen) {
  ListedObject truth = object(1, 0, 0);
  truth.visible_fraction = 0.43;
  EXPECT_EQ(why({}, {truth}), "half seen: 0.43 of its surface, 0.60 would count");
  truth.visible_fraction = 0.0;
  EXPECT_EQ(why({}, {truth}), "not seen at all, 0.60 would count");
  // Of a counted one the end is missing.
  ListedObject half = object(3, 0, 0, 0.0, {0.40, 0.4, 0.15});
  half.cuboid.centre.x() = -0.1;
  EXPECT_EQ(why({half}, {object(1, 0, 0, 0.0)}), "half seen: 0.20 m short along its long side");
}

TEST(Explain, Merged) {
  const std::vector<ListedObject> truth = {object(1, 0, 0, 0), object(7, 0.65, 0, 0)};
  const auto lines = explained({object(2, 0.325, 0, 0, {1.25, 0.4, 0.15})}, truth);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0].text, "merged with 7: mapped object 2 spans them too");
  EXPECT_EQ(lines[1].text, "merged with 1: mapped object 2 spans both");
}

TEST(Explain, YawOff) { EXPECT_EQ(why({object(2, 0, 0, 100.0)}, {object(1, 0, 0, 10.0)}), "yaw 90 deg off"); }

TEST(Explain, SupportPlaneKeptAndTops) {
  EXPECT_EQ(why({object(2, 0, 0, 10, {0.6, 0.4, 0.9}, 0.0)}, {object(1, 0, 0)}), "support plane kept: reaches 0.75 m below its foot");
  EXPECT_EQ(why({object(2, 0, 0, 10, {0.6, 0.4, 0.25})}, {object(1, 0, 0)}), "something on top kept: 0.10 m too high");
  EXPECT_EQ(why({object(2, 0, 0, 10, {0.6, 0.4, 0.10})}, {object(1, 0, 0)}), "top missing: 0.05 m too low");
}

TEST(Explain, ShiftedAndGrown) {
  EXPECT_EQ(why({object(2, 0.2, 0, 0)}, {object(1, 0, 0, 0)}), "shifted by 0.20 m along its long side");
  EXPECT_EQ(why({object(2, 0, 0.1, 0, {0.6, 0.6, 0.15})}, {object(1, 0, 0, 0)}), "grown: 0.20 m too much along its short side");
}

TEST(Explain, WrongClassAndSecondObject) {
  const auto lines = explained({object(2, 0, 0, 10, {0.6, 0.4, 0.15}, 0.75, "table")}, {object(1, 0, 0)});
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0].text, "mapped as table (object 2)");
  EXPECT_EQ(why({object(2, 0, 0), object(3, 0.15, 0)}, {object(1, 0, 0)}), "second object on 1, which is mapped as 2");
}

}  // namespace
}  // namespace waretwin

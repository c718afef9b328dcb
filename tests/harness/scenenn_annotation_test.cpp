#include "harness/score/scenenn_annotation.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/files.h"
#include "tests/support/expect_error.h"
#include "tests/support/test_data.h"

namespace waretwin {
namespace {

class Annotation : public ::testing::Test {
 protected:
  std::vector<ListedObject> read(const std::string& labels, const Pose& X_UR = Pose::Identity()) {
    write_file(file(), "<?xml version=\"1.0\"?>\n<annotation>\n" + labels + "\n</annotation>\n");
    return read_scenenn_annotation(file(), X_UR);
  }
  std::filesystem::path file() const { return folder_.path() / "011.xml"; }
  test::TemporaryFolder folder_;
};

TEST_F(Annotation, WhatIsWrittenComesBack) {
  std::vector<ListedObject> objects(2);
  objects[0].id = 3, objects[0].class_name = "chair";
  objects[0].cuboid.centre = Eigen::Vector3d(1.0 / 3, -2, 0.45), objects[0].cuboid.size = Eigen::Vector3d(0.6, 0.5, 0.9),
  objects[0].cuboid.yaw = 0.7;
  objects[1].id = 9, objects[1].class_name = "table & more";
  objects[1].cuboid.centre = Eigen::Vector3d(4, 5, 0.4), objects[1].cuboid.size = Eigen::Vector3d(1.6, 0.8, 0.8),
  objects[1].cuboid.yaw = 3.0;
  write_file(file(), scenenn_annotation(objects));
  const std::vector<ListedObject> again = read_scenenn_annotation(file());
  ASSERT_EQ(again.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(again[i].id, objects[i].id);
    EXPECT_EQ(again[i].class_name, objects[i].class_name);
    EXPECT_NEAR(iou_3d(again[i].cuboid, objects[i].cuboid), 1.0, 1e-12);
    EXPECT_NEAR(angle_distance(again[i].cuboid.yaw, objects[i].cuboid.yaw, std::numbers::pi), 0.0, 1e-12);
  }
}

// The world of a recording whose y points down: a box that stands on its side there stands upright here.
TEST_F(Annotation, BoxesBecomeUprightInTheMapsWorld) {
  Pose X_UR = Pose::Identity();
  X_UR.linear() << 1, 0, 0,  //
      0, 0, 1,               //
      0, -1, 0;              // z up = -y
  const auto objects = read("<label id=\"1\" text=\"x\" nyu_class=\"Refridgerator\" obbox=\"1 -0.9 2 0.7 1.8 0.6 0 0 0 1\"/>", X_UR);
  ASSERT_EQ(objects.size(), 1u);
  EXPECT_EQ(objects[0].class_name, "refrigerator");
  EXPECT_TRUE(objects[0].cuboid.centre.isApprox(Eigen::Vector3d(1, 2, 0.9), 1e-12));
  EXPECT_TRUE(objects[0].cuboid.size.isApprox(Eigen::Vector3d(0.7, 0.6, 1.8), 1e-12)) << objects[0].cuboid.size.transpose();
  // A box that leans by 30 deg about its own x: the upright one holds its corners.
  const auto leaning = read("<label id=\"1\" text=\"board\" obbox=\"0 0 1 1 0.2 2 " + std::to_string(std::sin(std::numbers::pi / 12)) +
                            " 0 0 " + std::to_string(std::cos(std::numbers::pi / 12)) + "\"/>");
  EXPECT_NEAR(leaning[0].cuboid.size.z(), 2 * std::cos(std::numbers::pi / 6) + 0.2 * 0.5, 1e-5);
  EXPECT_NEAR(leaning[0].cuboid.size.y(), 1.0, 1e-5) << "canonical: the longer edge first";
  EXPECT_NEAR(leaning[0].cuboid.size.x(), 2 * 0.5 + 0.2 * std::cos(std::numbers::pi / 6), 1e-5);
}

TEST_F(Annotation, LeavesTheRoomOutAndNamesWhatIsDamaged) {
  EXPECT_TRUE(read("<label id=\"1\" text=\"wall\" obbox=\"0 0 0 1 1 1 0 0 0 1\"/><label id=\"2\" text=\"\" obbox=\"0 0 0 1 1 1 0 0 0 1\"/>"
                   "<label id=\"3\" text=\"chair\"/><label id=\"4\" text=\"chair\" obbox=\"0 0 0 0 1 1 0 0 0 1\"/>")
                  .empty());
  EXPECT_ERROR(read("<label id=\"one\" text=\"chair\" obbox=\"0 0 0 1 1 1 0 0 0 1\"/>"), "011.xml:3:", "id is 'one'");
  EXPECT_ERROR(read("<label id=\"1\" text=\"chair\" obbox=\"0 0 0 1 1 1 0 0 0\"/>"), "expected ten numbers");
  EXPECT_ERROR(read("<label id=\"1\" text=\"chair\" obbox=\"0 0 0 1 1 1 0 0 0 x\"/>"), "expected ten numbers");
  EXPECT_ERROR(read("<label id=\"1\" text=\"chair\" obbox=\"0 0 0 1 1e300 1 0 0 0 1\"/>"), "expected ten numbers up to 1e9");
  EXPECT_ERROR(read("<label id=\"1\" text=\"chair\" obbox=\"0 0 0 1 -1 1 0 0 0 1\"/>"), "negative length");
  EXPECT_ERROR(read("<label id=\"1\" text=\"chair\" obbox=\"0 0 0 1 1 1 0 0 0 2\"/>"), "no quaternion");
  const std::string one = "<label id=\"1\" text=\"chair\" obbox=\"0 0 0 1 1 1 0 0 0 1\"/>";
  EXPECT_ERROR(read(one + one), "id 1 stands twice");
  write_file(file(), "<annotation><label>");
  EXPECT_ERROR(read_scenenn_annotation(file()), "011.xml", "is not XML");
  write_file(file(), "<mesh/>");
  EXPECT_ERROR(read_scenenn_annotation(file()), "no <annotation>");
}

}  // namespace
}  // namespace waretwin

#include "sim/visibility.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "sim/ray_caster.h"
#include "tests/sim/fixtures.h"

namespace waretwin {
namespace {

// A cube of 0.4 m that floats 0.6 m above the floor in the middle of a hall: the camera, 1.4 m up, can see its top and sides from some
// place, its underside from none.
std::shared_ptr<const RayCaster> cube_in_hall() {
  Scene scene = fixtures::room(-4, 4, -4, 4, 3);
  const int object = fixtures::add_object(scene, "cube");
  fixtures::add_instance(scene, fixtures::add_mesh(scene, fixtures::unit_box(), fixtures::add_material(scene, {1, 1, 1})),
                         fixtures::placed({-0.2f, -0.2f, 0.6f}, {0.4f, 0.4f, 0.4f}), object);
  return std::make_shared<const RayCaster>(std::make_shared<const Scene>(std::move(scene)));
}

TEST(SurfaceCoverage, FiveOfSixSidesAreViewable) {
  const SurfaceCoverage coverage(cube_in_hall(), {{"camera", CameraConfig()}}, RobotConfig());
  EXPECT_NEAR(coverage.viewable(1), 5.0 / 6.0, 0.02);
  EXPECT_EQ(coverage.fraction(1), 0.0);
  EXPECT_THROW(coverage.fraction(2), Error);
}

TEST(SurfaceCoverage, FramesAddTheSidesTheySee) {
  const CameraConfig camera;
  SurfaceCoverage coverage(cube_in_hall(), {{"camera", camera}}, RobotConfig());
  const auto from = [&](double x, double y, double yaw) {
    coverage.add_frame("camera", make_upright_pose(x, y, 0, to_radians(yaw)) * camera.mount.X_BC());
  };
  from(-0.9, 0, 180);  // looks away
  EXPECT_EQ(coverage.fraction(1), 0.0);
  from(-0.9, 0, 0);  // sees the side at x = -0.2 and the top, two of five
  EXPECT_NEAR(coverage.fraction(1), 0.4, 0.02);
  from(-0.9, 0, 0);
  EXPECT_NEAR(coverage.fraction(1), 0.4, 0.02);
  from(0.9, 0, 180);
  EXPECT_NEAR(coverage.fraction(1), 0.6, 0.02);
  from(0, 0.9, -90);
  from(0, -0.9, 90);
  EXPECT_NEAR(coverage.fraction(1), 1.0, 0.01);
  EXPECT_THROW(coverage.add_frame("other", Pose::Identity()), Error);
}

TEST(SurfaceCoverage, SaysWhatAFrameWouldAdd) {
  const CameraConfig camera;
  SurfaceCoverage coverage(cube_in_hall(), {{"camera", camera}}, RobotConfig());
  const auto pose = [&](double x, double y, double yaw) { return make_upright_pose(x, y, 0, to_radians(yaw)) * camera.mount.X_BC(); };
  EXPECT_EQ(coverage.would_add("camera", pose(-0.9, 0, 180), 1), 0.0) << "looks away";
  const double first = coverage.would_add("camera", pose(-0.9, 0, 0), 1);
  EXPECT_EQ(coverage.fraction(1), 0.0) << "nothing is added by asking";
  coverage.add_frame("camera", pose(-0.9, 0, 0));
  EXPECT_DOUBLE_EQ(coverage.fraction(1), first);
  EXPECT_EQ(coverage.would_add("camera", pose(-0.9, 0, 0), 1), 0.0) << "seen already";
  const double second = coverage.would_add("camera", pose(0.9, 0, 180), 1);
  EXPECT_NEAR(second, 0.2, 0.02) << "one more side";
  coverage.add_frame("camera", pose(0.9, 0, 180));
  EXPECT_NEAR(coverage.fraction(1), first + second, 1e-12);
  coverage.forget_frames();
  EXPECT_EQ(coverage.fraction(1), 0.0);
  EXPECT_DOUBLE_EQ(coverage.would_add("camera", pose(-0.9, 0, 0), 1), first);
  EXPECT_THROW(coverage.would_add("other", Pose::Identity(), 1), Error);
  EXPECT_THROW(coverage.would_add("camera", Pose::Identity(), 2), Error);
}

}  // namespace
}  // namespace waretwin

#include "harness/score/trajectory_file.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/files.h"
#include "tests/support/test_data.h"

namespace waretwin {
namespace {

class TrajectoryFile : public testing::Test {
 protected:
  Trajectory read(const std::string& text) {
    write_file(folder_.path() / "trajectory.tum", text);
    return read_trajectory(folder_.path() / "trajectory.tum");
  }
  test::TemporaryFolder folder_;
};

TEST_F(TrajectoryFile, KeepsStampsToTheNanosecond) {
  const Trajectory t = read("# stamp x y z qx qy qz qw\n1305031098.665900001 1 2 3 0 0 0 1\n\n1305031098.7 1 2 3 0 0 1 0\n");
  ASSERT_EQ(t.poses.size(), 2u);
  EXPECT_EQ(t.poses[0].stamp, 1305031098665900001);
  EXPECT_EQ(t.poses[1].stamp, 1305031098700000000);
  EXPECT_NEAR(rotation_between(t.poses[0].X_WB, t.poses[1].X_WB), 3.14159265, 1e-6);
}

TEST_F(TrajectoryFile, ReadsBackWhatItWrites) {
  const std::vector<StampedPose> poses = {{-1'500'000'001, make_upright_pose(1, 2, 3, 0.5)}, {40'000'000, make_upright_pose(-1, 0, 0, -3)}};
  const Trajectory t = read(tum_text(poses));
  ASSERT_EQ(t.poses.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(t.poses[i].stamp, poses[i].stamp);
    EXPECT_TRUE(t.poses[i].X_WB.isApprox(poses[i].X_WB, 1e-7));
  }
}

TEST_F(TrajectoryFile, ReadsKitti) {
  const Trajectory t = read("1 0 0 4 0 1 0 5 0 0 1 6\n");
  EXPECT_FALSE(t.has_stamps);
  EXPECT_EQ(t.poses[0].X_WB.translation(), Eigen::Vector3d(4, 5, 6));
}

TEST_F(TrajectoryFile, NamesTheLine) {
  for (const std::string bad :
       {"0 0 0 0 0 0 1\n", "x 0 0 0 0 0 0 1\n", "0.1 0 0 nan 0 0 0 1\n", "0 0 0 0 0 0 0 0\n", "-1 0 0 0 0 0 0 1\n"}) {
    try {
      read("0 0 0 0 0 0 0 1\n" + bad);
      FAIL() << bad;
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find(":2: "), std::string::npos) << e.what();
    }
  }
  EXPECT_THROW(read("# nothing\n"), Error);
  EXPECT_THROW(read("2 0 0 4 0 2 0 5 0 0 2 6\n"), Error) << "scaled matrix";
}

}  // namespace
}  // namespace waretwin

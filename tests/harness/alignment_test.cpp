#include "harness/score/alignment.h"

#include <gtest/gtest.h>

#include "harness/score/run_score.h"
#include "tests/harness/score_fixtures.h"

namespace waretwin {
namespace {

using test::object;

TEST(Alignment, UndoesAPlanarDrift) {
  const std::vector<ListedObject> truth = {object(1, "c", 2, 1, 10), object(2, "c", -3, 2, 80), object(3, "c", 0, -4, 130)};
  const Pose X_MT = make_upright_pose(0.12, -0.07, 0.0, to_radians(2.0));
  const ComparedLists compared = compare_lists(moved(truth, X_MT), truth);
  EXPECT_LT(*compared.plain.summary.mean_iou3d, 0.9);
  ASSERT_TRUE(compared.aligned.has_value());
  EXPECT_TRUE(compared.X_TM->isApprox(X_MT.inverse(), 1e-9));
  EXPECT_NEAR(*compared.aligned->summary.mean_iou3d, 1.0, 1e-6);
  EXPECT_NEAR(*compared.aligned->summary.mean_e_rot_deg, 0.0, 1e-6);
}

TEST(Alignment, LaysOnePairOverTheOtherByCentreAndYaw) {
  const std::vector<ListedObject> truth = {object(1, "c", 2, 1, 178)};
  const ComparedLists compared = compare_lists({object(5, "c", 2.2, 1.1, 3)}, truth);
  ASSERT_TRUE(compared.aligned.has_value());
  EXPECT_NEAR(to_degrees(yaw_of(*compared.X_TM)), -5.0, 1e-9);
  EXPECT_NEAR(*compared.aligned->summary.mean_iou3d, 1.0, 1e-6);
}

TEST(Alignment, LeavesHeightsAlone) {
  const std::vector<ListedObject> truth = {object(1, "c", 0, 0), object(2, "c", 5, 0)};
  std::vector<ListedObject> mapped = truth;
  for (ListedObject& m : mapped) m.cuboid.centre.z() += 0.1;
  const ComparedLists compared = compare_lists(mapped, truth);
  EXPECT_NEAR(*compared.aligned->summary.mean_e_trans_m, 0.1, 1e-9);
}

TEST(Alignment, NeedsAPairThatCounts) {
  std::vector<ListedObject> truth = {object(1, "c", 0, 0)};
  EXPECT_FALSE(compare_lists({}, truth).aligned.has_value());
  truth[0].visible_fraction = 0.1;
  EXPECT_FALSE(compare_lists({object(1, "c", 0.1, 0)}, truth).aligned.has_value());
}

}  // namespace
}  // namespace waretwin

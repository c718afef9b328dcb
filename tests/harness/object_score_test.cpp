#include "harness/score/object_score.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/harness/score_fixtures.h"

namespace waretwin {
namespace {

using test::object;

// Two boxes 2 x 1 x 1 that are shifted by s along their length share (2 - s) of (2 + s).
TEST(ObjectScore, ComparesAPairByHand) {
  const auto score = score_objects({object(7, "conveyor", 0.4, 0.0)}, {object(1, "conveyor", 0.0, 0.0)});
  ASSERT_EQ(score.objects.size(), 1u);
  EXPECT_EQ(score.objects[0].truth_id, 1);
  EXPECT_EQ(score.objects[0].map_id, 7);
  EXPECT_NEAR(score.objects[0].iou3d, 1.6 / 2.4, 1e-12);
  EXPECT_NEAR(*score.objects[0].e_trans_m, 0.4, 1e-12);
  EXPECT_NEAR(*score.objects[0].e_rot_deg, 0.0, 1e-9);
  EXPECT_EQ(score.summary.matched, 1);
  EXPECT_EQ(score.summary.recall, 1.0);
  EXPECT_EQ(score.summary.precision, 1.0);
}

TEST(ObjectScore, MatchesFromAnIouOfOneHalf) {
  // s = 2/3 gives exactly (4/3) / (8/3) = 0.5; a little more is below.
  const auto at = score_objects({object(1, "c", 0.66, 0.0)}, {object(1, "c", 0.0, 0.0)});
  EXPECT_EQ(at.summary.matched, 1);
  const auto below = score_objects({object(1, "c", 0.68, 0.0)}, {object(1, "c", 0.0, 0.0)});
  EXPECT_EQ(below.summary.matched, 0);
  EXPECT_EQ(below.objects[0].map_id, 1) << "still an assigned pair";
  EXPECT_TRUE(below.summary.mean_e_trans_m.has_value());
  EXPECT_EQ(below.summary.precision, 0.0);
}

TEST(ObjectScore, PairsOnlyWithinAClass) {
  const auto score = score_objects({object(1, "chair", 0.0, 0.0)}, {object(1, "conveyor", 0.0, 0.0)});
  EXPECT_FALSE(score.objects[0].map_id.has_value());
  EXPECT_EQ(score.summary.mapped, 0) << "the truth names no chairs";
  EXPECT_FALSE(score.summary.precision.has_value());
  EXPECT_EQ(score.summary.recall, 0.0);
}

TEST(ObjectScore, LeavesPairsWhoseCentresAreTooFarApart) {
  const Eigen::Vector3d large(8.0, 2.0, 1.0);
  const auto near = score_objects({object(1, "c", 0.99, 0.0, 0.0, large)}, {object(1, "c", 0.0, 0.0, 0.0, large)});
  EXPECT_TRUE(near.objects[0].map_id.has_value());
  const auto far = score_objects({object(1, "c", 1.0, 0.0, 0.0, large)}, {object(1, "c", 0.0, 0.0, 0.0, large)});
  EXPECT_FALSE(far.objects[0].map_id.has_value());
  EXPECT_EQ(far.objects[0].iou3d, 0.0);
}

TEST(ObjectScore, AssignsTheLargestTotalIou) {
  // Map 1 overlaps both truths, map 2 only truth 1. Greedy by IoU would leave truth 2 alone.
  const std::vector<ListedObject> truth = {object(1, "c", 0.0, 0.0), object(2, "c", 0.9, 0.0)};
  const std::vector<ListedObject> mapped = {object(1, "c", 0.3, 0.0), object(2, "c", -0.4, 0.0)};
  const auto score = score_objects(mapped, truth);
  EXPECT_EQ(score.objects[0].map_id, 2);
  EXPECT_EQ(score.objects[1].map_id, 1);
}

TEST(ObjectScore, CountsAnUnassignedObjectAsZeroInTheMeanIouAndNotInTheErrors) {
  const auto score = score_objects({object(1, "c", 0.4, 0.0)}, {object(1, "c", 0.0, 0.0), object(2, "c", 5.0, 0.0)});
  EXPECT_NEAR(*score.summary.mean_iou3d, 0.5 * 1.6 / 2.4, 1e-12);
  EXPECT_NEAR(*score.summary.mean_e_trans_m, 0.4, 1e-12);
  EXPECT_EQ(score.summary.recall, 0.5);
  EXPECT_FALSE(score.objects[1].e_trans_m.has_value());
}

TEST(ObjectScore, NamesFalsePositives) {
  const auto score =
      score_objects({object(4, "c", 0.1, 0.0), object(3, "c", 0.3, 0.0), object(9, "c", 5.0, 0.0), object(7, "other", 0.0, 0.0)},
                    {object(1, "c", 0.0, 0.0)});
  EXPECT_EQ(score.objects[0].map_id, 4);
  EXPECT_EQ(score.false_positives, (std::vector<int>{3, 9})) << "a second box on a true object is one, another class is not";
}

TEST(ObjectScore, LeavesOutWhatWasHardlySeen) {
  std::vector<ListedObject> truth = {object(1, "c", 0.0, 0.0), object(2, "c", 5.0, 0.0)};
  truth[1].visible_fraction = 0.59;
  const auto missed = score_objects({object(1, "c", 0.0, 0.0)}, truth);
  EXPECT_EQ(missed.summary.truth, 1) << "no miss";
  EXPECT_EQ(missed.summary.recall, 1.0);
  const auto mapped = score_objects({object(1, "c", 0.0, 0.0), object(2, "c", 5.5, 0.0)}, truth);
  EXPECT_EQ(mapped.summary.mapped, 1) << "no false positive";
  EXPECT_EQ(mapped.summary.precision, 1.0);
  EXPECT_NEAR(*mapped.summary.mean_e_trans_m, 0.0, 1e-12);
  EXPECT_EQ(mapped.objects[1].map_id, 2);
  EXPECT_FALSE(mapped.objects[1].counted);
  truth[1].visible_fraction = 0.6;
  EXPECT_EQ(score_objects({object(1, "c", 0.0, 0.0)}, truth).summary.truth, 2);
}

TEST(ObjectScore, MeasuresYawModuloHalfATurn) {
  const auto score = score_objects({object(1, "c", 0.0, 0.0, 177.0)}, {object(1, "c", 0.0, 0.0, 2.0)});
  EXPECT_NEAR(*score.objects[0].e_rot_deg, 5.0, 1e-9);
}

TEST(ObjectScore, MeasuresYawOfSquareBoxesModuloAQuarterTurn) {
  const auto square = score_objects({object(1, "c", 0, 0, 93.0, {1.09, 1.0, 1.0})}, {object(1, "c", 0, 0, 0.0, {1.09, 1.0, 1.0})});
  EXPECT_NEAR(*square.objects[0].e_rot_deg, 3.0, 1e-9);
  const auto oblong = score_objects({object(1, "c", 0, 0, 93.0, {1.11, 1.0, 1.0})}, {object(1, "c", 0, 0, 0.0, {1.11, 1.0, 1.0})});
  EXPECT_NEAR(*oblong.objects[0].e_rot_deg, 87.0, 1e-9);
}

TEST(ObjectScore, AveragesThePapersPrecisionOverClasses) {
  // Conveyors: 1 right of 2. Racks: 1 right of 1. Shelves: none mapped.
  const std::vector<ListedObject> truth = {object(1, "conveyor", 0, 0), object(2, "rack", 5, 0), object(3, "shelf", 9, 0)};
  const std::vector<ListedObject> mapped = {object(1, "conveyor", 0, 0), object(2, "conveyor", 20, 0), object(3, "rack", 5, 0)};
  const auto score = score_objects(mapped, truth);
  EXPECT_NEAR(*score.summary.map_paper, (0.5 + 1.0 + 0.0) / 3.0, 1e-12);
  EXPECT_NEAR(*score.summary.precision, 2.0 / 3.0, 1e-12);
}

TEST(ObjectScore, IntegratesThePrecisionRecallCurve) {
  // Ranked: hit, miss, hit of three true objects. Curve (1/3, 1), (1/3, 1/2), (2/3, 2/3): area 1/3 * 1 + 1/3 * 2/3 = 5/9.
  const std::vector<ListedObject> truth = {object(1, "c", 0, 0), object(2, "c", 5, 0), object(3, "c", 9, 0)};
  std::vector<ListedObject> mapped = {object(1, "c", 0, 0), object(2, "c", 20, 0), object(3, "c", 5, 0)};
  mapped[0].score = 0.9;
  mapped[1].score = 0.8;
  mapped[2].score = 0.7;
  EXPECT_NEAR(*score_objects(mapped, truth).summary.ap50, 5.0 / 9.0, 1e-12);
}

TEST(ObjectScore, GivesEqualScoresNoOrder) {
  // Hit and miss enter together: one point (1/2, 1/2), whatever the order of the list.
  const std::vector<ListedObject> truth = {object(1, "c", 0, 0), object(2, "c", 5, 0)};
  const ListedObject hit = object(1, "c", 0, 0), miss = object(2, "c", 20, 0);
  EXPECT_NEAR(*score_objects({hit, miss}, truth).summary.ap50, 0.25, 1e-12);
  EXPECT_NEAR(*score_objects({miss, hit}, truth).summary.ap50, 0.25, 1e-12);
}

TEST(ObjectScore, SaysNothingAboutAnEmptyTruth) {
  const auto score = score_objects({object(1, "c", 0, 0)}, {});
  EXPECT_EQ(score.summary.truth, 0);
  EXPECT_FALSE(score.summary.recall || score.summary.precision || score.summary.mean_iou3d || score.summary.ap50);
}

TEST(ObjectScore, RefusesDifferentFrames) {
  ListedObject elsewhere = object(1, "c", 0, 0);
  elsewhere.cuboid.frame = "map";
  EXPECT_THROW(score_objects({elsewhere}, {object(1, "c", 0, 0)}), Error);
}

}  // namespace
}  // namespace waretwin

#include <gtest/gtest.h>

#include <algorithm>

#include "mapper/associate/part_choice.h"
#include "tests/mapper/traced_frame.h"

namespace waretwin {
namespace {

using Chosen = std::vector<std::size_t>;

// Parts as they are shown in one view in which the object's box is 100 x 100 pixels.
class ChooseParts : public ::testing::Test {
 protected:
  ChooseParts() { views_.add({Pose::Identity(), Intrinsics::checked(640, 480, 500, 500, 320, 240), {100, 100, 100, 100}}); }

  // `at`: of its only cell, metres.
  std::size_t add(const cv::Rect2f& shown, double at, double share = 1.0, double hits = 100.0) {
    parts_.push_back({{Eigen::Vector3f(static_cast<float>(at), 0, 0)}, hits, share, {shown}});
    return parts_.size() - 1;
  }
  Chosen choose() const {
    Chosen chosen = choose_parts(parts_, views_, config_);
    std::sort(chosen.begin(), chosen.end());
    return chosen;
  }

  EvidenceConfig config_;
  BoxViews views_{8};
  std::vector<EvidencePart> parts_;
};

TEST_F(ChooseParts, TakesWhatMatchesNotWhatHasMostHits) {
  add({0, 100, 400, 100}, 0.0, 1.0, 5000.0);
  const std::size_t object = add({102, 101, 96, 98}, 0.1);
  EXPECT_EQ(choose(), Chosen{object});
}

TEST_F(ChooseParts, JoinsPostsThatTouchNowhere) {
  const std::size_t left = add({100, 100, 10, 100}, 0.0), right = add({190, 100, 10, 100}, 0.1);
  EXPECT_EQ(choose(), (Chosen{left, right}));
}

TEST_F(ChooseParts, LeavesOutWhatTheBoxDoesNotNeed) {
  // A bottle beside it, inside its box; tried first or not, it stays out.
  add({120, 190, 8, 10}, 0.06);
  const std::size_t object = add({100, 100, 100, 100}, 0.1);
  add({160, 150, 8, 10}, 0.06);
  EXPECT_EQ(choose(), Chosen{object});
}

TEST_F(ChooseParts, LeavesOutPiecesOfAWall) {
  const std::size_t object = add({100, 100, 100, 70}, 0.1);
  add({100, 150, 100, 50}, 0.2, 0.3);
  EXPECT_EQ(choose(), Chosen{object});
  // All of it seen inside the box it would have joined.
  parts_.back().share = 1.0;
  EXPECT_EQ(choose().size(), 2u);
}

TEST_F(ChooseParts, JoinsNothingFarAway) {
  const double far = config_.bridge_m + 0.05;
  const std::size_t object = add({100, 100, 100, 70}, 0.0);
  add({100, 150, 100, 50}, far);
  EXPECT_EQ(choose(), Chosen{object});
}

TEST_F(ChooseParts, WithoutBoxesTheMostHitsDecide) {
  add({100, 100, 100, 100}, 0.0, 1.0, 10.0);
  const std::size_t most = add({}, 0.1, 0.2, 20.0);
  EXPECT_EQ(choose_parts(parts_, BoxViews(0), config_), Chosen{most});
}

}  // namespace
}  // namespace waretwin

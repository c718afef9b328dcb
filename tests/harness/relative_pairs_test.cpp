#include "harness/score/relative_pairs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/config.h"
#include "core/error.h"
#include "core/random.h"

namespace waretwin {
namespace {

using Pairs = std::vector<PosePair>;

TrajectoryRules rules(const std::string& unit, double delta, const std::string& pairs, double tolerance = 0.1) {
  TrajectoryRules rules;
  rules.rpe_unit = unit;
  rules.rpe_delta = delta;
  rules.rpe_pairs = pairs;
  rules.rpe_tolerance = tolerance;
  return rules;
}

struct Drive {
  std::vector<Pose> poses;
  std::vector<Stamp> stamps;
  Pairs pairs(const TrajectoryRules& rules) const { return relative_pairs(poses, stamps, rules); }
};

// Along x at the given places, turned by 10 deg more at each, a pose every 0.1 s.
Drive along(const std::vector<double>& places) {
  Drive drive;
  for (std::size_t i = 0; i < places.size(); ++i) {
    drive.poses.push_back(make_upright_pose(places[i], 0, 0, to_radians(10.0 * static_cast<double>(i))));
    drive.stamps.push_back(static_cast<Stamp>(i) * 100'000'000);
  }
  return drive;
}

TEST(RelativePairs, CountsFrames) {
  const Drive drive = along({0, 1, 2, 3, 4, 5});
  EXPECT_EQ(drive.pairs(rules("frames", 2, "consecutive")), (Pairs{{0, 2}, {2, 4}}));
  EXPECT_EQ(drive.pairs(rules("frames", 2, "all")), (Pairs{{0, 2}, {1, 3}, {2, 4}, {3, 5}}));
  EXPECT_TRUE(drive.pairs(rules("frames", 6, "all")).empty());
  EXPECT_TRUE(drive.pairs(rules("frames", 1e9, "consecutive")).empty());
}

TEST(RelativePairs, FollowsThePathInMetres) {
  const Drive drive = along({0, 0.5, 1.0, 1.5, 2.5, 3.0, 3.0, 4.0});
  // The path reaches 1 m at pose 2, and 1 m more at 4, 7; as in evo the pose at the start is not chosen.
  EXPECT_EQ(drive.pairs(rules("metres", 1, "consecutive")), (Pairs{{2, 4}, {4, 7}}));
  EXPECT_EQ(drive.pairs(rules("metres", 1, "all", 0)), (Pairs{{0, 2}, {1, 3}, {3, 4}, {5, 7}, {6, 7}}));
  // From pose 2 both 0.5 m and 1.5 m are off by a half: the nearer one on the path comes first. From pose 4 the place at 3.0 m counts by
  // the first pose that stands there.
  EXPECT_EQ(drive.pairs(rules("metres", 1, "all", 0.5)), (Pairs{{0, 2}, {1, 3}, {2, 3}, {3, 4}, {4, 5}, {5, 7}, {6, 7}}));
}

TEST(RelativePairs, CountsThereAndBackAsPath) {
  EXPECT_EQ(along({0, 1, 0, 1}).pairs(rules("metres", 2, "all", 0)), (Pairs{{0, 2}, {1, 3}}));
}

TEST(RelativePairs, AddsUpTurns) {
  const Drive drive = along({0, 0, 0, 0, 0, 0});
  EXPECT_EQ(drive.pairs(rules("degrees", 19.9, "consecutive")), (Pairs{{0, 2}, {2, 4}})) << "the start is chosen";
  EXPECT_EQ(drive.pairs(rules("degrees", 20, "all")), (Pairs{{0, 2}, {1, 3}, {2, 4}, {3, 5}}));
  // Turned there and back, the orientation is the same: nothing for all pairs, while the turns add up for consecutive ones.
  Drive back;
  for (const double yaw : {0.0, 0.3, 0.0, 0.3, 0.0}) back.poses.push_back(make_upright_pose(0, 0, 0, yaw));
  EXPECT_TRUE(back.pairs(rules("degrees", to_degrees(0.59), "all", 0.01)).empty());
  EXPECT_EQ(back.pairs(rules("degrees", to_degrees(0.59), "consecutive")), (Pairs{{0, 2}, {2, 4}}));
}

TEST(RelativePairs, CountsSecondsExactly) {
  Drive drive = along(std::vector<double>(31, 0.0));
  // Ten steps of 0.1 s are 1 s, however they are added up, and far from the origin of time, too.
  for (Stamp& stamp : drive.stamps) stamp += 1'305'031'098'665'900'000;
  EXPECT_EQ(drive.pairs(rules("seconds", 1, "consecutive")), (Pairs{{0, 10}, {10, 20}, {20, 30}}));
  const Pairs all = drive.pairs(rules("seconds", 1, "all", 0));
  ASSERT_EQ(all.size(), 21u);
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(all[i], (PosePair{i, i + 10}));
}

TEST(RelativePairs, OfOnePoseAreNone) {
  for (const char* unit : {"frames", "metres", "degrees", "seconds"}) {
    for (const char* pairs : {"consecutive", "all"}) EXPECT_TRUE(along({0}).pairs(rules(unit, 1, pairs)).empty()) << unit;
  }
}

// Every later pose is looked at, the first of the best is taken.
Pairs slow_nearest(const Drive& drive, double delta, double tolerance) {
  Pairs pairs;
  for (std::size_t i = 0; i < drive.poses.size(); ++i) {
    double path = 0.0, least = std::numeric_limits<double>::infinity();
    std::size_t best = 0;
    for (std::size_t j = i + 1; j < drive.poses.size(); ++j) {
      path += (drive.poses[j].translation() - drive.poses[j - 1].translation()).norm();
      if (std::abs(path - delta) < least) {
        least = std::abs(path - delta);
        best = j;
      }
    }
    if (least <= tolerance) pairs.push_back({i, best});
  }
  return pairs;
}

TEST(RelativePairs, AgreesWithASlowSearch) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const RandomStream random(seed, "pairs", "walk");
    Drive drive;
    Eigen::Vector3d place = Eigen::Vector3d::Zero();
    for (std::uint64_t i = 0; i < 80; ++i) {
      // Steps of eighths add up exactly, so that ties are ties; every third step the robot stands.
      place.x() += i % 3 == 0 ? 0.0 : std::round(8.0 * random.normal(i)) / 8.0;
      drive.poses.push_back(make_upright_pose(place.x(), 0, 0, 0));
      drive.stamps.push_back(static_cast<Stamp>(i));
    }
    for (const double delta : {0.125, 1.0, 1.3, 5.0, 20.0}) {
      EXPECT_EQ(drive.pairs(rules("metres", delta, "all", 0.25)), slow_nearest(drive, delta, 0.25 * delta)) << seed << " " << delta;
    }
  }
}

TEST(RelativePairs, RefusesDeltasThatMakeNoSense) {
  const auto refuses = [](const std::vector<Setting>& settings, const std::string& text) {
    TrajectoryRules rules;
    try {
      apply_settings(settings, [&](Fields& f) { rules.visit(f); });
      ADD_FAILURE() << text;
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find(text), std::string::npos) << e.what();
    }
  };
  refuses({{"rpe_delta", "0.5"}}, "0.5 frames");
  refuses({{"rpe_delta", "0"}}, "rpe_delta");
  refuses({{"rpe_delta", "-1"}, {"rpe_unit", "metres"}}, "rpe_delta");
  refuses({{"rpe_delta", "200"}, {"rpe_unit", "degrees"}}, "180");
  refuses({{"rpe_unit", "miles"}}, "metres");
  refuses({{"rpe_deltas", "1"}}, "rpe_delta");
  TrajectoryRules rules;
  apply_settings({{"rpe_delta", "0.5"}, {"rpe_unit", "metres"}}, [&](Fields& f) { rules.visit(f); });
  EXPECT_EQ(rules.rpe_delta, 0.5);
}

}  // namespace
}  // namespace waretwin

// What is concluded from a study's runs, held against published values and slow references.
#include "harness/study/study_results.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/dice.h"
#include "harness/study/main_effects.h"

namespace waretwin {
namespace {

TEST(Interval, IsStudents) {
  // Mean 3, standard deviation sqrt(2.5), t(0.975, 4) = 2.776445 (any table).
  const auto interval = mean_interval({1, 2, 3, 4, 5}, 0.95);
  ASSERT_TRUE(interval && interval->low);
  EXPECT_DOUBLE_EQ(interval->mean, 3.0);
  EXPECT_NEAR(*interval->high - 3.0, 2.776445 * std::sqrt(2.5 / 5.0), 1e-6);
  EXPECT_NEAR(*interval->low + *interval->high, 6.0, 1e-12);
  EXPECT_FALSE(mean_interval({4}, 0.95)->low);
  EXPECT_FALSE(mean_interval({}, 0.95));
}

TEST(Interval, HoldsTheTruthAsOftenAsItSays) {
  int holds = 0;
  constexpr int kTrials = 4000;
  for (int trial = 0; trial < kTrials; ++trial) {
    Dice dice(RandomStream(1, "test", "interval", trial));
    std::vector<double> values;
    for (int i = 0; i < 4; ++i) values.push_back(10.0 + dice.normal());
    const auto interval = mean_interval(values, 0.9);
    holds += *interval->low <= 10.0 && 10.0 <= *interval->high ? 1 : 0;
  }
  EXPECT_NEAR(holds / static_cast<double>(kTrials), 0.9, 4 * std::sqrt(0.09 / kTrials));
}

TEST(MainEffects, TellFactorsApartThatVaryTogether) {
  // value = 10 a + b; high levels of a come mostly with high levels of b, which plain means would mix up.
  std::vector<LevelledValue> values;
  for (const auto& [a, b] : {std::pair{0, 0}, {0, 0}, {0, 1}, {1, 1}, {1, 1}, {1, 2}, {2, 2}, {2, 2}, {2, 0}})
    values.push_back({{static_cast<std::size_t>(a), static_cast<std::size_t>(b)}, 10.0 * a + b});
  const auto effects = main_effects(values, {3, 3}, 0.95);
  for (std::size_t level = 0; level < 3; ++level) {
    EXPECT_NEAR(effects[0][level]->mean, 10.0 * static_cast<double>(level) + 1.0, 1e-9);
    EXPECT_NEAR(effects[1][level]->mean, static_cast<double>(level) + 10.0, 1e-9);
    EXPECT_NEAR(*effects[0][level]->high - *effects[0][level]->low, 0.0, 1e-6);  // nothing is left unexplained
    EXPECT_EQ(effects[0][level]->count, 3);
  }
}

TEST(MainEffects, OfWhatCannotBeToldApartArePlainMeans) {
  const auto effects = main_effects({{{0, 0}, 1.0}, {{1, 1}, 3.0}, {{1, 1}, 4.0}},
                                    {
                                        2,
                                        2,
                                    },
                                    0.95);
  EXPECT_DOUBLE_EQ(effects[0][1]->mean, 3.5);
  EXPECT_FALSE(effects[0][1]->low);
  const auto missing = main_effects({{{0}, 1.0}, {{2}, 3.0}, {{2}, 5.0}}, {3}, 0.95);
  EXPECT_FALSE(missing[0][1]);
  EXPECT_DOUBLE_EQ(missing[0][2]->mean, 4.0);
}

StudyConfig two_factors() {
  StudyConfig study;
  study.vary["height"].key = "h";
  study.vary["pitch"].key = "p";
  study.judge.measures = {"mean_iou3d", "floor_coverage", "mean_e_trans_m"};
  return study;
}

StudyValues values_of(std::initializer_list<std::pair<const char*, double>> list) {
  StudyValues values(study_measures().size());
  for (const auto& [name, value] : list) values[*study_measure(name)] = value;
  return values;
}

CandidateResult candidate(int number, const DesignPoint& values, double floor, const std::vector<double>& ious) {
  CandidateResult one;
  one.number = number;
  one.name = "c" + std::to_string(number);
  one.values = values;
  one.halls["hall"] = values_of({{"floor_coverage", floor}});
  std::uint64_t seed = 1;
  for (const double iou : ious) one.runs.push_back({"hall", seed++, "d", "", values_of({{"mean_iou3d", iou}})});
  return one;
}

TEST(StudyResults, DifferencesArePairedSeedBySeed) {
  // The seeds scatter by 0.1, the candidates differ by 0.02 with every one of them.
  const StudyResults results = judged_study(
      two_factors(), {candidate(0, {"1.4", "45"}, 0.7, {0.70, 0.80, 0.90}), candidate(1, {"1.2", "30"}, 0.8, {0.72, 0.82, 0.921})});
  const std::size_t iou = *study_measure("mean_iou3d"), floor = *study_measure("floor_coverage");
  const CandidateResult& better = results.candidates[1];
  EXPECT_NEAR(better.difference[iou]->mean, 0.061 / 3, 1e-12);
  EXPECT_GT(*better.difference[iou]->low, 0.018);  // sure, although the seeds scatter more than that
  EXPECT_LT(*better.measured[iou]->low, 0.6);
  EXPECT_FALSE(results.candidates[0].difference[iou]);
  // Coverage is the same for every seed: one value a hall, which says nothing of its scatter.
  EXPECT_EQ(better.measured[floor]->count, 1);
  EXPECT_FALSE(better.measured[floor]->low);
  EXPECT_EQ(results.best, 1u);
}

TEST(StudyResults, ADriveThatOneOfThemLacksIsNotPaired) {
  CandidateResult broken = candidate(1, {"1.2", "30"}, 0.8, {0.9, 0.9});
  broken.runs[1].error = "the disk was full";
  const StudyResults results = judged_study(two_factors(), {candidate(0, {"1.4", "45"}, 0.7, {0.70, 0.90}), broken});
  EXPECT_EQ(results.candidates[1].difference[*study_measure("mean_iou3d")]->count, 1);
  EXPECT_FALSE(results.candidates[1].feasible());
  EXPECT_EQ(results.best, 0u);
}

TEST(StudyResults, WhoHasNoValueWhereOthersHaveOneIsNotBetter) {
  StudyConfig study = two_factors();
  study.judge.best_by = "mean_e_trans_m";
  study.judge.pareto = {"mean_e_trans_m", "floor_coverage"};
  study.constraints = {"mean_e_trans_m < 0.05"};
  const auto with = [](int number, std::initializer_list<double> errors) {
    CandidateResult one = candidate(number, {std::to_string(number), "45"}, 0.7, {0.5, 0.5});
    std::size_t k = 0;
    for (const double error : errors) one.runs[k++].values[*study_measure("mean_e_trans_m")] = error;
    return one;
  };
  const StudyResults results = judged_study(study, {with(0, {0.03, 0.04}), with(1, {0.001})});
  EXPECT_EQ(results.best, 0u);
  EXPECT_FALSE(results.candidates[1].on_front);
  EXPECT_EQ(results.candidates[1].broken, std::vector<std::string>{"mean_e_trans_m < 0.05 does not hold: it has no value in every drive"});
}

TEST(StudyResults, WhatWasNotDrivenIsNotOnAFrontOfWhatWas) {
  StudyConfig study = two_factors();
  study.judge.pareto = {"floor_coverage", "blind_floor"};
  CandidateResult seen = candidate(1, {"1", "45"}, 0.99, {});
  seen.state = CandidateState::kScreenedOut;
  CandidateResult driven = candidate(0, {"1.4", "45"}, 0.7, {0.9});
  for (CandidateResult* one : {&seen, &driven}) one->halls["hall"][*study_measure("blind_floor")] = 0.5;
  const StudyResults results = judged_study(study, {driven, seen});
  EXPECT_TRUE(results.candidates[0].on_front);
  EXPECT_FALSE(results.candidates[1].on_front);
}

TEST(StudyResults, TheFrontIsWhatNothingDominates) {
  std::vector<CandidateResult> candidates;
  Dice dice(RandomStream(5, "test", "front"));
  for (int i = 0; i < 60; ++i) {
    const double floor = std::round(dice.between(0, 10)) / 10, iou = std::round(dice.between(0, 10)) / 10;  // with ties
    candidates.push_back(candidate(i, {std::to_string(i), "1"}, floor, {iou}));
  }
  const StudyResults results = judged_study(two_factors(), candidates);
  int front = 0;
  for (const CandidateResult& one : results.candidates) {
    const auto at = [](const CandidateResult& c) {
      return std::pair(*c.halls.at("hall")[*study_measure("floor_coverage")], *c.runs[0].values[*study_measure("mean_iou3d")]);
    };
    bool dominated = false;
    for (const CandidateResult& other : results.candidates) {
      const auto [a, b] = at(other);
      const auto [x, y] = at(one);
      dominated = dominated || (a >= x && b >= y && (a > x || b > y));
    }
    EXPECT_EQ(one.on_front, !dominated) << one.name;
    front += one.on_front ? 1 : 0;
  }
  EXPECT_GT(front, 0);
}

TEST(StudyResults, WhoBreaksAConstraintIsNotTheBest) {
  StudyConfig study = two_factors();
  study.constraints = {"height < 1.6", "floor_coverage >= 0.5", "mean_iou3d > 0.1"};
  EXPECT_EQ(broken_by_values(study, {"1.6", "45"}), "height < 1.6 does not hold: 1.6");
  EXPECT_FALSE(broken_by_values(study, {"1.5", "45"}));
  CandidateResult high = candidate(1, {"1.7", "45"}, 0.9, {0.99});
  high.broken.push_back(*broken_by_values(study, high.values));
  const StudyResults results =
      judged_study(study, {candidate(0, {"1.4", "45"}, 0.7, {0.05}), high, candidate(2, {"1.2", "45"}, 0.6, {0.9})});
  EXPECT_EQ(results.best, 2u);
  EXPECT_EQ(results.candidates[0].broken, std::vector<std::string>{"mean_iou3d > 0.1 does not hold: 0.05"});
  EXPECT_FALSE(results.candidates[1].on_front);
}

TEST(StudyResults, WhatIsEqualIsToldApartByTheNextMeasure) {
  const StudyResults results = judged_study(two_factors(), {candidate(0, {"1.4", "45"}, 0.7, {0.9}), candidate(1, {"1", "45"}, 0.8, {0.9}),
                                                            candidate(2, {"1", "30"}, 0.8, {0.9})});
  EXPECT_EQ(results.best, 1u);
}

TEST(StudyResults, NumbersOfManyLevelsAreBinned) {
  std::vector<CandidateResult> candidates = {candidate(0, {"9", "9"}, 0, {0.0})};
  for (int i = 0; i < 40; ++i) candidates.push_back(candidate(i + 1, {std::to_string(i), i % 2 != 0 ? "1" : "2"}, 0, {i * 0.01}));
  const StudyResults results = judged_study(two_factors(), candidates);
  ASSERT_FALSE(results.effects.empty());
  const FactorEffect& height = results.effects.front();
  EXPECT_EQ(height.factor, "height");
  ASSERT_EQ(height.levels.size(), 4u);
  EXPECT_EQ(height.levels[0].level, "0 to 9");
  EXPECT_NEAR(height.range(), 0.3, 0.01);
}

}  // namespace
}  // namespace waretwin

// Which points a study looks at, and what its file can say.
#include <gtest/gtest.h>

#include <set>

#include "core/error.h"
#include "core/files.h"
#include "harness/study/condition.h"
#include "harness/study/design.h"
#include "tests/support/expect_error.h"
#include "tests/support/test_data.h"

namespace waretwin {
namespace {

StudyConfig study_of(const std::string& rest) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "study.yaml";
  write_file(file, "study:\n  halls: {a: {scenario: a.yaml}}\n" + rest);
  return read_study(file);
}

std::string two_ranges(const std::string& design) {
  return "  design: " + design + "\n  vary: {h: {key: a.h, from: 1, to: 2}, p: {key: a.p, from: 10, to: 50}}\n";
}

TEST(StudyDesign, AGridHasEveryCombinationTheFirstFactorSlowest) {
  const auto points =
      design_points(study_of("  vary: {h: {key: a.h, from: 0.8, to: 1.6, steps: 3}, m: {key: a.m, values: [nfov, wfov]}}\n"));
  const std::vector<DesignPoint> expected = {{"0.8", "nfov"}, {"0.8", "wfov"}, {"1.2", "nfov"},
                                             {"1.2", "wfov"}, {"1.6", "nfov"}, {"1.6", "wfov"}};
  EXPECT_EQ(points, expected);
}

TEST(StudyDesign, RangesAreRoundedByTheirSize) {
  const auto small = design_points(study_of("  design: sobol\n  points: 40\n  vary: {s: {key: a.s, from: 0.0014, to: 0.002}}\n"));
  EXPECT_EQ(small.size(), 40u);
  for (const DesignPoint& point : small) EXPECT_TRUE(*as_number(point[0]) >= 0.0014 && *as_number(point[0]) <= 0.002) << point[0];
  const auto whole = design_points(study_of("  vary: {b: {key: a.b, from: 100000, to: 300000, steps: 3, multiple_of: 1}}\n"));
  const std::vector<DesignPoint> expected = {{"100000"}, {"200000"}, {"300000"}};
  EXPECT_EQ(whole, expected);
}

TEST(StudyDesign, AListPairsValuesAndKnowsRepetitions) {
  const auto points =
      design_points(study_of("  design: list\n  vary: {h: {key: a.h, values: [1, 1.50, 1.0]}, p: {key: a.p, values: [30, 40, 30]}}\n"));
  const std::vector<DesignPoint> expected = {{"1", "30"}, {"1.5", "40"}};
  EXPECT_EQ(points, expected);
}

TEST(StudyDesign, SobolPointsAreEvenlySpread) {
  const auto points = design_points(study_of(two_ranges("sobol") + "  points: 64\n"));
  ASSERT_GE(points.size(), 63u);
  // Each of 4 x 4 equal parts of the space gets a sixteenth of them, but for one at an edge.
  std::map<std::pair<int, int>, int> parts;
  for (const DesignPoint& point : points) {
    const double h = *as_number(point[0]), p = *as_number(point[1]);
    ASSERT_TRUE(h >= 1 && h <= 2 && p >= 10 && p <= 50);
    ++parts[{static_cast<int>((h - 1) * 3.9999), static_cast<int>((p - 10) / 40 * 3.9999)}];
  }
  ASSERT_EQ(parts.size(), 16u);
  for (const auto& [part, count] : parts) EXPECT_NEAR(count, 4, 1) << part.first << ", " << part.second;
}

TEST(StudyDesign, RandomPointsAreTheSameAgainAndGrowAtTheEnd) {
  const auto few = design_points(study_of(two_ranges("random") + "  points: 10\n"));
  const auto many = design_points(study_of(two_ranges("random") + "  points: 200\n"));
  const auto others = design_points(study_of(two_ranges("random") + "  points: 10\n  design_seed: 2\n"));
  ASSERT_EQ(few.size(), 10u);
  for (std::size_t i = 0; i < few.size(); ++i) EXPECT_EQ(few[i], many[i]);
  EXPECT_NE(few, others);
  double mean = 0.0;
  for (const DesignPoint& point : many) mean += *as_number(point[0]) / static_cast<double>(many.size());
  EXPECT_NEAR(mean, 1.5, 4 * 0.289 / std::sqrt(200.0));  // four standard deviations of a uniform mean
}

TEST(StudyDesign, FilesThatSayTooLittleOrTheWrongThing) {
  const std::string good = "  vary: {h: {key: a.h, values: [1]}}\n";
  EXPECT_NO_THROW(study_of(good));
  EXPECT_ERROR(study_of("  vary: {}\n"), "study.yaml", "vary", "at least one factor");
  EXPECT_ERROR(study_of("  vary: {h: {key: a.h}}\n"), "values", "expected either values, or from and to");
  EXPECT_ERROR(study_of("  vary: {h: {key: a.h, from: 2, to: 1}}\n"), "expected from < to");
  EXPECT_ERROR(study_of("  vary: {h: {key: a.h, from: 2}}\n"), "expected from and to");
  EXPECT_ERROR(study_of("  vary: {h: {key: seed, values: [1, 2]}}\n"), "seeds under `seeds`");
  EXPECT_ERROR(study_of("  vary: {state: {key: a.h, values: [1, 2]}}\n"), "is a column");
  EXPECT_ERROR(study_of("  vary: {m: {key: a.m, values: [nfov, wfov]}}\n  constraints: [m < 2]\n"), "has words for values");
  EXPECT_ERROR(study_of("  vary: {recall: {key: a.h, values: [1]}}\n"), "is a measure's name");
  EXPECT_ERROR(study_of("  vary: {'a b': {key: a.h, values: [1]}}\n"), "letters, digits");
  EXPECT_ERROR(study_of("  design: list\n  vary: {h: {key: a.h, values: [1, 2]}, p: {key: a.p, values: [1]}}\n"), "side by side");
  EXPECT_ERROR(study_of("  design: list\n  vary: {h: {key: a.h, from: 1, to: 2}}\n"), "is a range");
  EXPECT_ERROR(study_of(good + "  judge: {best_by: beauty}\n"), "best_by", "'beauty'", "mean_iou3d");
  EXPECT_ERROR(study_of(good + "  judge: {pareto: [recall]}\n"), "at least two");
  EXPECT_ERROR(study_of(good + "  screen: {by: recall}\n"), "is no measure of coverage");
  EXPECT_ERROR(study_of(good + "  constraints: [w < 1]\n"), "'w' is neither a factor nor a measure");
  EXPECT_ERROR(study_of(good + "  constraints: [h less than 1]\n"), "expected NAME OP VALUE");
  EXPECT_ERROR(study_of(good + "  seeds: [1, 1]\n"), "twice");
  EXPECT_ERROR(study_of(good + "  seeds: [1.5]\n"), "whole numbers");
  EXPECT_ERROR(study_of(good + "  desing: grid\n"), "design");
}

TEST(StudyCondition, HoldsForNumbersAndWords) {
  const auto holds = [](const std::string& text, const std::string& value) { return Condition::parse(text).holds(std::optional(value)); };
  EXPECT_TRUE(holds("h < 1.6", "1.59"));
  EXPECT_FALSE(holds("h<1.6", "1.6"));
  EXPECT_TRUE(holds("h <= 1.6", "1.60"));
  EXPECT_TRUE(holds("h != 2", "1"));
  EXPECT_TRUE(holds("mode == nfov", "nfov"));
  EXPECT_FALSE(holds("mode != nfov", "nfov"));
  EXPECT_FALSE(holds("h > 1", "tall"));
  EXPECT_FALSE(Condition::parse("recall > 0.5").holds(std::optional<double>()));
  for (const char* text : {"h", "h = 1", "h < x", "< 1", "h <", "h ! 1", "1 < h < 2"}) EXPECT_THROW(Condition::parse(text), Error) << text;
}

}  // namespace
}  // namespace waretwin

#include "harness/score/table6.h"

#include <gtest/gtest.h>

#include "tests/harness/score_fixtures.h"

namespace waretwin {
namespace {

using test::object;

TEST(Table6, ShowsOursAlignedAndThePapersRows) {
  const std::string text = table6(compare_lists({object(5, "c", 0.4, 0)}, {object(1, "c", 0, 0), object(2, "c", 9, 0)}), "hall");
  EXPECT_NE(text.find("| 1 | 5 | 0.6667 | 0.400 | 0.0 | 1.00 |"), std::string::npos) << text;
  EXPECT_NE(text.find("| 2 | - | 0.0000 | - | - | 1.00 |"), std::string::npos) << text;
  EXPECT_NE(text.find("| Average | | 0.3333 | 0.400 | 0.0 | |"), std::string::npos) << text;
  EXPECT_NE(text.find("| 1 | 5 | 1.0000 | 0.000 | 0.0 | 1.00 |"), std::string::npos) << "aligned: " << text;
  EXPECT_NE(text.find("| Average | 0.7925 | 0.045 | 1.7 |"), std::string::npos) << "the paper: " << text;
  EXPECT_NE(text.find("1 of 2 objects matched"), std::string::npos) << text;
}

TEST(Table6, MarksWhatDoesNotCount) {
  ListedObject truth = object(1, "c", 0, 0);
  truth.visible_fraction = 0.3;
  EXPECT_NE(table6(compare_lists({}, {truth}), "hall").find("1 (not counted)"), std::string::npos);
}

}  // namespace
}  // namespace waretwin

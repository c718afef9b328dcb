// Two scores side by side: what got better and what got worse.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/gate/measures.h"
#include "harness/gate/score_file.h"

namespace waretwin {

enum class Verdict { kSame, kBetter, kWorse, kNotJudged };

struct ComparedValue {
  std::string name;  // a measure's, or that of an object
  std::optional<double> before, after, tolerance;
  Verdict verdict = Verdict::kNotJudged;
};

struct Comparison {
  std::vector<ComparedValue> values;   // the measures that either score has
  std::vector<ComparedValue> objects;  // 3D IoU of true objects that changed by more than the tolerance
  std::vector<std::string> notes;      // what makes the two scores different by itself: another scenario, seed, CPU
  bool same_map = false;               // equal digests

  bool worse() const;
};

// A value that grew worse by more than its tolerance, or is gone, is worse; one that grew better by more is better. What `before` lacks is
// not judged, and neither is what has no tolerance, nor what comes of our own stages where one of the two is another mapper's, nor a
// trajectory that another mapper leaves none of where ours was before.
Comparison compare_scores(const JudgedScore& before, const JudgedScore& after, const Tolerances& tolerances);

// What does not reach its mark. A measure that has a mark and no value has failed.
struct MissedMark {
  std::string name;
  std::optional<double> value;
  double mark = 0.0;
  bool more_is_better = true;
};
std::vector<MissedMark> missed_marks(const JudgedScore& score, const PassMarks& marks);
std::string missed_text(const MissedMark& missed);  // "recall 0.75, expected at least 0.9"

// "recall was 1.0000, is 0.5000, may get worse by 0", of a worse value; and of all of them.
std::string worse_text(const ComparedValue& value);
std::vector<std::string> worse_texts(const Comparison& comparison);

// A Markdown table that reads as plain text, too.
std::string comparison_text(const Comparison& comparison);

}  // namespace waretwin

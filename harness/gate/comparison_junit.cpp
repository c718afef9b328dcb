#include "harness/gate/comparison_junit.h"

namespace waretwin {

JunitSuite junit_of(const Comparison& comparison, const std::string& name) {
  JunitSuite suite{name, {}};
  for (const std::vector<ComparedValue>* list : {&comparison.values, &comparison.objects}) {
    for (const ComparedValue& value : *list) {
      if (value.verdict == Verdict::kNotJudged) continue;
      JunitCase& one = suite.cases.emplace_back(JunitCase{name, value.name, {}, "", ""});
      if (value.verdict != Verdict::kWorse) continue;
      one.failure = worse_text(value);
    }
  }
  return suite;
}

}  // namespace waretwin

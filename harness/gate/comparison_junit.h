// A comparison as test results.
#pragma once

#include "harness/gate/comparison.h"
#include "harness/gate/junit.h"

namespace waretwin {

// A case for each judged measure, and one for each object that changed.
JunitSuite junit_of(const Comparison& comparison, const std::string& name);

}  // namespace waretwin

// Test results in the JUnit XML that CI services read.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace waretwin {

struct JunitCase {
  std::string class_name, name;
  std::optional<double> seconds;
  std::string failure;  // empty: passed; the first line is the message
  std::string error;    // could not be run at all
};

struct JunitSuite {
  std::string name;
  std::vector<JunitCase> cases;
};

// Characters that XML 1.0 cannot hold become '?'.
std::string junit_xml(const std::vector<JunitSuite>& suites);

}  // namespace waretwin

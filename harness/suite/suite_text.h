// What became of a suite, as files.
#pragma once

#include <string>
#include <vector>

#include "harness/suite/suite.h"

namespace waretwin {

// One run's, as it waits for the others in the unit store.
std::string outcome_json(const SuiteOutcome& outcome);
// Throws Error naming `name` for what outcome_json did not write.
SuiteOutcome read_outcome(const std::string& json, const std::filesystem::path& name);

std::string suite_json(const std::string& name, const std::vector<SuiteOutcome>& outcomes);
std::string suite_table(const std::string& name, const std::vector<SuiteOutcome>& outcomes);  // Markdown
std::string suite_junit(const std::string& name, const std::vector<SuiteOutcome>& outcomes);

}  // namespace waretwin

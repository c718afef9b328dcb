// The folder that a study leaves behind.
#pragma once

#include <filesystem>
#include <functional>

#include "harness/study/study_results.h"
#include "harness/study/study_setup.h"
#include "harness/study/study_text.h"

namespace waretwin {

// Takes an earlier study's results away; units, drawn halls and previews stay. Throws Error where that cannot be.
void remove_results(const std::filesystem::path& out);

// plots/, coverage/ (the baseline's and those of the best), best/, results.csv, runs.csv, study.md, and results.json at the very end.
// `check` is called now and then and may throw to stop.
void write_results(const std::filesystem::path& out, const StudySetup& setup, const StudyResults& results,
                   const std::function<void()>& check);

}  // namespace waretwin

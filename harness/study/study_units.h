// A study's units of work: what each depends on, and its result as text.
#pragma once

#include <filesystem>
#include <string>

#include "harness/study/study_results.h"
#include "harness/study/study_setup.h"

namespace waretwin {

// Coverage of one candidate in one hall.
std::string coverage_unit(const CandidateInHall& candidate, const CoverageConfig& config);
StudyValues measure_coverage(const CandidateInHall& candidate, const CoverageHall& hall, const RayCaster* own_body,
                             const CoverageConfig& config);

// One drive of one candidate.
std::string run_unit(const RunConfig& config, const SharedHall& shared);

// A unit's file: what results are made of, and beside it what they are not made of.
struct UnitRecord {
  StudyRunResult result;  // hall and seed are the caller's
  std::string cpu;        // cpu_identity() of where it was made
  double wall_s = 0.0;
};
std::string unit_text(const UnitRecord& record);
// `name` stands for the file in messages. Throws Error for a text that is no unit.
UnitRecord read_unit(const std::string& text, const std::filesystem::path& name);

}  // namespace waretwin

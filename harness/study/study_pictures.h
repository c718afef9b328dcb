// A study's plots and maps of coverage.
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "harness/study/blind_zone.h"
#include "harness/study/coverage.h"
#include "harness/study/study_results.h"

namespace waretwin {

struct NamedPicture {
  std::string name;  // of the file, without ending
  cv::Mat image;     // BGR
};

// The front over the first two measures of judge.pareto ("pareto"), each judged measure that differs by each factor's levels
// ("effects-MEASURE"), and, in a study of two factors of numbers, each as a field over both ("field-MEASURE").
std::vector<NamedPicture> study_plots(const StudyConfig& study, const StudyResults& results);

// The hall from above: how often each place of the floor was looked at, what could be seen and was not, each object with the share of it
// that was seen; the blind zone around the vehicle beside it. `values`: coverage as in CandidateResult::halls.
cv::Mat coverage_map(const Scene& scene, const Scenario& scenario, const CoverageHall& hall, const FloorLooks& looks,
                     const Coverage& coverage, const BlindZone& blind, const std::string& title);

}  // namespace waretwin

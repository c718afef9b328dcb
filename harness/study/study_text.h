// A study's results as text: JSON, CSV, Markdown.
#pragma once

#include <string>

#include "harness/study/study_results.h"
#include "harness/study/study_setup.h"

namespace waretwin {

// All of it, for programs and the page. `maps`: pictures by candidate, as paths from the study's folder.
using CoverageMaps = std::map<int, std::vector<std::string>>;
std::string study_json(const StudySetup& setup, const StudyResults& results, const CoverageMaps& maps);

// A row a candidate: factors, state, and for each judged measure mean, interval, and difference from the baseline with its interval.
std::string study_csv(const StudyConfig& study, const StudyResults& results);
// A row a drive: all measures.
std::string runs_csv(const StudyConfig& study, const StudyResults& results);

// A line a drive that did not end well, and why: "c012 in agiprobot, seed 1: ...".
std::vector<std::string> failed_drives(const StudyResults& results);

// For people: the best mount and its advantage, drives that failed, the front, the table, main effects.
std::string study_markdown(const StudySetup& setup, const StudyResults& results);

// "c012 (height 1.2, pitch 30) has mean_iou3d 0.97; the baseline (..) 0.93: +0.04 (95 % ..: +0.01 to +0.06)", or why there is no best.
std::string verdict_text(const StudyConfig& study, const StudyResults& results);

// "height 1.2, pitch 30"
std::string values_text(const StudyConfig& study, const DesignPoint& values);

}  // namespace waretwin

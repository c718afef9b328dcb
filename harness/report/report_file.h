// report.html of a folder, whatever waretwin left in it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace waretwin {

enum class ReportKind { kRun, kStudy, kDataset };

// By the files in it: results.json is a study's, dataset.yaml a set's; score.json a run's, map.json a map's.
// Throws Error for any other folder, and for a run that did not finish.
ReportKind report_kind(const std::filesystem::path& folder);

struct ReportSummary {
  ReportKind kind = ReportKind::kRun;
  std::uintmax_t bytes = 0;
  bool plain = false;  // static_page.h: there is no viewer
};

// Writes report.html in place of an earlier one. `kind`: what the caller knows the folder to be; by default what its files say. `score`: as
// in run_page, of a run that is about to be complete. Throws Error where the folder is of no known kind, or a file in it is damaged.
ReportSummary write_report(const std::filesystem::path& folder, std::optional<ReportKind> kind = {}, const std::string& score = {});

}  // namespace waretwin

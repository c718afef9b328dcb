#include "harness/report/report_file.h"

#include "core/error.h"
#include "core/files.h"
#include "harness/report/dataset_page.h"
#include "harness/report/page_template.h"
#include "harness/report/run_page.h"
#include "harness/report/static_page.h"
#include "harness/report/study_page.h"

namespace waretwin {

namespace fs = std::filesystem;

ReportKind report_kind(const fs::path& folder) {
  std::error_code error;
  if (!fs::exists(folder, error)) throw Error(folder, "does not exist; expected the folder of a run, a study or a dataset");
  if (!fs::is_directory(folder, error)) throw Error(folder, "is no folder; expected that of a run, a study or a dataset");
  const auto has = [&](const char* name) { return fs::is_regular_file(folder / name, error); };
  if (has("results.json")) return ReportKind::kStudy;
  if (has("dataset.yaml")) return ReportKind::kDataset;
  if ((has("score.json") && has("cuboids.json")) || has("map.json")) return ReportKind::kRun;
  if (has("truth.json")) throw Error(folder, "has truth.json and no score.json: the run did not finish; expected a finished run");
  if (has("cuboids.json") || has("trajectory.tum"))
    throw Error(folder, "has neither score.json nor map.json: the run or map did not finish, or an earlier version made it");
  throw Error(folder,
              "is not of a run, a study or a dataset; expected score.json and cuboids.json (run), map.json (map), "
              "results.json (study) or dataset.yaml (dataset) in it");
}

ReportSummary write_report(const fs::path& folder, std::optional<ReportKind> kind, const std::string& score) {
  ReportSummary summary;
  summary.kind = kind ? *kind : report_kind(folder);
  const PageData data = summary.kind == ReportKind::kStudy     ? study_page(folder)
                        : summary.kind == ReportKind::kDataset ? dataset_page(folder)
                                                               : run_page(folder, score);
  const std::optional<std::string> page = page_template();
  summary.plain = !page;
  const std::string html = page ? filled_page(*page, data) : static_page(data, folder);
  summary.bytes = html.size();
  write_file(folder / "report.html", html);
  return summary;
}

}  // namespace waretwin

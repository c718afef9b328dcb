#include "harness/study/study_files.h"

#include <algorithm>
#include <set>

#include "core/error.h"
#include "core/files.h"
#include "harness/pictures/picture_file.h"
#include "harness/score/number_text.h"
#include "harness/study/blind_zone.h"
#include "harness/study/study_pictures.h"

namespace waretwin {

namespace fs = std::filesystem;

namespace {

constexpr const char* kPlots = "plots";
constexpr const char* kMaps = "coverage";
constexpr const char* kBest = "best";

// The baseline and the best, by what the study judges; then by number.
std::vector<const CandidateResult*> shown_on_maps(const StudyConfig& study, const StudyResults& results) {
  std::vector<const CandidateResult*> shown = ranked(results);
  std::erase(shown, &results.candidates.front());
  shown.resize(std::min(shown.size(), static_cast<std::size_t>(study.coverage_maps)));
  shown.insert(shown.begin(), &results.candidates.front());
  return shown;
}

CoverageMaps write_maps(const fs::path& out, const StudySetup& setup, const StudyResults& results, const std::function<void()>& check) {
  make_folder(out / kMaps);
  CoverageMaps maps;
  for (const CandidateResult* shown : shown_on_maps(setup.study, results)) {
    const Candidate& candidate = setup.candidates[static_cast<std::size_t>(shown->number)];
    for (const CandidateInHall& in_hall : candidate.halls) {
      check();
      const Scenario& scenario = in_hall.config.scenario;
      const CoverageHall& hall = in_hall.shared->coverage(in_hall.baseline_robot, setup.study.coverage);
      const RayCaster* body = in_hall.shared->own_body().get();
      FloorLooks looks;
      const Coverage coverage = hall.along_route(scenario, body, &looks);
      const BlindZone blind = blind_zone(scenario.robot, scenario.sensors, body, setup.study.coverage.blind_radius_m);
      const std::string title = candidate.name + (candidate.number == 0 ? " (baseline), " : ", ") +
                                values_text(setup.study, candidate.values) + "; " + in_hall.hall + ": floor " +
                                number("%.0f %%", 100.0 * coverage.floor) + " seen";
      const std::string file = std::string(kMaps) + "/" + candidate.name + "-" + in_hall.hall + ".png";
      write_png(out / file, coverage_map(*in_hall.shared->scene, scenario, hall, looks, coverage, blind, title));
      maps[candidate.number].push_back(file);
    }
  }
  return maps;
}

// Files of an earlier study that this one does not have. Not before the new ones are there: another shard may be writing the same.
void remove_others(const fs::path& folder, const char* extension, const std::set<std::string>& names) {
  std::error_code error;
  std::vector<fs::path> others;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() == extension && !names.contains(entry.path().stem().string())) others.push_back(entry.path());
  }
  for (const fs::path& file : others) fs::remove(file, error);
}

// What `waretwin run --config` takes, for each hall.
void write_best(const fs::path& out, const StudySetup& setup, const StudyResults& results) {
  std::set<std::string> halls;
  if (results.best) {
    make_folder(out / kBest);
    for (const CandidateInHall& in_hall : setup.candidates[*results.best].halls) {
      write_file(out / kBest / (in_hall.hall + ".yaml"), setup.run_config(in_hall));
      halls.insert(in_hall.hall);
    }
  }
  remove_others(out / kBest, ".yaml", halls);
}

}  // namespace

void remove_results(const fs::path& out) {
  make_folder(out);
  std::error_code error;
  for (const char* name : {"results.json", "results.csv", "runs.csv", "study.md", "timing.csv", "report.html"}) {
    fs::remove(out / name, error);
    if (error) throw Error(out / name, "cannot be replaced: " + error.message());
  }
}

void write_results(const fs::path& out, const StudySetup& setup, const StudyResults& results, const std::function<void()>& check) {
  check();
  make_folder(out / kPlots);
  std::set<std::string> plots, pictures;
  for (const NamedPicture& plot : study_plots(setup.study, results)) {
    write_png(out / kPlots / (plot.name + ".png"), plot.image);
    plots.insert(plot.name);
  }
  remove_others(out / kPlots, ".png", plots);
  const CoverageMaps maps = write_maps(out, setup, results, check);
  for (const auto& entry : maps) {
    for (const std::string& file : entry.second) pictures.insert(fs::path(file).stem().string());
  }
  remove_others(out / kMaps, ".png", pictures);
  write_best(out, setup, results);
  write_file(out / "results.csv", study_csv(setup.study, results));
  write_file(out / "runs.csv", runs_csv(setup.study, results));
  write_file(out / "study.md", study_markdown(setup, results));
  write_file(out / "results.json", study_json(setup, results, maps));
}

}  // namespace waretwin

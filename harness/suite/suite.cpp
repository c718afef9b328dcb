#include "harness/suite/suite.h"

#include <memory>

#include "core/error.h"
#include "core/files.h"
#include "harness/gate/comparison.h"
#include "harness/generate/hall_maker.h"
#include "harness/run/run_folder.h"
#include "harness/score/motion_text.h"
#include "harness/score/score_json.h"
#include "harness/suite/suite_text.h"

namespace waretwin {

namespace fs = std::filesystem;

namespace {

// A run with all that could be refused behind it.
struct ReadyRun {
  std::string name, scenario;  // the file
  RunConfig config;
  std::optional<JudgedScore> baseline;
  PassMarks pass;
  std::string unit;  // its name in the store
};

fs::path beside(const fs::path& suite_file, const std::string& name) { return suite_file.parent_path() / name; }

// A detector that is a file stands beside the suite; words and shipped models are what they are.
std::optional<std::string> detector_of(const SuiteRun& run, const fs::path& suite_file) {
  if (!run.choice.detector) return std::nullopt;
  const fs::path file = beside(suite_file, *run.choice.detector);
  return fs::exists(file) ? file.string() : *run.choice.detector;
}

std::string text_of(const PassMarks& pass, const Tolerances& tolerances) {
  PassMarks marks = pass;
  Tolerances allowed = tolerances;
  return write_config([&](Fields& f) {
    f.group("pass", marks, "");
    f.group("tolerances", allowed, "");
  });
}

std::string unit_of(const ReadyRun& run, const SuiteConfig& suite, const std::string& baseline_bytes, const Scene& scene) {
  RunConfig config = run.config;
  Digest digest;
  digest.add(program_identity());
  digest.add(run.name);
  digest.add(write_config([&](Fields& f) { config.visit(f); }));
  digest.add(text_of(run.pass, suite.tolerances));
  digest.add(baseline_bytes);
  add_scene(scene, digest);
  return digest.hex();
}

// A hall that is there already, of the same program and wishes, is taken as it is.
fs::path drawn_hall(generate::GenerateConfig config, const fs::path& out) {
  Digest digest;
  digest.add(program_identity());
  digest.add(write_config([&](Fields& f) { config.visit(f); }));
  const fs::path hall = out / "halls" / digest.hex();
  if (!fs::exists(hall)) make_hall(config, hall);
  return hall;
}

ReadyRun make_ready(const std::string& name, const SuiteRun& run, const SuiteConfig& suite, const fs::path& file,
                    const std::vector<Setting>& settings, const fs::path& out) {
  ReadyRun ready;
  ready.name = name;
  ready.scenario = beside(file, run.scenario).string();
  if (run.generate.asked_for()) {
    ready.scenario = (drawn_hall(run.generate.config, out) / "scenario.yaml").string();
  }
  RunChoice choice = run.choice;
  choice.detector = detector_of(run, file);
  std::vector<Setting> all;
  for (const std::string& text : run.set) all.push_back(parse_setting(text));
  all.insert(all.end(), settings.begin(), settings.end());
  ready.config = load_run_config(ready.scenario, chosen_run(choice), run.config.empty() ? fs::path() : beside(file, run.config), all);
  ready.pass = run.pass;
  std::string baseline_bytes;
  if (!run.baseline.empty()) {
    const fs::path baseline = beside(file, run.baseline);
    baseline_bytes = read_file(baseline);
    ready.baseline = judged_score(baseline_bytes, baseline);
  }
  ready.unit = unit_of(ready, suite, baseline_bytes, build_scene(ready.config.scenario));
  return ready;
}

std::vector<std::string> problems_of(const ReadyRun& run, const RunScore& score, const JudgedScore& judged, const Tolerances& tolerances) {
  std::vector<std::string> problems;
  for (const MissedMark& missed : missed_marks(judged, run.pass)) problems.push_back(missed_text(missed));
  if (run.baseline) {
    const Comparison comparison = compare_scores(*run.baseline, judged, tolerances);
    for (const std::string& text : worse_texts(comparison)) problems.push_back(text);
  }
  if (score.motion) {
    for (const RobotContact& contact : score.motion->contacts) problems.push_back(contact_text(contact));
  }
  return problems;
}

SuiteOutcome drive(const ReadyRun& run, const SuiteConfig& suite, const fs::path& out, const std::function<void(double)>& progress) {
  SuiteOutcome outcome{run.name, "", "", {}, {}};
  try {
    const auto scene = std::make_shared<const Scene>(build_scene(run.config.scenario));
    std::optional<RunFolder> folder;
    const ClosedLoopResult result = run_closed_loop(
        run.config, scene,
        [&] {
          folder.emplace(out / run.name);
          RunConfig resolved = run.config;
          folder->write("config.yaml", resolved_config([&](Fields& f) { resolved.visit(f); }, "scenario " + run.scenario));
        },
        [&](double share, const ObjectMap&) { progress(share); });
    write_closed_loop(*folder, result, run.config.output);
    const JudgedScore judged = judged_score(score_json(result.score), folder->file("score.json"));
    outcome.digest = result.score.digest;
    outcome.values = judged.values;
    outcome.problems = problems_of(run, result.score, judged, suite.tolerances);
  } catch (const Error& error) {
    outcome.error = error.what();
  }
  return outcome;
}

}  // namespace

SuiteSummary run_suite(const SuiteRequest& request, const std::function<void(const SuiteProgress&)>& progress) {
  const fs::path& out = request.out;
  const Shard& shard = request.shard;
  const SuiteConfig suite = read_suite(request.file);
  std::vector<ReadyRun> runs;
  for (const auto& [name, run] : suite.runs) {
    try {
      runs.push_back(make_ready(name, run, suite, request.file, request.settings, out));
    } catch (const Error& error) {
      throw Error(request.file, "run '" + name + "': " + error.what());
    }
  }
  const UnitStore store(out / "units");
  SuiteSummary summary;
  summary.name = suite.name;
  const int count = static_cast<int>(runs.size());
  SuiteProgress now{"", 0, (count - shard.index + shard.count - 1) / shard.count, 0.0};
  for (int i = 0; i < count; ++i) {
    if (request.merge_only || !shard.has(i)) continue;
    const ReadyRun& run = runs[static_cast<std::size_t>(i)];
    now.run = run.name;
    ++now.number;
    if (store.result(run.unit)) {
      ++summary.found;
      continue;
    }
    const SuiteOutcome outcome = drive(run, suite, out, [&](double share) {
      now.share = share;
      if (progress) progress(now);
    });
    store.write(run.unit, outcome_json(outcome));
  }
  for (const ReadyRun& run : runs) {
    if (const std::optional<std::string> result = store.result(run.unit)) {
      summary.outcomes.push_back(read_outcome(*result, out / "units" / run.unit));
    } else {
      ++summary.missing;
    }
  }
  if (summary.missing > 0) {
    summary.outcomes.clear();
    return summary;
  }
  write_file(out / "suite.md", suite_table(suite.name, summary.outcomes));
  write_file(out / "junit.xml", suite_junit(suite.name, summary.outcomes));
  write_file(out / "suite.json", suite_json(suite.name, summary.outcomes));
  return summary;
}

}  // namespace waretwin

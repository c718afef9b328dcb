#include "harness/suite/suite.h"

#include <memory>
#include <set>

#include "core/error.h"
#include "core/files.h"
#include "core/staged_folder.h"
#include "harness/gate/comparison.h"
#include "harness/run/external_run.h"
#include "harness/run/run_folder.h"
#include "harness/score/motion_text.h"
#include "harness/score/score_json.h"
#include "harness/suite/suite_text.h"
#include "harness/units/callers_stop.h"
#include "harness/units/run_unit.h"
#include "mapper/stages.h"

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

std::string text_of(const PassMarks& pass, const Tolerances& tolerances) {
  PassMarks marks = pass;
  Tolerances allowed = tolerances;
  return write_config([&](Fields& f) {
    f.group("pass", marks, "");
    f.group("tolerances", allowed, "");
  });
}

std::string unit_of(const ReadyRun& run, const SuiteConfig& suite, const std::string& baseline_bytes, const Scene& scene) {
  Digest digest;
  digest.add(program_identity());
  digest.add(run.name);
  digest.add(text_of(run.pass, suite.tolerances));
  digest.add(baseline_bytes);
  add_run(run.config, digest_of(scene), digest);
  return digest.hex();
}

void expect_no_marks_of_ours(const PassMarks& pass) {
  for (std::size_t i = 0; i < measures().size(); ++i) {
    if (measures()[i].ours && pass.measures.values[i])
      throw Error("pass." + std::string(measures()[i].name) + ": comes of our own mapper's stages; expected none with another mapper");
  }
}

ReadyRun make_ready(const std::string& name, const SuiteRun& run, const SuiteConfig& suite, const SuiteRequest& request,
                    const std::function<void()>& check) {
  const fs::path& file = request.file;
  ReadyRun ready;
  ready.name = name;
  ready.scenario = beside(file, run.scenario).string();
  if (run.generate.asked_for()) ready.scenario = (draw_hall_once(run.generate.config, request.out, check) / "scenario.yaml").string();
  RunChoice choice = run.choice;
  choice.detector = detector_beside(run.choice.detector, file.parent_path());
  std::vector<Setting> all;
  for (const std::string& text : run.set) all.push_back(parse_setting(text));
  all.insert(all.end(), request.settings.begin(), request.settings.end());
  ready.config = load_run_config(ready.scenario, chosen_run(choice), run.config.empty() ? fs::path() : beside(file, run.config), all);
  if (ready.config.external_mapper.used()) {
    expect_none_of_ours(choice);
    if (!run.config.empty())
      throw Error("config " + run.config + ": with another mapper (external_mapper.command) expected none; `set` changes single keys");
    check_external(ready.config);
    expect_no_marks_of_ours(run.pass);
  } else if (!ready.config.truth_stages.detector) {
    make_detector(ready.config.mapper);  // throws where it cannot be
  }
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

std::optional<SuiteOutcome> stored(const ReadyRun& run, const UnitStore& store) {
  const std::optional<std::string> result = store.result(run.unit);
  return result ? std::optional(read_outcome(*result, store.file(run.unit))) : std::nullopt;
}

// The folder of a run appears when all its files are there; kUnit in it says which unit's they are.
constexpr const char* kUnit = "unit.txt";

void write_settings(RunFolder& folder, const ReadyRun& run) {
  RunConfig resolved = run.config;
  folder.write("config.yaml", resolved_config([&](Fields& f) { resolved.visit(f); }, "scenario " + run.scenario));
  folder.write(kUnit, run.unit + "\n");
}

void judge(const ReadyRun& run, const RunScore& score, const Tolerances& tolerances, const fs::path& out, SuiteOutcome& outcome) {
  const JudgedScore judged = judged_score(score_json(score), out / run.name / "score.json");
  outcome.digest = score.digest;
  outcome.values = judged.values;
  outcome.problems = problems_of(run, score, judged, tolerances);
}

void drive_ours(const ReadyRun& run, const std::shared_ptr<const Scene>& scene, const SuiteConfig& suite, const fs::path& out,
                const std::function<void(double)>& progress, SuiteOutcome& outcome) {
  const ClosedLoopResult result = run_closed_loop(run.config, scene, {}, [&](double share, const ObjectMap&) { progress(share); });
  StagedFolder staged(out / run.name);
  RunFolder folder(staged.path());
  write_settings(folder, run);
  write_closed_loop(folder, result, run.config.output);
  staged.commit();
  judge(run, result.score, suite.tolerances, out, outcome);
}

// What the command leaves is kept, also where it fails: its words, and of the first failure (`recording_kept` is not yet set) the
// recording, are what the failure is found by.
void drive_external(const ReadyRun& run, const std::shared_ptr<const Scene>& scene, const SuiteConfig& suite, const fs::path& out,
                    const std::function<void(double)>& progress, bool& recording_kept, SuiteOutcome& outcome) {
  StagedFolder staged(out / run.name);
  RunFolder folder(staged.path());
  const auto ready = [&]() -> RunFolder& {
    write_settings(folder, run);
    return folder;
  };
  const ExternalRunResult result = run_external(run.config, scene, ready, [&](double share, const std::string&) { progress(share); });
  write_external(folder, run.config, result);
  if (!result.score && !run.config.external_mapper.keep_recording) {
    if (recording_kept) remove_recording(folder);
    recording_kept = true;
  }
  staged.commit();
  if (!result.score) {
    outcome.problems = {failure_text(result, run.name)};
    return;
  }
  judge(run, *result.score, suite.tolerances, out, outcome);
  const std::string trajectory = trajectory_text(result, run.name);
  if (!trajectory.empty()) outcome.problems.push_back(trajectory);
}

SuiteOutcome drive(const ReadyRun& run, const SuiteConfig& suite, const fs::path& out, bool& recording_kept,
                   const std::function<void(double)>& progress) {
  SuiteOutcome outcome;
  outcome.run = run.name;
  outcome.cpu = cpu_identity();
  CallersStop stop;
  const auto told = [&](double share) { stop.ask([&] { progress(share); }); };
  try {
    const auto scene = std::make_shared<const Scene>(build_scene(run.config.scenario));
    if (run.config.external_mapper.used()) {
      drive_external(run, scene, suite, out, told, recording_kept, outcome);
    } else {
      drive_ours(run, scene, suite, out, told, outcome);
    }
  } catch (const Error& error) {
    stop.pass_on();
    outcome.error = error.what();
  }
  return outcome;
}

// A result that driving again would only repeat. What could not be driven may have been the disk's fault, and a mapper that failed (no
// score.json) may be mended.
bool is_done(const ReadyRun& run, const UnitStore& store, const fs::path& out) {
  const std::optional<SuiteOutcome> before = stored(run, store);
  const fs::path folder = out / run.name;
  return before && before->error.empty() && before->cpu == cpu_identity() && fs::exists(folder / "score.json") &&
         fs::exists(folder / kUnit) && read_file(folder / kUnit) == run.unit + "\n";
}

}  // namespace

SuiteSummary run_suite(const SuiteRequest& request, const SuiteHooks& hooks) {
  const fs::path& out = request.out;
  const SuiteConfig suite = read_suite(request.file);
  // Nobody takes an earlier commit's verdict for this one's.
  for (const char* verdict : {"suite.json", "suite.md", "junit.xml"}) fs::remove(out / verdict);
  const auto check = [&] {
    if (hooks.check) hooks.check();
  };
  std::vector<ReadyRun> runs;
  for (const auto& [name, run] : suite.runs) {
    check();
    try {
      runs.push_back(make_ready(name, run, suite, request, hooks.check));
    } catch (const Error& error) {
      check();  // stopped
      throw Error(request.file, "run '" + name + "': " + error.what());
    }
  }
  const UnitStore store(out / "units");
  SuiteSummary summary;
  summary.name = suite.name;
  const int count = static_cast<int>(runs.size());
  bool recording_kept = false;  // of a mapper's failure
  SuiteProgress now{"", 0, request.shard.size(count), 0.0};
  for (int i = 0; i < count; ++i) {
    if (request.merge_only || !request.shard.has(i)) continue;
    const ReadyRun& run = runs[static_cast<std::size_t>(i)];
    now.run = run.name;
    ++now.number;
    check();
    if (is_done(run, store, out)) {
      ++summary.found;
      const ExternalMapper& mapper = run.config.external_mapper;
      if (mapper.used() && mapper.depends.empty()) ++summary.found_unwatched;
      continue;
    }
    const SuiteOutcome outcome = drive(run, suite, out, recording_kept, [&](double share) {
      check();
      now.share = share;
      if (hooks.progress) hooks.progress(now);
    });
    store.write(run.unit, outcome_json(outcome));
  }
  std::set<std::string> kinds;
  for (const ReadyRun& run : runs) {
    if (const std::optional<SuiteOutcome> outcome = stored(run, store)) {
      kinds.insert(outcome->cpu);
      summary.outcomes.push_back(*outcome);
    } else {
      summary.missing.push_back(run.name);
    }
  }
  summary.kinds_of_cpu = static_cast<int>(kinds.size());
  if (!summary.missing.empty()) {
    summary.outcomes.clear();
    return summary;
  }
  write_file(out / "suite.md", suite_table(suite.name, summary.outcomes));
  write_file(out / "junit.xml", suite_junit(suite.name, summary.outcomes));
  write_file(out / "suite.json", suite_json(suite.name, summary.outcomes));
  return summary;
}

}  // namespace waretwin

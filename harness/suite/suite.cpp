#include "harness/suite/suite.h"

#include <unistd.h>

#include <exception>
#include <memory>
#include <set>

#include "core/error.h"
#include "core/files.h"
#include "core/staged_folder.h"
#include "harness/gate/comparison.h"
#include "harness/generate/hall_maker.h"
#include "harness/run/run_folder.h"
#include "harness/score/motion_text.h"
#include "harness/score/score_json.h"
#include "harness/suite/suite_text.h"
#include "mapper/detect/model_files.h"
#include "mapper/detect/shipped_models.h"
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

// A detector that is a file stands beside the suite; words and shipped models are what they are.
std::optional<std::string> detector_of(const SuiteRun& run, const fs::path& suite_file) {
  const std::optional<std::string>& named = run.choice.detector;
  if (!named || *named == "truth" || *named == "none" || *named == "yolo" || is_shipped_model(*named)) return named;
  const fs::path file = beside(suite_file, *named);
  return fs::exists(file) ? file.string() : *named;
}

std::string text_of(const PassMarks& pass, const Tolerances& tolerances) {
  PassMarks marks = pass;
  Tolerances allowed = tolerances;
  return write_config([&](Fields& f) {
    f.group("pass", marks, "");
    f.group("tolerances", allowed, "");
  });
}

// What the detector is made of; names of files say nothing of what is in them.
void add_detector(const RunConfig& config, Digest& digest) {
  if (config.truth_stages.detector) return;
  if (config.mapper.detector == "yolo") {
    const ModelFiles files = find_model_files(model_or_shipped(config.mapper.model), config.mapper.detect.names);
    for (const fs::path& file : {files.cfg, files.weights, files.onnx, files.names}) {
      if (!file.empty()) digest.add(read_file(file));
    }
  }
  if (config.mapper.detector == "boxes") digest.add(read_file(config.mapper.boxes));
}

std::string unit_of(const ReadyRun& run, const SuiteConfig& suite, const std::string& baseline_bytes, const Scene& scene) {
  RunConfig config = run.config;
  // Their bytes count, not where they lie.
  config.mapper.model.clear();
  config.mapper.boxes.clear();
  config.mapper.detect.names.clear();
  config.resume.clear();
  Digest digest;
  digest.add(program_identity());
  digest.add(run.name);
  digest.add(write_config([&](Fields& f) { config.visit(f); }));
  digest.add(text_of(run.pass, suite.tolerances));
  digest.add(baseline_bytes);
  add_scene(scene, digest);
  add_detector(run.config, digest);
  if (!run.config.resume.empty()) digest.add(read_file(run.config.resume));
  return digest.hex();
}

// A hall that is there already, of the same program and wishes, is taken as it is.
fs::path drawn_hall(generate::GenerateConfig config, const fs::path& out, const std::function<void()>& check) {
  Digest digest;
  digest.add(program_identity());
  digest.add(write_config([&](Fields& f) { config.visit(f); }));
  const fs::path hall = out / "halls" / digest.hex();
  if (fs::exists(hall)) return hall;
  // Another shard may draw it, too: whoever is first has made it for both.
  fs::path own = hall;
  own += "-" + std::to_string(::getpid());
  make_hall(config, own, {.step = check, .in_vain = {}});
  std::error_code taken, ignored;
  fs::rename(own, hall, taken);
  if (taken) fs::remove_all(own, ignored);
  if (!fs::exists(hall)) throw Error(hall, "cannot be put in place: " + taken.message());
  return hall;
}

ReadyRun make_ready(const std::string& name, const SuiteRun& run, const SuiteConfig& suite, const SuiteRequest& request,
                    const std::function<void()>& check) {
  const fs::path& file = request.file;
  ReadyRun ready;
  ready.name = name;
  ready.scenario = beside(file, run.scenario).string();
  if (run.generate.asked_for()) ready.scenario = (drawn_hall(run.generate.config, request.out, check) / "scenario.yaml").string();
  RunChoice choice = run.choice;
  choice.detector = detector_of(run, file);
  std::vector<Setting> all;
  for (const std::string& text : run.set) all.push_back(parse_setting(text));
  all.insert(all.end(), request.settings.begin(), request.settings.end());
  ready.config = load_run_config(ready.scenario, chosen_run(choice), run.config.empty() ? fs::path() : beside(file, run.config), all);
  if (!ready.config.truth_stages.detector) make_detector(ready.config.mapper);  // throws where it cannot be
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

SuiteOutcome drive(const ReadyRun& run, const SuiteConfig& suite, const fs::path& out, const std::function<void(double)>& progress) {
  SuiteOutcome outcome;
  outcome.run = run.name;
  outcome.cpu = cpu_identity();
  std::exception_ptr stopped;  // by the caller, which is no fault of the run
  try {
    const auto scene = std::make_shared<const Scene>(build_scene(run.config.scenario));
    const ClosedLoopResult result = run_closed_loop(run.config, scene, {}, [&](double share, const ObjectMap&) {
      try {
        progress(share);
      } catch (...) {
        stopped = std::current_exception();
        throw;
      }
    });
    StagedFolder staged(out / run.name);
    RunFolder folder(staged.path());
    RunConfig resolved = run.config;
    folder.write("config.yaml", resolved_config([&](Fields& f) { resolved.visit(f); }, "scenario " + run.scenario));
    folder.write(kUnit, run.unit + "\n");
    write_closed_loop(folder, result, run.config.output);
    staged.commit();
    const JudgedScore judged = judged_score(score_json(result.score), out / run.name / "score.json");
    outcome.digest = result.score.digest;
    outcome.values = judged.values;
    outcome.problems = problems_of(run, result.score, judged, suite.tolerances);
  } catch (const Error& error) {
    if (stopped) std::rethrow_exception(stopped);
    outcome.error = error.what();
  }
  return outcome;
}

// A result that driving again would only repeat. What could not be driven may have been the disk's fault.
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
  SuiteProgress now{"", 0, (count - request.shard.index + request.shard.count - 1) / request.shard.count, 0.0};
  for (int i = 0; i < count; ++i) {
    if (request.merge_only || !request.shard.has(i)) continue;
    const ReadyRun& run = runs[static_cast<std::size_t>(i)];
    now.run = run.name;
    ++now.number;
    check();
    if (is_done(run, store, out)) {
      ++summary.found;
      continue;
    }
    const SuiteOutcome outcome = drive(run, suite, out, [&](double share) {
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

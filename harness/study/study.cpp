#include "harness/study/study.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <map>
#include <mutex>
#include <set>
#include <utility>

#include "core/error.h"
#include "core/files.h"
#include "core/parallel.h"
#include "core/side_by_side.h"
#include "core/staged_folder.h"
#include "harness/gate/measures.h"
#include "harness/gate/score_file.h"
#include "harness/report/report_file.h"
#include "harness/run/closed_loop.h"
#include "harness/run/external_run.h"
#include "harness/score/score_json.h"
#include "harness/study/study_files.h"
#include "harness/study/study_units.h"
#include "harness/units/callers_stop.h"

namespace waretwin {

namespace fs = std::filesystem;

namespace {

// One drive that the study asks for.
struct Drive {
  std::size_t candidate;
  const CandidateInHall* in_hall;
  RunConfig config;
  std::string unit;

  // Of its folder.
  std::string name(const std::vector<Candidate>& candidates) const {
    return candidates[candidate].name + "-" + in_hall->hall + "-" + std::to_string(config.scenario.seed);
  }
  std::string text(const std::vector<Candidate>& candidates) const {
    return candidates[candidate].name + " in " + in_hall->hall + ", seed " + std::to_string(config.scenario.seed);
  }
};

// What one became.
struct Driven {
  UnitRecord record;
  int exit_code = 0;  // of another mapper's command
};

// Where another mapper's drives are kept; kUnit in each says which unit's it is.
constexpr const char* kDrives = "drives";
constexpr const char* kUnit = "unit.txt";

// Takes away what was left by drives that are none of these.
void remove_other_drives(const fs::path& out, const std::map<std::string, std::string>& units) {
  std::error_code none;
  std::vector<fs::path> others;
  for (fs::directory_iterator at(out / kDrives, none), end; !none && at != end; at.increment(none)) {
    const fs::path mark = at->path() / kUnit;
    std::error_code ignored;
    if (!fs::is_regular_file(mark, ignored)) continue;  // not of our making
    // Names of drives have no dots; that of one under way has.
    const std::string name = at->path().filename().string();
    const auto known = units.find(name.substr(0, name.find('.')));
    try {
      if (known == units.end() || read_file(mark) != known->second + "\n") others.push_back(at->path());
    } catch (const Error&) {
      // Another shard has just moved its own into place.
    }
  }
  for (const fs::path& folder : others) {
    std::error_code error, ignored;
    fs::remove_all(folder, error);
    // Another shard may have taken it away at the same time.
    if (error && fs::exists(folder, ignored)) throw Error(folder, "cannot be taken away: " + error.message());
  }
}

// Whether the shell found no program, or none that it may run.
bool tells_of_no_program(int exit_code) { return exit_code == 126 || exit_code == 127; }

class StudyRunner {
 public:
  StudyRunner(const StudyRequest& request, const StudyHooks& hooks)
      : request_(request), hooks_(hooks), setup_(set_up_study(request, [this] { check(); })), store_(request.out / "units") {}

  StudySummary run() {
    StudySummary summary;
    summary.study = setup_.study;
    summary.missing = cover();
    if (summary.missing > 0) return summary;
    choose();
    if (!request_.coverage_only) drive_all(summary);
    if (summary.missing > 0) return summary;
    summary.results = judged_study(setup_.study, std::move(results_));
    summary.verdict = verdict_text(setup_.study, *summary.results);
    summary.folder = folder();
    summary.kinds_of_cpu = static_cast<int>(kinds_of_cpu_.size());
    write_results(folder(), setup_, *summary.results, [this] { check(); });
    write_report(folder(), ReportKind::kStudy);
    if (!request_.coverage_only) write_file(folder() / "timing.csv", times_);
    return summary;
  }

 private:
  void check() const {
    if (hooks_.check) hooks_.check();
  }
  void report(const StudyProgress& now) const {
    if (hooks_.progress) hooks_.progress(now);
  }

  // What coverage alone says does not replace what was driven.
  fs::path folder() const { return request_.coverage_only ? request_.out / "screening" : request_.out; }

  // Coverage of all candidates: this shard's first, then what nobody has measured yet, for without all of it nobody knows what to drive.
  // Returns how many are missing, where nothing may be measured.
  int cover() {
    struct Look {
      std::size_t candidate;
      const CandidateInHall* in_hall;
      std::string unit;
    };
    std::vector<Look> looks;
    results_.resize(setup_.candidates.size());
    for (std::size_t i = 0; i < setup_.candidates.size(); ++i) {
      const Candidate& candidate = setup_.candidates[i];
      results_[i].number = candidate.number;
      results_[i].name = candidate.name;
      results_[i].values = candidate.values;
      if (!candidate.refused.empty()) results_[i].broken.push_back(candidate.refused);
      for (const CandidateInHall& in_hall : candidate.halls) looks.push_back({i, &in_hall, coverage_unit(in_hall, setup_.study.coverage)});
    }
    std::vector<std::size_t> order;
    for (const bool own : {true, false}) {
      for (std::size_t i = 0; i < looks.size(); ++i) {
        if (request_.shard.has(static_cast<int>(i)) == own) order.push_back(i);
      }
    }
    if (request_.merge_only) {
      const auto missing = std::count_if(looks.begin(), looks.end(), [&](const Look& look) { return !store_.result(look.unit); });
      if (missing > 0) return static_cast<int>(missing);
    }
    // Each candidate is one thread's: many small loops side by side, looked at in stretches so that a stop is heard.
    constexpr std::size_t kStretch = 16;
    for (std::size_t begin = 0; begin < order.size(); begin += kStretch) {
      check();
      const std::size_t count = std::min(kStretch, order.size() - begin);
      // By unit: candidates that differ in the mapper alone see the same. What is shared is made before the threads divide.
      struct Missing {
        const Look* look;
        const CoverageHall* hall;
        std::shared_ptr<const RayCaster> own_body;
      };
      std::vector<Missing> missing;
      std::set<std::string> names;
      for (std::size_t k = 0; k < count; ++k) {
        const Look& look = looks[order[begin + k]];
        if (store_.result(look.unit) || !names.insert(look.unit).second) continue;
        SharedHall& shared = *look.in_hall->shared;
        missing.push_back({&look, &shared.coverage(look.in_hall->baseline_robot, setup_.study.coverage), shared.own_body()});
      }
      parallel_for(missing.size(), 1, [&](std::size_t from, std::size_t to) {
        for (std::size_t k = from; k < to; ++k) {
          const Missing& one = missing[k];
          UnitRecord record;
          record.cpu = cpu_identity();
          record.result.values = measure_coverage(*one.look->in_hall, *one.hall, one.own_body.get(), setup_.study.coverage);
          store_.write(one.look->unit, unit_text(record));
        }
      });
      const std::size_t done = begin + count;
      report({"coverage", setup_.candidates[looks[order[done - 1]].candidate].name, static_cast<int>(done), static_cast<int>(order.size()),
              static_cast<double>(done) / static_cast<double>(order.size())});
    }
    for (const Look& look : looks) {
      UnitRecord record = read_unit(store_.result(look.unit).value(), store_.file(look.unit));
      kinds_of_cpu_.insert(record.cpu);
      results_[look.candidate].halls[look.in_hall->hall] = std::move(record.result.values);
    }
    return 0;
  }

  static constexpr double kNoValue = 1e300;  // comes last

  // Who is mapped: the baseline, and of those that break no constraint on factors and coverage the best by coverage.
  void choose() {
    const StudyConfig& study = setup_.study;
    const std::size_t by = *study_measure(study.screen.by);
    const double sign = study_measures()[by].more_is_better ? -1.0 : 1.0;
    std::vector<std::pair<double, std::size_t>> able;
    for (std::size_t i = 0; i < results_.size(); ++i) {
      CandidateResult& candidate = results_[i];
      if (setup_.candidates[i].halls.empty()) {
        candidate.state = CandidateState::kRefused;
        continue;
      }
      const StudyValues means = mean_coverage(candidate);
      for (std::string& text : broken_by_measures(study, means, MeasureSource::kCoverage)) candidate.broken.push_back(std::move(text));
      if (i == 0) {
        if (request_.coverage_only) candidate.state = CandidateState::kScreenedOut;
        continue;
      }
      if (!candidate.broken.empty()) {
        candidate.state = CandidateState::kRefused;
      } else if (request_.coverage_only) {
        candidate.state = CandidateState::kScreenedOut;
      } else {
        able.emplace_back(means[by] ? sign * *means[by] : kNoValue, i);
      }
    }
    if (study.screen.keep == 0) return;
    if (std::none_of(able.begin(), able.end(), [](const auto& candidate) { return candidate.first < kNoValue; }) && !able.empty())
      throw Error(request_.file, "screen.by: '" + study.screen.by + "' has no value in these halls; expected another measure of coverage");
    std::sort(able.begin(), able.end());
    for (std::size_t k = static_cast<std::size_t>(study.screen.keep); k < able.size(); ++k)
      results_[able[k].second].state = CandidateState::kScreenedOut;
  }

  std::vector<Drive> drives() const {
    std::vector<Drive> all;
    for (std::size_t i = 0; i < results_.size(); ++i) {
      check();
      if (results_[i].state != CandidateState::kMapped) continue;
      for (const CandidateInHall& in_hall : setup_.candidates[i].halls) {
        for (const double seed : setup_.study.seeds) {
          RunConfig config = in_hall.config;
          config.scenario.seed = static_cast<std::uint64_t>(seed);
          std::string unit = run_unit(config, *in_hall.shared);
          all.push_back({i, &in_hall, std::move(config), std::move(unit)});
        }
      }
    }
    return all;
  }

  // A result that driving again would only repeat. What could not be driven may have been the disk's fault.
  bool is_done(const std::string& unit) const {
    const std::optional<std::string> text = store_.result(unit);
    return text && read_unit(*text, store_.file(unit)).result.error.empty();
  }

  static void take(const RunScore& run, StudyRunResult& result) {
    result.digest = run.digest;
    const JudgedScore score = judged_score(score_json(run), "score.json");
    for (std::size_t k = 0; k < measures().size(); ++k) {
      const std::optional<std::size_t> m = study_measure(measures()[k].name);
      if (m) result.values[*m] = score.values[k];
    }
  }

  // What the command was given and left goes with the drive, unless it failed or somebody wants it. Of failures the first one's recording
  // is enough to find the fault by.
  void drive_external(const Drive& one, const std::function<void(double)>& progress, Driven& driven) {
    const fs::path place = fs::path(kDrives) / one.name(setup_.candidates);
    StagedFolder staged(request_.out / place);
    RunFolder folder(staged.path());
    const auto ready = [&]() -> RunFolder& {
      folder.write(kUnit, one.unit + "\n");
      return folder;
    };
    const ExternalRunResult run =
        run_external(one.config, one.in_hall->shared->scene, ready, [&](double share, const std::string&) { progress(share); });
    const bool keeps = one.config.external_mapper.keep_recording;
    driven.exit_code = run.shell.exit_code;
    if (run.score) {
      take(*run.score, driven.record.result);
    } else {
      driven.record.result.error = failure_text(run, place);
      if (!keeps && recording_kept_.exchange(true)) remove_recording(folder);
    }
    if (!run.score || keeps) {
      staged.commit();
    } else {
      std::error_code stays;
      fs::remove_all(request_.out / place, stays);  // of a failure before
    }
  }

  Driven drive(const Drive& one, const std::function<void(double)>& progress) {
    Driven driven;
    UnitRecord& record = driven.record;
    record.cpu = cpu_identity();
    record.result.values.resize(study_measures().size());
    CallersStop stop;
    const auto told = [&](double share) { stop.ask([&] { progress(share); }); };
    const auto start = std::chrono::steady_clock::now();
    try {
      if (one.config.external_mapper.used()) {
        drive_external(one, told, driven);
      } else {
        take(run_closed_loop(one.config, one.in_hall->shared->scene, {}, [&](double share, const ObjectMap&) { told(share); }).score,
             record.result);
      }
    } catch (const Error& error) {
      stop.pass_on();
      record.result.error = error.what();
    }
    record.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return driven;
  }

  // As many at a time as there are threads and memory, each on one thread: what a drive cannot share among threads then costs nothing.
  // `untried`: no drive of the study has gone well yet, so that a command which the shell cannot start has stopped all.
  void drive_side_by_side(const std::vector<const Drive*>& drives, bool untried) {
    constexpr double kBytes = 1e9;  // of a drive, generously
    std::size_t jobs = static_cast<std::size_t>(request_.jobs);
    // What another mapper needs nobody knows.
    const bool external = std::any_of(drives.begin(), drives.end(), [](const Drive* one) { return one->config.external_mapper.used(); });
    if (jobs == 0) jobs = external ? 1 : std::min(static_cast<std::size_t>(thread_count()), jobs_in_memory(kBytes));
    const bool one_command = std::all_of(drives.begin(), drives.end(), [&](const Drive* one) {
      return one->config.external_mapper.command == drives.front()->config.external_mapper.command;
    });
    std::atomic<std::size_t> next = 0;
    std::mutex mutex;
    std::map<std::size_t, double> shares;  // of the drives under way
    std::size_t done = 0;
    std::exception_ptr stopped;  // by whatever came first: all end by it
    const auto work = [&](std::size_t) {
      for (std::size_t i = next++; i < drives.size(); i = next++) {
        const Drive& one = *drives[i];
        const Driven driven = drive(one, [&](double share) {
          const std::lock_guard lock(mutex);
          if (stopped) std::rethrow_exception(stopped);
          try {
            check();
            shares[i] = share;
            double all = static_cast<double>(done);
            for (const auto& under_way : shares) all += under_way.second;
            const auto of = static_cast<double>(drives.size());
            report({"runs", one.text(setup_.candidates), static_cast<int>(i) + 1, static_cast<int>(drives.size()), all / of});
          } catch (...) {
            stopped = std::current_exception();  // the others hear of it, too
            throw;
          }
        });
        store_.write(one.unit, unit_text(driven.record));
        const std::lock_guard lock(mutex);
        shares.erase(i);
        if (done++ == 0 && untried && one_command && tells_of_no_program(driven.exit_code) && !stopped) {
          stopped = std::make_exception_ptr(
              Error(request_.file, "stopped, as all drives have the command of the first one: " + driven.record.result.error));
        }
        if (stopped) std::rethrow_exception(stopped);
      }
    };
    check();
    jobs = std::min(jobs, drives.size());
    if (jobs == 1) {
      work(0);  // on all threads
    } else {
      run_side_by_side(jobs, work);
    }
  }

  void drive_all(StudySummary& summary) {
    const std::vector<Drive> all = drives();
    const int count = static_cast<int>(all.size());
    summary.runs = count;
    // Nobody takes an earlier study's verdict for this one's; but one that would only be made again stays.
    std::vector<bool> done;
    for (const Drive& one : all) done.push_back(is_done(one.unit));
    if (!request_.merge_only && std::find(done.begin(), done.end(), false) != done.end()) remove_results(request_.out);
    std::vector<const Drive*> to_do;
    for (int i = 0; i < count; ++i) {
      if (request_.merge_only || !request_.shard.has(i)) continue;
      if (done[static_cast<std::size_t>(i)]) {
        ++summary.found;
        const ExternalMapper& mapper = all[static_cast<std::size_t>(i)].config.external_mapper;
        if (mapper.used() && mapper.depends.empty()) ++summary.found_unwatched;
      } else {
        to_do.push_back(&all[static_cast<std::size_t>(i)]);
      }
    }
    if (!request_.merge_only) {
      std::map<std::string, std::string> units;
      for (const Drive& one : all) units[one.name(setup_.candidates)] = one.unit;
      remove_other_drives(request_.out, units);
    }
    drive_side_by_side(to_do, std::find(done.begin(), done.end(), true) == done.end());
    times_ = "candidate,hall,seed,wall_s\n";
    for (const Drive& one : all) {
      const std::optional<std::string> text = store_.result(one.unit);
      if (!text) {
        ++summary.missing;
        continue;
      }
      UnitRecord record = read_unit(*text, store_.file(one.unit));
      kinds_of_cpu_.insert(record.cpu);
      times_ += setup_.candidates[one.candidate].name + "," + one.in_hall->hall + "," + std::to_string(one.config.scenario.seed) + "," +
                std::to_string(record.wall_s) + "\n";
      record.result.hall = one.in_hall->hall;
      record.result.seed = one.config.scenario.seed;
      results_[one.candidate].runs.push_back(std::move(record.result));
    }
  }

  const StudyRequest& request_;
  const StudyHooks& hooks_;
  StudySetup setup_;
  UnitStore store_;
  std::vector<CandidateResult> results_;  // as many as candidates
  std::set<std::string> kinds_of_cpu_;
  std::atomic<bool> recording_kept_ = false;  // of a mapper's failure
  std::string times_;                         // timing.csv: apart from the results, which are the same whoever made them
};

}  // namespace

StudySummary run_study(const StudyRequest& request, const StudyHooks& hooks) { return StudyRunner(request, hooks).run(); }

}  // namespace waretwin

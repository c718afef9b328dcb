#include "harness/study/study_text.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/version.h"
#include "harness/gate/markdown_table.h"
#include "harness/score/number_text.h"
#include "harness/study/condition.h"

namespace waretwin {

namespace {

using Json = nlohmann::ordered_json;

Json json_of(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

Json json_of(const Interval& interval) {
  return {{"mean", interval.mean}, {"low", json_of(interval.low)}, {"high", json_of(interval.high)}};
}

Json json_of_value(const std::string& value) {
  const std::optional<double> number = as_number(value);
  return number ? Json(*number) : Json(value);
}

Json json_of(const CandidateResult& candidate, const StudySetup& setup, const CoverageMaps& maps) {
  Json json = {{"number", candidate.number}, {"name", candidate.name}};
  std::size_t index = 0;
  for (const auto& entry : setup.study.vary) json["values"][entry.first] = json_of_value(candidate.values[index++]);
  json["settings"] = Json::array();
  for (const Setting& setting : setup.candidates[static_cast<std::size_t>(candidate.number)].settings)
    json["settings"].push_back(setting.key + "=" + setting.value);
  json["state"] = name_of(candidate.state);
  json["feasible"] = candidate.feasible();
  json["broken"] = candidate.broken;
  json["pareto"] = candidate.on_front;
  json["measures"] = Json::object();
  for (std::size_t m = 0; m < study_measures().size(); ++m) {
    if (!candidate.measured[m]) continue;
    Json& measure = json["measures"][study_measures()[m].name] = json_of(*candidate.measured[m]);
    if (candidate.difference[m]) measure["difference"] = json_of(*candidate.difference[m]);
  }
  json["coverage"] = Json::object();
  for (const auto& [hall, values] : candidate.halls) {
    for (std::size_t m = 0; m < values.size(); ++m) {
      if (study_measures()[m].source == MeasureSource::kCoverage) json["coverage"][hall][study_measures()[m].name] = json_of(values[m]);
    }
  }
  json["runs"] = Json::array();
  for (const StudyRunResult& run : candidate.runs) {
    Json entry = {{"hall", run.hall}, {"seed", run.seed}, {"digest", run.digest}, {"error", run.error}, {"measures", Json::object()}};
    for (std::size_t m = 0; m < run.values.size(); ++m) {
      if (run.values[m]) entry["measures"][study_measures()[m].name] = *run.values[m];
    }
    json["runs"].push_back(std::move(entry));
  }
  const auto pictures = maps.find(candidate.number);
  json["coverage_maps"] = pictures == maps.end() ? std::vector<std::string>() : pictures->second;
  return json;
}

std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

std::string cell(const std::optional<double>& value) { return value ? number_text(*value) : ""; }

std::vector<std::size_t> judged(const StudyConfig& study) {
  std::vector<std::size_t> indices;
  for (const std::string& name : study.judge.measures) indices.push_back(*study_measure(name));
  return indices;
}

std::string interval_text(const std::optional<Interval>& interval) {
  if (!interval) return "-";
  std::string text = number("%+.4f", interval->mean);
  if (interval->low) text += " (" + number("%+.4f", interval->low) + " to " + number("%+.4f", interval->high) + ")";
  return text;
}

std::string table_of(const StudyConfig& study, const std::vector<const CandidateResult*>& candidates) {
  std::vector<std::vector<std::string>> rows = {{"candidate"}};
  for (const auto& entry : study.vary) rows.front().push_back(entry.first);
  for (const std::string& name : study.judge.measures) rows.front().push_back(name);
  rows.front().emplace_back("");
  for (const CandidateResult* candidate : candidates) {
    std::vector<std::string>& row = rows.emplace_back();
    row.push_back(candidate->name);
    row.insert(row.end(), candidate->values.begin(), candidate->values.end());
    for (const std::size_t m : judged(study)) {
      const std::optional<Interval>& interval = candidate->measured[m];
      row.push_back(number("%.4g", interval ? std::optional(interval->mean) : std::nullopt));
    }
    row.push_back(std::string(candidate->number == 0 ? "baseline " : "") + (candidate->on_front ? "front " : "") +
                  (candidate->feasible() ? "" : "breaks a constraint"));
  }
  return markdown_table(rows, 1, true);
}

std::string effects_text(const StudyConfig& study, const StudyResults& results) {
  std::string text;
  for (const std::string& measure : study.judge.measures) {
    std::vector<std::vector<std::string>> rows = {{"factor", "level", "mean", "interval", "candidates"}};
    for (const FactorEffect& effect : results.effects) {
      if (effect.measure != measure || effect.levels.size() < 2) continue;
      for (const EffectLevel& level : effect.levels) {
        const Interval& i = level.interval;
        rows.push_back({effect.factor, level.level, number("%.4f", i.mean),
                        i.low ? number("%.4f", i.low) + " to " + number("%.4f", i.high) : "-", std::to_string(i.count)});
      }
    }
    if (rows.size() > 1) text += "### " + measure + "\n\n" + markdown_table(rows, 2) + "\n";
  }
  return text;
}

}  // namespace

std::string values_text(const StudyConfig& study, const DesignPoint& values) {
  std::string text;
  std::size_t index = 0;
  for (const auto& entry : study.vary) text += (text.empty() ? "" : ", ") + entry.first + " " + values[index++];
  return text;
}

std::string verdict_text(const StudyConfig& study, const StudyResults& results) {
  if (!results.best) {
    const std::size_t by = *study_measure(results.best_by);
    const bool measured = std::any_of(results.candidates.begin(), results.candidates.end(),
                                      [&](const CandidateResult& candidate) { return candidate.feasible() && candidate.measured[by]; });
    const bool feasible = std::any_of(results.candidates.begin(), results.candidates.end(),
                                      [](const CandidateResult& candidate) { return candidate.feasible(); });
    if (!feasible) return "none: every candidate breaks a constraint, or could not be driven";
    return measured ? "none: no candidate has " + results.best_by + " in every drive"
                    : "none: no candidate has a value of " + results.best_by + " (a hall without true objects has none)";
  }
  const CandidateResult& best = results.candidates[*results.best];
  const CandidateResult& baseline = results.candidates.front();
  const std::size_t by = *study_measure(results.best_by);
  const auto mean = [&](const CandidateResult& candidate) {
    return number("%.4f", candidate.measured[by] ? std::optional(candidate.measured[by]->mean) : std::nullopt);
  };
  std::string text = best.name + " (" + values_text(study, best.values) + ") has " + results.best_by + " " + mean(best);
  if (best.number == baseline.number) return text + ": the baseline is the best";
  text += "; the baseline (" + values_text(study, baseline.values) + ") " + mean(baseline);
  const std::optional<Interval>& difference = best.difference[by];
  if (!difference) return text;
  text += ": " + number("%+.4f", difference->mean);
  if (difference->low) {
    text += " (" + number("%.0f %%", 100.0 * study.judge.confidence) +
            " of the paired differences' mean: " + number("%+.4f", difference->low) + " to " + number("%+.4f", difference->high) + ")";
  }
  return text;
}

std::string study_json(const StudySetup& setup, const StudyResults& results, const CoverageMaps& maps) {
  const StudyConfig& study = setup.study;
  Json json = {{"schema", "waretwin-study-1"}, {"name", study.name}, {"description", study.description}, {"version", kVersion}};
  json["factors"] = Json::array();
  for (const auto& [name, factor] : study.vary) json["factors"].push_back({{"name", name}, {"key", factor.key}});
  json["measures"] = Json::array();
  for (const std::size_t m : judged(study)) {
    const StudyMeasure& measure = study_measures()[m];
    json["measures"].push_back({{"name", measure.name},
                                {"text", measure.what},
                                {"better", measure.more_is_better ? "more" : "less"},
                                {"source", measure.source == MeasureSource::kRun ? "run" : "coverage"}});
  }
  json["best_by"] = results.best_by;
  json["confidence"] = study.judge.confidence;
  json["baseline"] = 0;
  json["best"] = results.best ? Json(results.candidates[*results.best].number) : Json(nullptr);
  json["verdict"] = verdict_text(study, results);
  json["halls"] = Json::array();
  for (const auto& entry : study.halls) json["halls"].push_back(entry.first);
  json["seeds"] = Json::array();
  for (const double seed : study.seeds) json["seeds"].push_back(static_cast<std::uint64_t>(seed));
  json["constraints"] = study.constraints;
  json["candidates"] = Json::array();
  for (const CandidateResult& candidate : results.candidates) json["candidates"].push_back(json_of(candidate, setup, maps));
  json["pareto"] = {{"measures", results.pareto}, {"candidates", Json::array()}};
  for (const CandidateResult& candidate : results.candidates) {
    if (candidate.on_front) json["pareto"]["candidates"].push_back(candidate.number);
  }
  json["effects"] = Json::array();
  for (const FactorEffect& effect : results.effects) {
    Json entry = {{"factor", effect.factor}, {"measure", effect.measure}, {"levels", Json::array()}};
    for (const EffectLevel& level : effect.levels) {
      Json one = {{"level", level.level}};
      one.update(json_of(level.interval));
      one["candidates"] = level.interval.count;
      entry["levels"].push_back(std::move(one));
    }
    json["effects"].push_back(std::move(entry));
  }
  return json.dump(1) + "\n";
}

std::string study_csv(const StudyConfig& study, const StudyResults& results) {
  std::string csv = "candidate";
  for (const auto& entry : study.vary) csv += "," + entry.first;
  csv += ",state,feasible,front,broken";
  for (const std::string& name : study.judge.measures)
    csv +=
        "," + name + "," + name + "_low," + name + "_high," + name + "_difference," + name + "_difference_low," + name + "_difference_high";
  csv += "\n";
  const auto cells = [](const std::optional<Interval>& interval) {
    return interval ? "," + number_text(interval->mean) + "," + cell(interval->low) + "," + cell(interval->high) : std::string(",,,");
  };
  for (const CandidateResult& candidate : results.candidates) {
    csv += candidate.name;
    for (const std::string& value : candidate.values) csv += "," + csv_text(value);
    std::string broken;
    for (const std::string& text : candidate.broken) broken += (broken.empty() ? "" : "; ") + text;
    csv += std::string(",") + name_of(candidate.state) + (candidate.feasible() ? ",1" : ",0") + (candidate.on_front ? ",1," : ",0,") +
           csv_text(broken);
    for (const std::size_t m : judged(study)) csv += cells(candidate.measured[m]) + cells(candidate.difference[m]);
    csv += "\n";
  }
  return csv;
}

std::string runs_csv(const StudyConfig& study, const StudyResults& results) {
  std::string csv = "candidate";
  for (const auto& entry : study.vary) csv += "," + entry.first;
  csv += ",hall,seed,digest,error";
  for (const StudyMeasure& measure : study_measures()) csv += "," + measure.name;
  csv += "\n";
  for (const CandidateResult& candidate : results.candidates) {
    for (const StudyRunResult& run : candidate.runs) {
      csv += candidate.name;
      for (const std::string& value : candidate.values) csv += "," + csv_text(value);
      csv += "," + run.hall + "," + std::to_string(run.seed) + "," + run.digest + "," + csv_text(run.error);
      const StudyValues& coverage = candidate.halls.at(run.hall);
      for (std::size_t m = 0; m < run.values.size(); ++m)
        csv += "," + cell(study_measures()[m].source == MeasureSource::kRun ? run.values[m] : coverage[m]);
      csv += "\n";
    }
  }
  return csv;
}

std::vector<std::string> failed_drives(const StudyResults& results) {
  std::vector<std::string> lines;
  for (const CandidateResult& candidate : results.candidates) {
    for (const StudyRunResult& run : candidate.runs) {
      if (!run.error.empty()) lines.push_back(candidate.name + " in " + run.hall + ", seed " + std::to_string(run.seed) + ": " + run.error);
    }
  }
  return lines;
}

std::string study_markdown(const StudySetup& setup, const StudyResults& results) {
  const StudyConfig& study = setup.study;
  std::string text = "# " + study.name + "\n\n";
  if (!study.description.empty()) text += study.description + "\n\n";
  const auto count = [&](CandidateState state) {
    return std::count_if(results.candidates.begin(), results.candidates.end(), [&](const CandidateResult& c) { return c.state == state; });
  };
  text += std::to_string(results.candidates.size()) + " candidates, " + std::to_string(study.halls.size()) + " hall" +
          (study.halls.size() > 1 ? "s" : "") + ", " + std::to_string(study.seeds.size()) + " seed" + (study.seeds.size() > 1 ? "s" : "") +
          "; " + std::to_string(count(CandidateState::kMapped)) + " mapped, " + std::to_string(count(CandidateState::kScreenedOut)) +
          " looked at by coverage alone, " + std::to_string(count(CandidateState::kRefused)) + " refused by constraints.\n\n";
  text += "**Best**: " + verdict_text(study, results) + ".\n\n";
  if (const std::vector<std::string> failed = failed_drives(results); !failed.empty()) {
    text += "**Not driven to the end:**\n\n";
    for (const std::string& line : failed) text += "- " + line + "\n";
    text += "\n";
  }
  if (results.best) {
    text += "`best/` has its configuration for each hall: `waretwin run SCENARIO --out OUT --config best/HALL.yaml` drives it.\n\n";
    const CandidateResult& best = results.candidates[*results.best];
    std::vector<std::vector<std::string>> rows = {{"measure", "baseline", "best", "difference"}};
    for (const std::size_t m : judged(study)) {
      const auto mean = [&](const CandidateResult& c) {
        return number("%.4f", c.measured[m] ? std::optional(c.measured[m]->mean) : std::nullopt);
      };
      rows.push_back({study_measures()[m].name, mean(results.candidates.front()), mean(best), interval_text(best.difference[m])});
    }
    if (best.number != 0) text += markdown_table(rows, 1) + "\n";
  }
  std::vector<const CandidateResult*> front;
  for (const CandidateResult* candidate : ranked(results)) {
    if (candidate->on_front) front.push_back(candidate);
  }
  if (!front.empty()) {
    text += "## Pareto front\n\nNo other is better in one of ";
    for (std::size_t i = 0; i < results.pareto.size(); ++i) text += (i > 0 ? ", " : "") + results.pareto[i];
    text += " without being worse in another.\n\n" + table_of(study, front) + "\n![Pareto front](plots/pareto.png)\n\n";
  }
  constexpr std::size_t kMostRows = 60;
  std::vector<const CandidateResult*> all = ranked(results);
  text += "## Candidates, by " + results.best_by + "\n\n";
  if (all.size() > kMostRows) {
    text += "The first " + std::to_string(kMostRows) + "; results.csv has all.\n\n";
    all.resize(kMostRows);
  }
  text += table_of(study, all) +
          "\n## Main effects\n\nWhat the candidates of a level have on average, all other factors being equal (least squares over "
          "candidates).\n\n" +
          effects_text(study, results);
  return text;
}

}  // namespace waretwin

#include "harness/study/study_config.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>

#include "core/config.h"
#include "core/error.h"
#include "harness/study/condition.h"
#include "harness/study/design.h"
#include "harness/study/study_measures.h"

namespace waretwin {

namespace {

// Of columns, files and conditions.
bool is_plain_name(const std::string& name) {
  return !name.empty() && std::isalpha(static_cast<unsigned char>(name.front())) != 0 &&
         std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; });
}

void check_measures(Fields& f, const char* key, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (!study_measure(name)) f.reject(key, "'" + name + "' is no measure; expected one of " + study_measure_names());
  }
}

}  // namespace

void Factor::visit(Fields& f) {
  f("key", key, "configuration key that varies, as for --set", {.required = true});
  f("also", also, "other keys that take the same value");
  f("values", values, "numbers or words; in a list, side by side with the other factors' values");
  f("from", from, "or a range: its lower end");
  f("to", to, "its upper end");
  f("steps", steps, "of the range in a grid, ends included", {.min = 1, .max = 1e5});
  f("multiple_of", multiple_of,
    "values of the range are rounded to multiples of this, e.g. 1 for whole numbers; 0: three digits finer than it",
    {.min = 0, .max = 1e9});
  f("baseline", baseline, "value of the candidate that the others are compared with; empty: as the halls' scenarios have it");
  if (key.empty()) f.reject("key", "is empty; expected a configuration key");
  if (key == "seed" || std::count(also.begin(), also.end(), "seed") > 0)
    f.reject("key", "is 'seed', which all candidates share; expected another, and seeds under `seeds`");
  if (values.empty() == !from.has_value()) f.reject("values", "expected either values, or from and to");
  if (from.has_value() != to.has_value()) f.reject(from ? "from" : "to", "is named alone; expected from and to");
  if (from && !(*from < *to)) f.reject("to", "is not above from; expected from < to");
}

void StudyHall::visit(Fields& f) {
  f("scenario", scenario, "scenario file, from the study's folder; or `generate`");
  f.group("generate", generate, "a hall drawn as `waretwin generate` does; `style` must be named");
  check_hall_source(f, scenario, generate);
}

void StudyRun::visit(Fields& f) {
  choice.visit(f);
  f("set", set, "key=value, as for run --set; before what varies");
}

void ScreenConfig::visit(Fields& f) {
  f("keep", keep, "candidates that are mapped, the best by coverage, beside the baseline; 0: all", {.min = 0, .max = 1e6});
  f("by", by, "measure of coverage that chooses them");
  const std::optional<std::size_t> measure = study_measure(by);
  if (!measure || study_measures()[*measure].source != MeasureSource::kCoverage)
    f.reject("by", "'" + by + "' is no measure of coverage; expected object_coverage, floor_coverage or the like");
}

void CoverageConfig::visit(Fields& f) {
  f("floor_spacing_m", floor_spacing_m, "between points on the floor", {.min = 0.02, .max = 2});
  f("points_per_object", points_per_object, "on the surface of each true object", {.min = 10, .max = 1e5});
  f("place_spacing_m", place_spacing_m, "between places where a camera might look from", {.min = 0.1, .max = 5});
  f("heights_m", heights_m, "at which it might", {.min = 0.01, .max = 100});
  f("least_m", least_m, "nearest that it might see", {.min = 0, .max = 100});
  f("reach_m", reach_m, "farthest that it might see", {.min = 0.1, .max = 1000});
  f("rate_hz", rate_hz, "looks a second along the route", {.min = 0.01, .max = 100});
  f("blind_radius_m", blind_radius_m, "around the vehicle's outline, in which blind zones are counted", {.min = 0.1, .max = 20});
  if (heights_m.empty()) f.reject("heights_m", "is empty; expected at least one height");
  if (!(least_m < reach_m)) f.reject("reach_m", "is not above least_m");
}

void JudgeConfig::visit(Fields& f) {
  f("measures", measures, "in tables and plots");
  f("best_by", best_by, "measure that says which mount is best");
  f("pareto", pareto, "two measures or more that no mount can be better in at the same time");
  f("confidence", confidence, "of intervals", {.min = 0.5, .max = 0.999});
  check_measures(f, "measures", measures);
  check_measures(f, "best_by", {best_by});
  check_measures(f, "pareto", pareto);
  if (pareto.size() < 2) f.reject("pareto", "has fewer than two measures; expected at least two");
}

void StudyConfig::visit(Fields& f) {
  f("name", name, "of the study, in reports");
  f("description", description, "one line for people");
  f.map("halls", halls, "halls by name; every candidate drives through each");
  f("seeds", seeds, "of sensors and motion; every candidate is driven with each, so that differences are differences of the mount",
    {.min = 0, .max = 9e15});
  f("vehicle", vehicle, "a part of a configuration laid over every hall's, from the study's folder: more cameras, other lasers");
  f("vehicle_model", vehicle_model, "glTF of the vehicle, from the study's folder, that stands in its sensors' view");
  f.group("run", run, "how every hall is driven and mapped");
  f.map("vary", vary, "what varies, by names for tables");
  f("design", design, "grid: all combinations; list: values side by side; random; sobol: evenly spread",
    {.choices = {"grid", "list", "random", "sobol"}});
  f("points", points, "random, sobol: candidates beside the baseline", {.min = 1, .max = static_cast<double>(kMostCandidates)});
  f("design_seed", design_seed, "of the random design");
  f("constraints", constraints, "NAME OP VALUE over factors and measures, e.g. height < 1.6; who breaks one is no best mount");
  f.group("screen", screen, "choosing by coverage alone before anything is mapped");
  f.group("coverage", coverage, "how coverage and blind zones are measured");
  f.group("judge", judge, "what is judged");
  f("coverage_maps", coverage_maps, "pictures of what the best candidates see, beside the baseline's", {.min = 0, .max = 1e6});

  if (halls.empty()) f.reject("halls", "is empty; expected at least one hall by name");
  for (const auto& entry : halls) {
    if (!is_plain_name(entry.first)) f.reject("halls", "'" + entry.first + "'; expected a name of letters, digits, '-' and '_'");
  }
  if (seeds.empty()) f.reject("seeds", "is empty; expected at least one");
  for (const double seed : seeds) {
    if (seed != std::floor(seed)) f.reject("seeds", "has " + number_text(seed) + "; expected whole numbers");
    if (std::count(seeds.begin(), seeds.end(), seed) > 1) f.reject("seeds", "has " + number_text(seed) + " twice");
  }
  if (vary.empty()) f.reject("vary", "is empty; expected at least one factor by name");
  for (const auto& [factor_name, factor] : vary) {
    if (!is_plain_name(factor_name)) f.reject("vary", "'" + factor_name + "'; expected a name of letters, digits, '-' and '_'");
    static const std::set<std::string> kColumns = {"candidate", "state", "feasible", "front", "broken", "hall", "seed", "digest", "error"};
    if (kColumns.contains(factor_name)) f.reject("vary", "'" + factor_name + "' is a column of the results; expected another name");
    if (study_measure(factor_name)) f.reject("vary", "'" + factor_name + "' is a measure's name; expected another");
    if (design != "list") continue;
    if (factor.is_range()) f.reject("vary", "'" + factor_name + "' is a range; expected values in design list");
    if (factor.values.size() != vary.begin()->second.values.size()) {
      f.reject("vary", "'" + factor_name + "' has " + std::to_string(factor.values.size()) + " values and '" + vary.begin()->first + "' " +
                           std::to_string(vary.begin()->second.values.size()) + "; expected as many, side by side, in design list");
    }
  }
  for (const std::string& text : constraints) {
    try {
      const Condition condition = Condition::parse(text);
      const auto factor = vary.find(condition.name());
      const auto is_word = [](const std::string& value) { return !as_number(value); };
      if (factor != vary.end() && condition.is_order() && std::any_of(factor->second.values.begin(), factor->second.values.end(), is_word))
        f.reject("constraints", "'" + text + "': '" + condition.name() + "' has words for values; expected == or !=");
      if (factor == vary.end() && !study_measure(condition.name()))
        f.reject("constraints", "'" + text + "': '" + condition.name() + "' is neither a factor nor a measure");
    } catch (const Error& error) {
      f.reject("constraints", error.what());
    }
  }
}

StudyConfig read_study(const std::filesystem::path& file) {
  StudyConfig study;
  read_config(file, [&](Fields& f) { f.group("study", study, "a mounting study", {.required = true}); });
  return study;
}

}  // namespace waretwin

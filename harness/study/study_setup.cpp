#include "harness/study/study_setup.h"

#include <algorithm>
#include <cstdio>
#include <set>

#include "core/config_value.h"
#include "core/digest.h"
#include "core/error.h"
#include "core/field_values.h"
#include "harness/gate/measures.h"
#include "harness/run/external_run.h"
#include "harness/study/condition.h"
#include "harness/study/study.h"
#include "harness/study/study_results.h"
#include "harness/units/units.h"
#include "mapper/stages.h"

namespace waretwin {

namespace fs = std::filesystem;

namespace {

constexpr const char* kOwnKeys = "study.";

StudyConfig read_with_settings(const StudyRequest& request) {
  StudyConfig study = read_study(request.file);
  std::vector<Setting> own;
  for (const Setting& setting : request.settings) {
    if (setting.key.starts_with(kOwnKeys)) own.push_back(setting);
  }
  if (!own.empty()) apply_settings(own, [&](Fields& f) { f.group("study", study, ""); });
  if (request.seed) {
    constexpr std::uint64_t kMost = 9'000'000'000'000'000;  // as study.seeds
    if (*request.seed > kMost) throw Error("--seed " + std::to_string(*request.seed) + ": expected at most " + std::to_string(kMost));
    for (std::size_t i = 0; i < study.seeds.size(); ++i) study.seeds[i] = static_cast<double>(*request.seed + i);
  }
  return study;
}

// All that makes a hall's scene; sensors, route and seed have no part in it.
std::string text_of_hall(Scenario& scenario) {
  return scenario.file.string() + "\n" + write_config([&](Fields& f) {
           f.list("models", scenario.models, "");
           f.list("truth", scenario.truth, "");
           f.group("lighting", scenario.lighting, "");
           f.group("motion", scenario.motion, "");
           f("vehicle", scenario.robot.model, "");
         });
}

class Halls {
 public:
  std::shared_ptr<SharedHall> of(Scenario& scenario) {
    std::shared_ptr<SharedHall>& hall = known_[text_of_hall(scenario)];
    if (!hall) {
      hall = std::make_shared<SharedHall>();
      hall->scene = std::make_shared<const Scene>(build_scene(scenario));
      hall->digest = digest_of(*hall->scene);
    }
    return hall;
  }

 private:
  std::map<std::string, std::shared_ptr<SharedHall>> known_;
};

// A hall's name and its scenario file.
struct HallBase {
  std::string name;
  fs::path scenario;
};

std::string outline_of(const RobotConfig& robot) {
  return number_text(robot.length_m) + " x " + number_text(robot.width_m) + " x " + number_text(robot.height_m);
}

// Keys that would be set twice, of which one would do nothing.
void check_keys(const StudyConfig& study, const std::vector<Setting>& given) {
  std::set<std::string> varied;
  for (const auto& [name, factor] : study.vary) {
    for (const std::string& key : factor.also) {
      if (!varied.insert(key).second) throw Error("vary." + name + ".also: '" + key + "' varies already; expected each key once");
    }
    if (!varied.insert(factor.key).second)
      throw Error("vary." + name + ".key: '" + factor.key + "' varies already; expected each key once");
  }
  if (varied.contains("robot.model") && !study.vehicle_model.empty())
    throw Error("vehicle_model: robot.model varies; expected one of them");
  for (const std::string& text : study.run.set) {
    if (parse_setting(text).key == "seed") throw Error("run.set: '" + text + "'; expected seeds under study.seeds");
  }
  for (const Setting& setting : given) {
    if (setting.key == "seed") throw Error("--set seed: expected --seed, or study.seeds");
    if (varied.contains(setting.key)) throw Error("--set " + setting.key + ": varies in this study; expected another key");
  }
}

// A setting's value is read as YAML, and what a factor names for a text (a command, say) is that text, whatever stands in it.
std::string as_setting(const std::string& key, const std::string& value) {
  RunConfig config;
  return is_text(key, [&](Fields& f) { config.visit(f); }) ? text_as_yaml(value) : value;
}

std::vector<Setting> settings_of(const StudyConfig& study, const DesignPoint& values) {
  std::vector<Setting> settings;
  std::size_t index = 0;
  for (const auto& [name, factor] : study.vary) {
    const std::string& value = values[index++];
    if (value.empty()) continue;
    settings.push_back({factor.key, as_setting(factor.key, value)});
    for (const std::string& key : factor.also) settings.push_back({key, as_setting(key, value)});
  }
  return settings;
}

// The surface against the hall takes seconds a run: only where somebody asks.
bool judges_surface(const StudyConfig& study) {
  const auto is_surface = [](const std::string& text) { return text.starts_with("surface_"); };
  const auto any = [&](const std::vector<std::string>& names) { return std::any_of(names.begin(), names.end(), is_surface); };
  return any(study.judge.measures) || any(study.judge.pareto) || any(study.constraints) || is_surface(study.judge.best_by);
}

// By what another mapper has no value of nobody is the best; in tables it is missing.
void expect_judged_without_ours(const StudyConfig& study) {
  const auto check = [](const std::string& key, const std::string& name) {
    for (const Measure& measure : measures()) {
      if (measure.ours && name == measure.name)
        throw Error(key + ": " + name + " comes of our own mapper's stages; expected another measure with another mapper");
    }
  };
  check("judge.best_by", study.judge.best_by);
  for (const std::string& name : study.judge.pareto) check("judge.pareto", name);
  for (const std::string& text : study.constraints) check("constraints", Condition::parse(text).name());
}

RunConfig configuration(const StudyConfig& study, const StudyRequest& request, const HallBase& hall, const std::vector<Setting>& varied) {
  const fs::path folder = request.file.parent_path();
  RunChoice choice = study.run.choice;
  choice.detector = detector_beside(choice.detector, folder);
  RunConfig base = chosen_run(choice);
  // A mount that does not show an object is not excused for it, and nobody reads the frames.
  base.score.min_visible_fraction = 0.0;
  base.truth_frames.enabled = false;
  base.extras = {.pictures = false, .depth = false, .surface = judges_surface(study), .visible_share = false};
  std::vector<Setting> all;
  for (const std::string& text : study.run.set) all.push_back(parse_setting(text));
  for (const Setting& setting : request.settings) {
    if (!setting.key.starts_with(kOwnKeys)) all.push_back(setting);
  }
  all.insert(all.end(), varied.begin(), varied.end());
  RunConfig config = load_run_config(hall.scenario, std::move(base), study.vehicle.empty() ? fs::path() : folder / study.vehicle, all);
  if (!study.vehicle_model.empty()) config.scenario.robot.model = fs::absolute(folder / study.vehicle_model);
  if (config.external_mapper.used()) {
    expect_none_of_ours(choice);
    check_external(config);
    expect_judged_without_ours(study);
  }
  return config;
}

std::string name_of(int number) {
  char name[16];
  std::snprintf(name, sizeof name, "c%03d", number);
  return name;
}

// The factors' values as the halls have them, "the hall's own" where these differ.
DesignPoint present_values(const StudyConfig& study, const Candidate& candidate) {
  DesignPoint values;
  for (const auto& [name, factor] : study.vary) {
    std::set<std::string> found;
    for (const CandidateInHall& in_hall : candidate.halls) {
      RunConfig config = in_hall.config;
      const std::optional<std::string> value = value_of(factor.key, [&](Fields& f) { config.visit(f); });
      if (!value) throw Error("vary." + name + ".key: no such configuration key '" + factor.key + "'");
      const std::optional<double> number = as_number(*value);
      found.insert(number ? number_text(*number) : *value);
    }
    values.push_back(found.size() == 1 ? *found.begin() : "the hall's own");
  }
  return values;
}

// Of each hall: candidates with equal ones are the same.
std::vector<std::string> texts_of(const Candidate& candidate) {
  std::vector<std::string> texts;
  for (const CandidateInHall& in_hall : candidate.halls) {
    RunConfig config = in_hall.config;
    texts.push_back(write_config([&](Fields& f) { config.visit(f); }));
  }
  return texts;
}

}  // namespace

std::shared_ptr<RayCaster> SharedHall::caster() {
  if (!caster_) {
    caster_ = std::make_shared<RayCaster>(scene);
    // What moves is somewhere else at every look.
    for (const Mover& mover : scene->movers) {
      for (const int instance : mover.instances) caster_->set_present(instance, false);
    }
    caster_->commit();
  }
  return caster_;
}

std::shared_ptr<const RayCaster> SharedHall::own_body() {
  if (!own_body_made_) own_body_ = own_body_of(*scene);
  own_body_made_ = true;
  return own_body_;
}

const CoverageHall& SharedHall::coverage(const RobotConfig& baseline_robot, const CoverageConfig& config) {
  std::unique_ptr<CoverageHall>& made = coverage_[outline_of(baseline_robot)];
  if (!made) made = std::make_unique<CoverageHall>(caster(), baseline_robot, config);
  return *made;
}

std::string StudySetup::run_config(const CandidateInHall& in_hall) const {
  RunConfig config = in_hall.config;
  config.scenario.seed = static_cast<std::uint64_t>(study.seeds.front());
  config.truth_frames = {};
  config.extras = {};
  // A configuration names models from the scenario's folder.
  std::string note;
  if (config.scenario.robot.model.is_absolute()) {
    const fs::path model =
        config.scenario.robot.model.lexically_relative(fs::absolute(config.scenario.file).parent_path().lexically_normal());
    const bool beside = !model.empty() && *model.begin() != "..";
    if (!beside)
      note = "# robot.model was " + config.scenario.robot.model.filename().string() + ", which is not in the scenario's folder\n";
    config.scenario.robot.model = beside ? model : fs::path();
  }
  return note + resolved_config([&](Fields& f) { config.visit(f); }, "study " + study.name + ", hall " + in_hall.hall);
}

StudySetup set_up_study(const StudyRequest& request, const std::function<void()>& check) {
  StudySetup setup;
  setup.file = request.file;
  setup.study = read_with_settings(request);
  const StudyConfig& study = setup.study;
  check();
  try {
    check_keys(study, request.settings);
  } catch (const Error& error) {
    throw Error(request.file, error.what());
  }
  const auto looked_at = [&](const std::string& who, const auto& act) {
    check();
    try {
      act();
    } catch (const Error& error) {
      check();  // stopped
      throw Error(request.file, who + ": " + error.what());
    }
  };
  std::vector<HallBase> bases;
  for (const auto& [name, hall] : study.halls) {
    looked_at("hall '" + name + "'", [&, hall_name = name, drawn = hall] {
      const fs::path scenario = drawn.generate.asked_for() ? draw_hall_once(drawn.generate.config, request.out, check) / "scenario.yaml"
                                                           : request.file.parent_path() / drawn.scenario;
      bases.push_back({hall_name, scenario});
    });
  }
  Halls halls;
  std::vector<RobotConfig> robots;  // of the baseline, by hall
  const auto complete = [&](Candidate& candidate) {
    for (std::size_t k = 0; k < bases.size(); ++k) {
      looked_at("candidate " + candidate.name + " in hall '" + bases[k].name + "'", [&] {
        RunConfig config = configuration(study, request, bases[k], candidate.settings);
        std::shared_ptr<SharedHall> shared = halls.of(config.scenario);
        if (robots.size() == k) robots.push_back(config.scenario.robot);
        candidate.halls.push_back({bases[k].name, std::move(config), std::move(shared), robots[k]});
      });
    }
  };
  // The baseline has the values that the study names; of the others it has the halls'.
  Candidate baseline;
  baseline.name = name_of(0);
  for (const auto& entry : study.vary) baseline.values.push_back(entry.second.baseline);
  baseline.settings = settings_of(study, baseline.values);
  complete(baseline);
  looked_at("the baseline", [&] {
    baseline.values = present_values(study, baseline);
    const RunConfig& config = baseline.halls.front().config;
    if (!config.truth_stages.detector && !config.external_mapper.used()) make_detector(config.mapper);  // throws where it cannot be
  });
  baseline.refused = broken_by_values(study, baseline.values).value_or("");
  const std::vector<std::string> baseline_texts = texts_of(baseline);
  setup.candidates.push_back(std::move(baseline));
  std::vector<DesignPoint> points;
  looked_at("the design", [&] { points = design_points(study); });
  for (const DesignPoint& point : points) {
    Candidate candidate;
    candidate.number = static_cast<int>(setup.candidates.size());
    candidate.name = name_of(candidate.number);
    candidate.values = point;
    candidate.refused = broken_by_values(study, point).value_or("");
    candidate.settings = settings_of(study, point);
    if (candidate.refused.empty()) {
      complete(candidate);
      if (texts_of(candidate) == baseline_texts) continue;
      candidate.values = present_values(study, candidate);  // as the configuration reads them: yes is true
    }
    setup.candidates.push_back(std::move(candidate));
  }
  return setup;
}

}  // namespace waretwin

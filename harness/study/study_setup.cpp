#include "harness/study/study_setup.h"

#include <algorithm>
#include <cstdio>
#include <set>

#include "core/config_value.h"
#include "core/digest.h"
#include "core/error.h"
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
      Digest digest;
      add_scene(*hall->scene, digest);
      hall->digest = digest.hex();
    }
    return hall;
  }

 private:
  std::map<std::string, std::shared_ptr<SharedHall>> known_;
};

// What every candidate of a hall begins with.
struct HallBase {
  std::string name;
  fs::path scenario;
};

std::vector<Setting> settings_of(const StudyConfig& study, const DesignPoint& values) {
  std::vector<Setting> settings;
  std::size_t index = 0;
  for (const auto& [name, factor] : study.vary) {
    const std::string& value = values[index++];
    if (value.empty()) continue;
    settings.push_back({factor.key, value});
    for (const std::string& key : factor.also) settings.push_back({key, value});
  }
  return settings;
}

// The surface against the hall takes seconds a run: only where somebody asks.
bool judges_surface(const StudyConfig& study) {
  const auto is_surface = [](const std::string& text) { return text.starts_with("surface_"); };
  const auto any = [&](const std::vector<std::string>& names) { return std::any_of(names.begin(), names.end(), is_surface); };
  return any(study.judge.measures) || any(study.judge.pareto) || any(study.constraints) || is_surface(study.judge.best_by);
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
  return config;
}

std::string name_of(int number) {
  char name[16];
  std::snprintf(name, sizeof name, "c%03d", number);
  return name;
}

// The factors' values where the study does not name the baseline's: those that the halls have.
DesignPoint present_values(const StudyConfig& study, RunConfig config) {
  DesignPoint values;
  for (const auto& [name, factor] : study.vary) {
    const std::optional<std::string> value = value_of(factor.key, [&](Fields& f) { config.visit(f); });
    if (!value) throw Error("vary." + name + ".key: no such configuration key '" + factor.key + "'");
    const std::optional<double> number = as_number(*value);
    values.push_back(number ? number_text(*number) : *value);
  }
  return values;
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

const CoverageHall& SharedHall::coverage(const RobotConfig& robot, const CoverageConfig& config) {
  if (!coverage_) coverage_ = std::make_unique<CoverageHall>(caster(), robot, config);
  return *coverage_;
}

std::string StudySetup::run_command(const Candidate& candidate) const {
  const RunChoice& choice = study.run.choice;
  const auto& [name, hall] = *study.halls.begin();
  std::string command = "waretwin run " +
                        (hall.scenario.empty() ? "HALL/scenario.yaml" : (file.parent_path() / hall.scenario).lexically_normal().string()) +
                        " --out OUT --profile " + choice.profile;
  const auto option = [&command](const std::string& option_name, const std::string& value) {
    if (!value.empty()) command += " " + option_name + " " + value;
  };
  option("--detector", choice.detector.value_or(""));
  option("--poses", choice.poses);
  if (choice.depth != "sensor") option("--depth", choice.depth);
  if (choice.association != "map") option("--association", choice.association);
  if (choice.rate_hz) option("--rate", number_text(*choice.rate_hz));
  if (!study.vehicle.empty()) option("--config", (file.parent_path() / study.vehicle).lexically_normal().string());
  // Only a model beside the scenario can be named there.
  const std::filesystem::path hall_folder = (file.parent_path() / hall.scenario).parent_path();
  const std::filesystem::path model = (file.parent_path() / study.vehicle_model).lexically_relative(hall_folder);
  if (!study.vehicle_model.empty() && !model.empty() && *model.begin() != "..") command += " --set robot.model=" + model.string();
  for (const std::string& text : study.run.set) command += " --set " + text;
  for (const Setting& setting : candidate.settings) command += " --set " + setting.key + "=" + setting.value;
  return command;
}

StudySetup set_up_study(const StudyRequest& request, const std::function<void()>& check) {
  StudySetup setup;
  setup.file = request.file;
  setup.study = read_with_settings(request);
  const StudyConfig& study = setup.study;
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
  const auto complete = [&](Candidate& candidate) {
    candidate.settings = settings_of(study, candidate.values);
    for (const HallBase& base : bases) {
      looked_at("candidate " + candidate.name + " in hall '" + base.name + "'", [&] {
        RunConfig config = configuration(study, request, base, candidate.settings);
        std::shared_ptr<SharedHall> shared = halls.of(config.scenario);
        candidate.halls.push_back({base.name, std::move(config), std::move(shared)});
      });
    }
  };
  // The baseline has the values that the study names; of the others it has the hall's, which are read from its first one.
  Candidate baseline;
  baseline.name = name_of(0);
  for (const auto& entry : study.vary) baseline.values.push_back(entry.second.baseline);
  complete(baseline);
  looked_at("the baseline", [&] {
    baseline.values = present_values(study, baseline.halls.front().config);
    const RunConfig& config = baseline.halls.front().config;
    if (!config.truth_stages.detector) make_detector(config.mapper);  // throws where it cannot be
  });
  baseline.refused = broken_by_values(study, baseline.values).value_or("");
  setup.candidates.push_back(std::move(baseline));
  for (const DesignPoint& point : design_points(study)) {
    if (point == setup.candidates.front().values) continue;
    Candidate candidate;
    candidate.number = static_cast<int>(setup.candidates.size());
    candidate.name = name_of(candidate.number);
    candidate.values = point;
    candidate.refused = broken_by_values(study, point).value_or("");
    candidate.settings = settings_of(study, point);
    if (candidate.refused.empty()) complete(candidate);
    setup.candidates.push_back(std::move(candidate));
  }
  return setup;
}

}  // namespace waretwin

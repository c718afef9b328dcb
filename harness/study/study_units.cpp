#include "harness/study/study_units.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/digest.h"
#include "core/error.h"
#include "harness/study/blind_zone.h"
#include "harness/units/run_unit.h"
#include "harness/units/units.h"

namespace waretwin {

using Json = nlohmann::ordered_json;

std::string coverage_unit(const CandidateInHall& candidate, const CoverageConfig& config) {
  Scenario scenario = candidate.config.scenario;
  CoverageConfig how = config;
  // What names the vehicle's model says nothing of what is in it, which the scene has.
  scenario.robot.model.clear();
  Digest digest;
  digest.add("coverage");
  digest.add(program_identity());
  digest.add(candidate.shared->digest);
  for (const double size : {candidate.baseline_robot.length_m, candidate.baseline_robot.width_m, candidate.baseline_robot.height_m})
    digest.add(size);
  digest.add(write_config([&](Fields& f) {
    f.group("robot", scenario.robot, "");
    f.group("sensors", scenario.sensors, "");
    f.group("coverage", how, "");
  }));
  return digest.hex();
}

StudyValues measure_coverage(const CandidateInHall& candidate, const CoverageHall& hall, const RayCaster* own_body,
                             const CoverageConfig& config) {
  const Scenario& scenario = candidate.config.scenario;
  const Coverage coverage = hall.along_route(scenario, own_body);
  const BlindZone blind = blind_zone(scenario.robot, scenario.sensors, own_body, config.blind_radius_m);
  StudyValues values(study_measures().size());
  const auto set = [&values](const char* name, std::optional<double> value) { values[*study_measure(name)] = value; };
  if (!coverage.objects.empty()) {
    double sum = 0.0;
    for (const double share : coverage.objects) sum += share;
    set("object_coverage", sum / static_cast<double>(coverage.objects.size()));
    set("object_coverage_least", *std::min_element(coverage.objects.begin(), coverage.objects.end()));
  }
  set("floor_coverage", coverage.floor);
  set("blind_floor", blind.floor_share);
  set("blind_ahead_m", blind.ahead_m);
  set("blind_laser", blind.laser_share);
  set("route_s", coverage.route_s);
  return values;
}

std::string run_unit(const RunConfig& config, const SharedHall& shared) {
  Digest digest;
  digest.add("study run");
  digest.add(program_identity());
  add_run(config, shared.digest, digest);
  return digest.hex();
}

std::string unit_text(const UnitRecord& record) {
  Json json = {{"digest", record.result.digest}, {"error", record.result.error}, {"cpu", record.cpu}, {"wall_s", record.wall_s}};
  json["measures"] = Json::object();
  for (std::size_t m = 0; m < record.result.values.size(); ++m) {
    if (record.result.values[m]) json["measures"][study_measures()[m].name] = *record.result.values[m];
  }
  return json.dump(2) + "\n";
}

UnitRecord read_unit(const std::string& text, const std::filesystem::path& name) {
  try {
    const Json json = Json::parse(text);
    UnitRecord record;
    record.result.digest = json.at("digest");
    record.result.error = json.at("error");
    record.cpu = json.at("cpu");
    record.wall_s = json.at("wall_s");
    for (const StudyMeasure& measure : study_measures()) {
      const auto value = json.at("measures").find(measure.name);
      record.result.values.push_back(value == json.at("measures").end() ? std::nullopt : std::optional(value->get<double>()));
    }
    return record;
  } catch (const Json::exception& e) {
    throw Error(name, "is no unit of a study: " + std::string(e.what()));
  }
}

}  // namespace waretwin

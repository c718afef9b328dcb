#include "harness/gate/score_file.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files.h"
#include "core/json_text.h"
#include "harness/gate/measures.h"
#include "harness/run/external_mapper.h"
#include "harness/score/cuboid_file.h"
#include "harness/score/score_json.h"

namespace waretwin {

namespace {

using Json = nlohmann::json;

std::string brief(const Json& value) { return value.dump(-1, ' ', false, Json::error_handler_t::replace).substr(0, 40); }

std::string text_at(const Json& json, const char* place) {
  const Json::json_pointer pointer(place);
  return json.contains(pointer) && json[pointer].is_string() ? json[pointer].get<std::string>() : "";
}

std::optional<double> number_at(const Json& json, const Measure& measure, const std::filesystem::path& file) {
  const Json::json_pointer pointer(measure.place);
  if (!json.contains(pointer) || json[pointer].is_null()) return std::nullopt;
  const Json& value = json[pointer];
  if (measure.counts && value.is_array()) return static_cast<double>(value.size());
  if (measure.counts || !value.is_number() || !std::isfinite(value.get<double>()))
    throw Error(file,
                std::string(measure.place).substr(1) + " is " + brief(value) + "; expected a " + (measure.counts ? "list" : "number"));
  return value.get<double>();
}

JudgedObject object_of(const Json& row, const std::filesystem::path& file) {
  const bool whole = row.is_object() && row.contains("truth_id") && row["truth_id"].is_number_integer() && row.contains("class") &&
                     row["class"].is_string() && row.contains("iou3d") && row["iou3d"].is_number();
  if (!whole) throw Error(file, "objects: " + brief(row) + "; expected truth_id, class and iou3d");
  JudgedObject object{row["truth_id"].get<int>(), row["class"].get<std::string>(), row["iou3d"].get<double>(), true};
  if (const auto counted = row.find("counted"); counted != row.end() && counted->is_boolean()) object.counted = counted->get<bool>();
  return object;
}

}  // namespace

bool JudgedScore::of_another_mapper() const { return profile == kExternalProfile; }

JudgedScore judged_score(const std::string& text, const std::filesystem::path& file) {
  const Json json = parse_json<Json>(file, text, "a score.json");
  if (!json.is_object() || !json.contains("schema")) throw Error(file, "has no key 'schema'; expected a score.json");
  if (json["schema"] != kScoreSchema)
    throw Error(file, "schema is " + brief(json["schema"]) + "; expected " + std::to_string(kScoreSchema));
  JudgedScore score;
  score.scenario = text_at(json, "/scenario");
  score.profile = text_at(json, "/profile");
  score.digest = text_at(json, "/digest");
  score.cpu = text_at(json, "/cpu/model");
  if (const auto seed = json.find("seed"); seed != json.end() && seed->is_number_integer()) score.seed = seed->get<std::int64_t>();
  for (const Measure& measure : measures()) {
    const std::optional<double> value = number_at(json, measure, file);
    // Such a score says 0 frames without a pose of a mapper that nobody asked.
    score.values.push_back(measure.ours && score.of_another_mapper() ? std::nullopt : value);
  }
  const auto objects = json.find("objects");
  if (objects != json.end()) {
    if (!objects->is_array()) throw Error(file, "objects is " + brief(*objects) + "; expected a list");
    for (const Json& row : *objects) score.objects.push_back(object_of(row, file));
  }
  const bool measured = std::any_of(score.values.begin(), score.values.end(), [](const auto& value) { return value.has_value(); });
  if (!measured && objects == json.end()) throw Error(file, "holds no measure and no objects; expected a score.json");
  return score;
}

JudgedScore read_judged_score(const std::filesystem::path& path) {
  const std::filesystem::path file = file_or_in_folder(path, "score.json");
  return judged_score(read_file(file), file);
}

}  // namespace waretwin

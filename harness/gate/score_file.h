// What gates read of a score.json.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace waretwin {

struct JudgedObject {
  int truth_id = 0;
  std::string class_name;
  double iou3d = 0.0;
  bool counted = true;
};

struct JudgedScore {
  std::string scenario, profile, digest, cpu;  // empty where the file does not say
  std::optional<std::int64_t> seed;
  std::vector<std::optional<double>> values;  // one for each of measures(); nothing where the file has none or null
  std::vector<JudgedObject> objects;

  bool of_another_mapper() const;  // values of Measure::ours are then nothing
};

// `path`: a score.json or the folder of a run that has one. Throws Error for a file that is no score of this schema.
JudgedScore read_judged_score(const std::filesystem::path& path);
// The same for text; `name` stands for the file in messages.
JudgedScore judged_score(const std::string& json, const std::filesystem::path& name);

}  // namespace waretwin

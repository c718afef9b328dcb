// Reading and writing of configuration structs (core/fields.h) as YAML.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/fields.h"

namespace waretwin {

// One `--set key=value`: the path of a field, parts joined by dots ("mapper.tsdf.voxel_m", "sensors.camera.mount.z_m", "models.0.yaw_deg").
struct Setting {
  std::string key;
  std::string value;  // YAML: a number, a word, [a, list]
};

// Splits "key=value". Throws Error where there is no '=' or no key.
Setting parse_setting(const std::string& text);

using VisitFunction = std::function<void(Fields&)>;

// Reads a YAML file into what `visit` lists. An unknown or missing key, a wrong type or a value out of range throws Error with file,
// line, key, value, what was expected, and for an unknown key the nearest known one. Duplicate keys, anchors that recurse and
// documents deeper than 32 levels are refused.
// `kPartial`: keys that a file must name may be missing, as in one that only changes some values of what is there.
enum class Completeness { kWhole, kPartial };
void read_config(const std::filesystem::path& file, const VisitFunction& visit, Completeness completeness = Completeness::kWhole);
// The same for text; `name` stands for the file in messages.
void read_config_text(const std::string& yaml, const std::filesystem::path& name, const VisitFunction& visit,
                      Completeness completeness = Completeness::kWhole);

// Applies settings in one visit; of two for the same key the later one wins, and a preset never undoes what stands beside it. They
// change what exists: an index beyond a list or a new name in a map is an Error. Throws Error for a key that no visited field has,
// naming the nearest one.
void apply_settings(const std::vector<Setting>& settings, const VisitFunction& visit);

// All fields with their present values, as YAML text that read_config takes back.
std::string write_config(const VisitFunction& visit);

// All fields with type, range, default and documentation, one a line: what `--help-config` prints. An empty list or map is shown by
// one example element, which stays in the struct: give this function a struct of its own.
std::string describe_config(const VisitFunction& visit);

template <class T>
void read_config_into(const std::filesystem::path& file, T& value) {
  read_config(file, [&](Fields& f) { value.visit(f); });
}

}  // namespace waretwin

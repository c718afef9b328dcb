// Configuration as plain data: a struct lists its fields once, and that list reads it from YAML, takes `--set` values, writes it back
// resolved, and prints its documentation.
//
//   struct LaserNoise {
//     double sigma_m = 0.02;
//     std::string mode = "gaussian";
//     void visit(Fields& f) {
//       f("sigma_m", sigma_m, "standard deviation of a range", {.min = 0, .max = 1});
//       f("mode", mode, "shape of the error", {.choices = {"gaussian", "none"}});
//     }
//   };
//
// A nested struct is f.group("noise", noise, "..."); lists and named maps of structs are f.list and f.map. What the file does not name
// keeps its default, unless the rule says required. Units stand in the key (_m, _deg, _hz, _s).
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace waretwin {

struct FieldRule {
  double min = -std::numeric_limits<double>::infinity();  // numbers, and each number of a vector: allowed range, ends included
  double max = std::numeric_limits<double>::infinity();
  std::vector<std::string> choices = {};  // text: the allowed values; empty allows any
  std::size_t length = 0;                 // vectors: the exact number of values; 0 allows any
  bool required = false;                  // the file must name it
};

// An optional number has no value while the file does not name it, or names it null.
using FieldRef = std::variant<bool*, int*, std::int64_t*, std::uint64_t*, double*, std::optional<double>*, std::string*,
                              std::vector<double>*, std::vector<std::string>*>;

class Fields {
 public:
  virtual ~Fields() = default;

  template <class T>
  void operator()(const char* key, T& value, const char* doc, const FieldRule& rule = {}) {
    scalar(key, FieldRef(&value), doc, rule);
  }
  // A file named in the configuration, as text; relative names are resolved by whoever uses them, against the file's folder.
  void operator()(const char* key, std::filesystem::path& value, const char* doc, const FieldRule& rule = {}) {
    std::string text = value.string();
    scalar(key, FieldRef(&text), doc, rule);
    value = text;
  }

  template <class T>
  void group(const char* key, T& value, const char* doc, const FieldRule& rule = {}) {
    if (!enter(key, doc, rule)) return;
    value.visit(*this);
    leave();
  }

  // A sequence of structs. A file's list replaces the default one as a whole.
  template <class T>
  void list(const char* key, std::vector<T>& values, const char* doc, const FieldRule& rule = {}) {
    std::size_t count = values.size();
    if (!enter_list(key, count, doc, rule)) return;
    values.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      if (!enter_element(i)) continue;
      values[i].visit(*this);
      leave();
    }
    leave();
  }

  // Structs by name (sensors by their names). A file's names are added to the default ones.
  template <class T>
  void map(const char* key, std::map<std::string, T>& values, const char* doc, const FieldRule& rule = {}) {
    std::vector<std::string> names;
    for (const auto& entry : values) names.push_back(entry.first);
    if (!enter_map(key, names, doc, rule)) return;
    for (const std::string& name : names) {
      if (!enter(name.c_str(), "", {})) continue;
      values[name].visit(*this);
      leave();
    }
    leave();
  }

  // For checks that one rule cannot express (max below min, a file that must exist): reports the place of `key` in the group being
  // visited. Does nothing while writing.
  virtual void reject(const char* key, const std::string& problem) = 0;

 protected:
  virtual void scalar(const char* key, FieldRef value, const char* doc, const FieldRule& rule) = 0;
  virtual bool enter(const char* key, const char* doc, const FieldRule& rule) = 0;  // false: skip this group
  virtual bool enter_list(const char* key, std::size_t& count, const char* doc, const FieldRule& rule) = 0;
  virtual bool enter_element(std::size_t index) = 0;
  virtual bool enter_map(const char* key, std::vector<std::string>& names, const char* doc, const FieldRule& rule) = 0;
  virtual void leave() = 0;
};

// The key of `known` that is closest to `key` by edit distance, or "" when none is near (more than a third of the letters differ).
std::string nearest_key(const std::string& key, const std::vector<std::string>& known);

}  // namespace waretwin

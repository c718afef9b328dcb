#include <map>

#include "core/config.h"
#include "core/error.h"
#include "core/field_values.h"
#include "core/yaml_tree.h"

namespace waretwin {

namespace {

class SettingsApplier : public Fields {
 public:
  explicit SettingsApplier(const std::vector<Setting>& settings) {
    for (const Setting& setting : settings) settings_[setting.key] = {setting.value, false};
  }

  // Reports the settings that no visited field took. In the order of their keys, so that the message does not depend on chance.
  void finish() const {
    for (const auto& [key, setting] : settings_) {
      if (!setting.used) throw Error(place(key) + unknown(key));
    }
  }

  void reject(const char* key, const std::string& problem) override {
    const std::string path = path_of(key);
    throw Error((settings_.count(path) ? place(path) : "after --set: key '" + path + "'") + " " + problem);
  }

 protected:
  void scalar(const char* key, FieldRef value, const char*, const FieldRule& rule) override {
    const std::string path = path_of(key);
    known_.push_back(path);
    const auto found = settings_.find(path);
    if (found == settings_.end()) return;
    found->second.used = true;
    const std::string& text = found->second.value;
    assign_field(value, *node_for(value, text, path), rule, [&](const std::string& problem) { throw Error(place(path) + " " + problem); });
  }

  bool enter(const char* key, const char*, const FieldRule&) override { return push(key, "a group"); }
  bool enter_list(const char* key, std::size_t& count, const char*, const FieldRule&) override {
    return push(key, "a list of " + std::to_string(count) + ", counted from 0");
  }
  bool enter_element(std::size_t index) override { return push(std::to_string(index), "a group"); }
  bool enter_map(const char* key, std::vector<std::string>& names, const char*, const FieldRule&) override {
    return push(key, "a group of " + std::to_string(names.size()) + " names");
  }
  void leave() override { prefixes_.pop_back(); }

 private:
  struct Value {
    std::string value;
    bool used = false;
  };

  static std::string place(const std::string& key) { return "--set " + key + ":"; }
  std::string path_of(const std::string& key) const { return joined_key(prefixes_.empty() ? "" : prefixes_.back(), key); }

  bool push(const std::string& key, const std::string& kind) {
    const std::string path = path_of(key);
    groups_[path] = kind;
    prefixes_.push_back(path);
    return true;
  }

  // On the command line text needs no YAML quotes: "a: b" or "#3" mean themselves.
  static std::shared_ptr<const YamlNode> node_for(FieldRef value, const std::string& text, const std::string& path) {
    const bool in_quotes = !text.empty() && (text.front() == '"' || text.front() == '\'');
    if (std::holds_alternative<std::string*>(value) && !in_quotes) {
      auto node = std::make_shared<YamlNode>();
      node->kind = YamlNode::Kind::scalar;
      node->text = text;
      return node;
    }
    return parse_yaml(text, "--set " + path);
  }

  std::string unknown(const std::string& key) const {
    const auto group = groups_.find(key);
    if (group != groups_.end()) return " is " + group->second + "; expected the path of a single value inside it";
    std::string nearest = nearest_key(key, known_);
    if (nearest.empty()) nearest = with_same_ending(key);
    std::string message = " no such key";
    if (!nearest.empty()) return message + "; did you mean '" + nearest + "'?";
    // The longest part of the path that exists says where the mistake begins.
    for (std::size_t dot = key.rfind('.'); dot != std::string::npos && dot > 0; dot = key.rfind('.', dot - 1)) {
      const auto parent = groups_.find(key.substr(0, dot));
      if (parent != groups_.end()) return message + "; '" + parent->first + "' is " + parent->second + children_of(parent->first);
    }
    return message + children_of("");
  }

  std::string with_same_ending(const std::string& key) const {
    for (const std::string& path : known_) {
      const std::size_t start = path.size() - key.size() - 1;
      if (path.size() > key.size() + 1 && path[start] == '.' && path.compare(start + 1, key.size(), key) == 0) return path;
    }
    return "";
  }

  std::string children_of(const std::string& parent) const {
    std::vector<std::string> names;
    const auto add = [&](const std::string& path) {
      if (!parent.empty() && (path.size() <= parent.size() + 1 || path.compare(0, parent.size() + 1, parent + ".") != 0)) return;
      const std::size_t begin = parent.empty() ? 0 : parent.size() + 1;
      const std::string name = path.substr(begin, path.find('.', begin) - begin);
      for (const std::string& other : names) {
        if (other == name) return;
      }
      names.push_back(name);
    };
    for (const std::string& path : known_) add(path);
    if (names.empty()) return "";
    std::string text = "; expected one of ";
    for (std::size_t i = 0; i < names.size(); ++i) text += (i ? ", " : "") + names[i];
    return text;
  }

  std::map<std::string, Value> settings_;
  std::vector<std::string> known_;
  std::map<std::string, std::string> groups_;
  std::vector<std::string> prefixes_;
};

}  // namespace

Setting parse_setting(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) throw Error("--set " + quoted_for_message(text) + ": expected key=value");
  return {text.substr(0, equals), text.substr(equals + 1)};
}

void apply_settings(const std::vector<Setting>& settings, const VisitFunction& visit) {
  SettingsApplier applier(settings);
  visit(applier);
  applier.finish();
}

}  // namespace waretwin

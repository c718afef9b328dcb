#include <algorithm>
#include <optional>

#include "core/config.h"
#include "core/error.h"
#include "core/field_values.h"
#include "core/files.h"
#include "core/yaml_tree.h"

namespace waretwin {

namespace {

class YamlReader : public Fields {
 public:
  YamlReader(const std::filesystem::path& name, std::shared_ptr<const YamlNode> root, Completeness completeness)
      : name_(name), document_(std::move(root)), completeness_(completeness) {
    require_map(*document_, "", "the file");
    levels_.push_back({Kind::group, document_.get(), ""});
  }

  // Reports what stands in the outermost group and nobody asked for.
  void finish() { leave(); }

  void reject(const char* key, const std::string& problem) override {
    report_missing();
    const YamlNode::Entry* entry = level().node->find(key);
    throw Error(name_, entry ? entry->line : level().node->line, "key '" + path_of(key) + "' " + problem);
  }

 protected:
  void scalar(const char* key, FieldRef value, const char*, const FieldRule& rule) override {
    const YamlNode::Entry* entry = consume(key, expected_value(value, rule), rule);
    if (!entry) return;
    assign_field(value, *entry->value, rule,
                 [&](const std::string& problem) { throw Error(name_, entry->line, "key '" + path_of(key) + "' " + problem); });
  }

  bool enter(const char* key, const char*, const FieldRule& rule) override {
    const YamlNode::Entry* entry = consume(key, "a group of keys", rule);
    if (!entry) return false;
    require_map(*entry->value, path_of(key), "");
    push(Kind::group, entry->value.get(), path_of(key));
    return true;
  }

  bool enter_list(const char* key, std::size_t& count, const char*, const FieldRule& rule) override {
    const YamlNode::Entry* entry = consume(key, "a list of groups", rule);
    if (!entry) return false;
    const YamlNode& node = *entry->value;
    if (node.kind != YamlNode::Kind::sequence && node.kind != YamlNode::Kind::null) {
      throw Error(name_, entry->line, "key '" + path_of(key) + "' is not a list; expected '- key: value' lines below it");
    }
    if (rule.length && node.values.size() != rule.length) {
      throw Error(
          name_, entry->line,
          "key '" + path_of(key) + "' is a list of " + std::to_string(node.values.size()) + "; expected " + std::to_string(rule.length));
    }
    count = node.values.size();
    push(Kind::list, &node, path_of(key));
    return true;
  }

  bool enter_element(std::size_t index) override {
    const YamlNode& node = *level().node->values.at(index).value;
    const std::string path = path_of(std::to_string(index));
    require_map(node, path, "");
    push(Kind::group, &node, path);
    return true;
  }

  bool enter_map(const char* key, std::vector<std::string>& names, const char*, const FieldRule& rule) override {
    const YamlNode::Entry* entry = consume(key, "a group of names", rule);
    if (!entry) return false;
    require_map(*entry->value, path_of(key), "");
    for (const YamlNode::Entry& named : entry->value->values) {
      if (std::find(names.begin(), names.end(), named.key) == names.end()) names.push_back(named.key);
    }
    push(Kind::map, entry->value.get(), path_of(key));
    return true;
  }

  void leave() override {
    if (level().kind == Kind::group) {
      report_unknown();
      report_missing();
    }
    levels_.pop_back();
  }

 private:
  enum class Kind { group, list, map };
  struct Level {
    Kind kind;
    const YamlNode* node;
    std::string path;
    std::vector<std::string> known = {};
    // Held back until the group is left: the key may stand there misspelt, and then that is the message to give.
    std::optional<Error> missing = std::nullopt;
  };

  Level& level() { return levels_.back(); }
  std::string path_of(const std::string& key) { return joined_key(level().path, key); }
  void push(Kind kind, const YamlNode* node, const std::string& path) { levels_.push_back({kind, node, path}); }

  // A group without keys is a group of defaults.
  void require_map(const YamlNode& node, const std::string& path, const std::string& name) {
    if (node.kind == YamlNode::Kind::map || node.kind == YamlNode::Kind::null) return;
    const std::string what = node.kind == YamlNode::Kind::sequence ? "a list" : quoted_for_message(node.text);
    throw Error(name_, node.line,
                (name.empty() ? "key '" + path + "'" : name) + " is " + what + "; expected a group of 'key: value' lines");
  }

  const YamlNode::Entry* consume(const std::string& key, const std::string& expected, const FieldRule& rule) {
    level().known.push_back(key);
    const YamlNode::Entry* entry = level().node->find(key);
    if (!entry && rule.required && completeness_ == Completeness::kWhole && !level().missing) {
      level().missing.emplace(name_, level().node->line, "key '" + path_of(key) + "' is missing; expected " + expected);
    }
    return entry;
  }

  void report_missing() {
    if (level().missing) throw *level().missing;
  }

  void report_unknown() {
    const std::vector<std::string>& known = level().known;
    for (const YamlNode::Entry& entry : level().node->values) {
      if (std::find(known.begin(), known.end(), entry.key) != known.end()) continue;
      std::string message = "key " + quoted_for_message(path_of(entry.key)) + " is not known; ";
      const std::string nearest = nearest_key(entry.key, known);
      if (!nearest.empty()) {
        message += "did you mean '" + nearest + "'?";
      } else if (known.empty()) {
        message += "expected no keys here";
      } else {
        message += "expected one of ";
        for (std::size_t i = 0; i < known.size(); ++i) message += (i ? ", " : "") + known[i];
      }
      throw Error(name_, entry.line, message);
    }
  }

  std::filesystem::path name_;
  std::shared_ptr<const YamlNode> document_;
  Completeness completeness_;
  std::vector<Level> levels_;
};

}  // namespace

void read_config(const std::filesystem::path& file, const VisitFunction& visit, Completeness completeness) {
  constexpr std::uintmax_t kLargest = std::uintmax_t{16} << 20;
  read_config_text(read_file(file, kLargest), file, visit, completeness);
}

void read_config_text(const std::string& yaml, const std::filesystem::path& name, const VisitFunction& visit, Completeness completeness) {
  YamlReader reader(name, parse_yaml(yaml, name), completeness);
  visit(reader);
  reader.finish();
}

}  // namespace waretwin

#include "core/config.h"
#include "core/error.h"
#include "core/field_values.h"

namespace waretwin {

namespace {

class YamlWriter : public Fields {
 public:
  YamlWriter() { levels_.push_back({Kind::group, "", {}}); }

  std::string text() const {
    std::string out;
    for (const std::string& line : levels_.back().lines) out += line + "\n";
    return out;
  }

  void reject(const char*, const std::string&) override {}

 protected:
  void scalar(const char* key, FieldRef value, const char*, const FieldRule&) override {
    levels_.back().lines.push_back(text_as_yaml(key) + ": " + field_as_yaml(value));
  }
  bool enter(const char* key, const char*, const FieldRule&) override { return push(Kind::group, key); }
  bool enter_list(const char* key, std::size_t&, const char*, const FieldRule&) override { return push(Kind::list, key); }
  bool enter_element(std::size_t) override { return push(Kind::element, ""); }
  bool enter_map(const char* key, std::vector<std::string>&, const char*, const FieldRule&) override { return push(Kind::group, key); }

  void leave() override {
    const Level done = std::move(levels_.back());
    levels_.pop_back();
    std::vector<std::string>& lines = levels_.back().lines;
    const char* const empty = done.kind == Kind::list ? "[]" : "{}";
    if (done.kind == Kind::element) {
      if (done.lines.empty()) lines.push_back(std::string("- ") + empty);
      for (std::size_t i = 0; i < done.lines.size(); ++i) lines.push_back((i == 0 ? "- " : "  ") + done.lines[i]);
      return;
    }
    lines.push_back(text_as_yaml(done.key) + ":" + (done.lines.empty() ? std::string(" ") + empty : ""));
    for (const std::string& line : done.lines) lines.push_back("  " + line);
  }

 private:
  enum class Kind { group, list, element };
  struct Level {
    Kind kind;
    std::string key;
    std::vector<std::string> lines;
  };

  bool push(Kind kind, const std::string& key) {
    levels_.push_back({kind, key, {}});
    return true;
  }

  std::vector<Level> levels_;
};

class Describer : public Fields {
 public:
  const std::string& text() const { return text_; }

  void reject(const char*, const std::string&) override {}

 protected:
  void scalar(const char* key, FieldRef value, const char* doc, const FieldRule& rule) override {
    add(key, expected_value(value, rule), rule, doc, rule.required ? "" : "default " + field_as_yaml(value));
  }
  bool enter(const char* key, const char* doc, const FieldRule& rule) override {
    if (*doc != '\0') add(key, "group", rule, doc, "");
    return push(key);
  }
  bool enter_list(const char* key, std::size_t& count, const char* doc, const FieldRule& rule) override {
    add(key, "list of groups", rule, doc, "default " + std::to_string(count) + " of them");
    example_ = count == 0;
    if (example_) count = 1;
    return push(key);
  }
  bool enter_element(std::size_t index) override {
    const bool example = example_;
    example_ = false;
    return push(example ? "N" : std::to_string(index));
  }
  bool enter_map(const char* key, std::vector<std::string>& names, const char* doc, const FieldRule& rule) override {
    add(key, "groups by name", rule, doc, "");
    if (names.empty()) names.push_back("NAME");
    return push(key);
  }
  void leave() override { prefixes_.pop_back(); }

 private:
  std::string path_of(const std::string& key) const { return joined_key(prefixes_.empty() ? "" : prefixes_.back(), key); }

  bool push(const std::string& key) {
    prefixes_.push_back(path_of(key));
    return true;
  }

  void add(const std::string& key, const std::string& type, const FieldRule& rule, const std::string& doc, const std::string& standard) {
    text_ +=
        path_of(key) + ": " + doc + " (" + type + (rule.required ? ", required" : "") + (standard.empty() ? "" : "; " + standard) + ")\n";
  }

  std::string text_;
  std::vector<std::string> prefixes_;
  bool example_ = false;
};

}  // namespace

std::string write_config(const VisitFunction& visit) {
  YamlWriter writer;
  visit(writer);
  return writer.text();
}

std::string describe_config(const VisitFunction& visit) {
  Describer describer;
  visit(describer);
  return describer.text();
}

}  // namespace waretwin

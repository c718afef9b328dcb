#include "core/config_value.h"

#include "core/field_values.h"

namespace waretwin {

namespace {

class ValueFinder : public Fields {
 public:
  explicit ValueFinder(const std::string& key) : key_(key) {}
  void reject(const char*, const std::string&) override {}
  std::optional<std::string> found;
  bool found_text = false;

 protected:
  void scalar(const char* key, FieldRef value, const char*, const FieldRule&) override {
    if (joined_key(prefix(), key) != key_) return;
    const auto* text = std::get_if<std::string*>(&value);
    found_text = text != nullptr;
    found = found_text ? **text : field_as_yaml(value);
  }
  bool enter(const char* key, const char*, const FieldRule&) override { return push(key); }
  bool enter_list(const char* key, std::size_t&, const char*, const FieldRule&) override { return push(key); }
  bool enter_element(std::size_t index) override { return push(std::to_string(index)); }
  bool enter_map(const char* key, std::vector<std::string>&, const char*, const FieldRule&) override { return push(key); }
  void leave() override { prefixes_.pop_back(); }

 private:
  std::string prefix() const { return prefixes_.empty() ? "" : prefixes_.back(); }
  bool push(const std::string& key) {
    prefixes_.push_back(joined_key(prefix(), key));
    return true;
  }

  std::string key_;
  std::vector<std::string> prefixes_;
};

}  // namespace

std::optional<std::string> value_of(const std::string& key, const VisitFunction& visit) {
  ValueFinder finder(key);
  visit(finder);
  return finder.found;
}

bool is_text(const std::string& key, const VisitFunction& visit) {
  ValueFinder finder(key);
  visit(finder);
  return finder.found_text;
}

}  // namespace waretwin

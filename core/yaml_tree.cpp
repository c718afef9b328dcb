#include "core/yaml_tree.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

#include "core/error.h"

namespace waretwin {

namespace {

constexpr int kDeepest = 32;

// Builds the tree from the parser's events. yaml-cpp's own builder lets duplicate keys and self-containing anchors pass.
class TreeBuilder : public YAML::EventHandler {
 public:
  explicit TreeBuilder(const std::filesystem::path& name) : name_(name) {}

  std::shared_ptr<const YamlNode> root() const { return root_; }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override { add(make(YamlNode::Kind::null, mark), anchor, line_of(mark)); }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor, const std::string& value) override {
    auto node = make(YamlNode::Kind::scalar, mark);
    node->text = value;
    node->quoted = tag != "?";
    add(std::move(node), anchor, line_of(mark));
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto target = anchors_.find(anchor);
    if (target == anchors_.end()) throw Error(name_, line_of(mark), "an anchor contains itself");
    add(target->second, YAML::NullAnchor, line_of(mark));
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor, YAML::EmitterStyle::value) override {
    open(YamlNode::Kind::sequence, mark, anchor);
  }
  void OnSequenceEnd() override { close(); }

  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor, YAML::EmitterStyle::value) override {
    open(YamlNode::Kind::map, mark, anchor);
  }
  void OnMapEnd() override { close(); }

 private:
  struct Open {
    std::shared_ptr<YamlNode> node;
    YAML::anchor_t anchor = YAML::NullAnchor;
    bool has_key = false;
    std::string key;
    int key_line = 0;
    std::set<std::string> keys;
  };

  static int line_of(const YAML::Mark& mark) { return mark.line + 1; }

  static std::shared_ptr<YamlNode> make(YamlNode::Kind kind, const YAML::Mark& mark) {
    auto node = std::make_shared<YamlNode>();
    node->kind = kind;
    node->line = line_of(mark);
    return node;
  }

  void check_depth(int depth, int line) const {
    if (depth > kDeepest) throw Error(name_, line, "is nested more than " + std::to_string(kDeepest) + " levels deep");
  }

  void open(YamlNode::Kind kind, const YAML::Mark& mark, YAML::anchor_t anchor) {
    check_depth(static_cast<int>(open_.size()) + 1, line_of(mark));
    Open entry;
    entry.node = make(kind, mark);
    entry.anchor = anchor;
    open_.push_back(std::move(entry));
  }

  void close() {
    const Open done = std::move(open_.back());
    open_.pop_back();
    add(done.node, done.anchor, done.node->line);
  }

  void add(std::shared_ptr<const YamlNode> node, YAML::anchor_t anchor, int line) {
    if (anchor != YAML::NullAnchor) anchors_[anchor] = node;
    if (open_.empty()) {
      root_ = std::move(node);
      return;
    }
    Open& parent = open_.back();
    check_depth(static_cast<int>(open_.size()) + node->height, line);
    if (parent.node->kind == YamlNode::Kind::map && !parent.has_key) {
      if (node->kind != YamlNode::Kind::scalar) throw Error(name_, line, "has a key that is not a word; expected 'key: value'");
      if (!parent.keys.insert(node->text).second) throw Error(name_, line, "key '" + node->text + "' stands here a second time");
      parent.has_key = true;
      parent.key = node->text;
      parent.key_line = line;
      return;
    }
    parent.node->height = std::max(parent.node->height, node->height + 1);
    parent.node->values.push_back({parent.key, parent.has_key ? parent.key_line : line, std::move(node)});
    parent.has_key = false;
    parent.key.clear();
  }

  std::filesystem::path name_;
  std::vector<Open> open_;
  std::map<YAML::anchor_t, std::shared_ptr<const YamlNode>> anchors_;
  std::shared_ptr<const YamlNode> root_ = std::make_shared<YamlNode>();
};

}  // namespace

const YamlNode::Entry* YamlNode::find(const std::string& key) const {
  const auto found = std::find_if(values.begin(), values.end(), [&](const Entry& entry) { return entry.key == key; });
  return found == values.end() ? nullptr : &*found;
}

std::shared_ptr<const YamlNode> parse_yaml(const std::string& yaml, const std::filesystem::path& name) {
  std::istringstream in(yaml);
  TreeBuilder builder(name);
  try {
    YAML::Parser parser(in);
    if (parser.HandleNextDocument(builder)) {
      TreeBuilder second(name);
      if (parser.HandleNextDocument(second)) {
        throw Error(name, second.root()->line, "holds a second YAML document; expected one");
      }
    }
  } catch (const YAML::Exception& failure) {
    throw Error(name, failure.mark.line + 1, "is not valid YAML: " + failure.msg);
  }
  return builder.root();
}

}  // namespace waretwin

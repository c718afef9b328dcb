// A YAML document as a plain tree with line numbers: what core/config.h reads from.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace waretwin {

struct YamlNode {
  enum class Kind { null, scalar, sequence, map };
  struct Entry {
    std::string key;  // empty in a sequence
    int line = 0;     // of the key
    std::shared_ptr<const YamlNode> value;
  };

  const Entry* find(const std::string& key) const;

  Kind kind = Kind::null;
  int line = 0;               // counted from 1
  int height = 0;             // levels below this node; 0 for a scalar
  bool quoted = false;        // scalars: written in quotes, so never a number
  std::string text;           // scalars
  std::vector<Entry> values;  // sequences and maps, in the order of the file
};

// The only document in `yaml`; an empty text gives a null node. Throws Error ("name:line: ...") for a syntax error, a second document,
// a duplicate key, a key that is not text, an anchor that contains itself, and more than 32 levels.
std::shared_ptr<const YamlNode> parse_yaml(const std::string& yaml, const std::filesystem::path& name);

}  // namespace waretwin

#include "mapper/detect/darknet_cfg.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/files.h"

namespace waretwin {
namespace {

struct Section {
  std::string name;
  int line = 0;
  std::map<std::string, std::string> values;
};

std::string without_spaces(std::string text) {
  text.erase(std::remove_if(text.begin(), text.end(), [](unsigned char c) { return std::isspace(c); }), text.end());
  return text;
}

std::vector<Section> read_sections(const std::filesystem::path& cfg) {
  std::istringstream text(read_file(cfg, 16 << 20));
  std::vector<Section> sections;
  int number = 0;
  for (std::string line; std::getline(text, line);) {
    ++number;
    line = without_spaces(line);
    if (line.empty() || line[0] == '#' || line[0] == ';') continue;
    if (line[0] == '[') {
      if (line.back() != ']') throw Error(cfg, number, "'" + line.substr(0, 40) + "'; expected a section like [convolutional]");
      sections.push_back({line.substr(1, line.size() - 2), number, {}});
      continue;
    }
    const auto equals = line.find('=');
    if (equals == std::string::npos || equals == 0 || sections.empty()) {
      throw Error(cfg, number, "'" + line.substr(0, 40) + "'; expected a line like filters=32 in a section");
    }
    sections.back().values[line.substr(0, equals)] = line.substr(equals + 1);
  }
  return sections;
}

int integer(const std::filesystem::path& cfg, const Section& section, const std::string& key, int otherwise, int least, int most) {
  const auto value = section.values.find(key);
  if (value == section.values.end()) return otherwise;
  std::size_t used = 0;
  int number = 0;
  try {
    number = std::stoi(value->second, &used);
  } catch (const std::exception&) {
    used = 0;
  }
  if (used == 0 || used != value->second.size() || number < least || number > most) {
    throw Error(cfg, section.line,
                "[" + section.name + "] " + key + " = '" + value->second.substr(0, 40) + "'; expected a whole number from " +
                    std::to_string(least) + " to " + std::to_string(most));
  }
  return number;
}

// Channels that come out of [route]: those of the named layers together, or one group of them.
int route_channels(const std::filesystem::path& cfg, const Section& section, const std::vector<int>& channels) {
  const auto layers = section.values.find("layers");
  if (layers == section.values.end()) throw Error(cfg, section.line, "[route] without layers");
  std::istringstream list(layers->second);
  int sum = 0;
  for (std::string item; std::getline(list, item, ',');) {
    int layer = 0;
    try {
      layer = std::stoi(item);
    } catch (const std::exception&) {
      throw Error(cfg, section.line, "[route] layers = '" + layers->second.substr(0, 40) + "'; expected whole numbers");
    }
    const int count = static_cast<int>(channels.size());
    const int at = layer < 0 ? count + layer : layer;
    if (at < 0 || at >= count) throw Error(cfg, section.line, "[route] names layer " + item + ", which is not before it");
    sum += channels[at];
  }
  return sum / integer(cfg, section, "groups", 1, 1, 4096);
}

}  // namespace

DarknetSummary read_darknet_cfg(const std::filesystem::path& cfg) {
  const std::vector<Section> sections = read_sections(cfg);
  if (sections.empty() || (sections.front().name != "net" && sections.front().name != "network")) {
    throw Error(cfg, "no [net] section at the start; expected a Darknet network description");
  }
  constexpr int kMost = 1 << 20;
  const Section& net = sections.front();
  DarknetSummary summary;
  summary.width = integer(cfg, net, "width", 0, 1, 8192);
  summary.height = integer(cfg, net, "height", 0, 1, 8192);
  if (summary.width == 0 || summary.height == 0) throw Error(cfg, net.line, "[net] names no width and height");
  std::vector<int> channels;  // out of each layer
  int previous = integer(cfg, net, "channels", 3, 1, 64);
  std::int64_t parameters = 0;
  bool known = true;
  for (std::size_t i = 1; i < sections.size(); ++i) {
    const Section& section = sections[i];
    if (section.name == "convolutional" || section.name == "conv") {
      const std::int64_t filters = integer(cfg, section, "filters", 1, 1, kMost);
      const std::int64_t size = integer(cfg, section, "size", 1, 1, 1024);
      const std::int64_t groups = integer(cfg, section, "groups", 1, 1, kMost);
      const bool normalised = integer(cfg, section, "batch_normalize", 0, 0, 1) != 0;
      parameters += filters * (normalised ? 4 : 1) + filters * (previous / groups) * size * size;
      previous = static_cast<int>(filters);
    } else if (section.name == "route") {
      previous = route_channels(cfg, section, channels);
    } else if (section.name == "reorg") {
      const int stride = integer(cfg, section, "stride", 1, 1, 64);
      previous *= stride * stride;
    } else if (section.name == "yolo" || section.name == "region") {
      summary.classes = integer(cfg, section, "classes", 20, 1, kMost);
    } else if (section.name != "shortcut" && section.name != "maxpool" && section.name != "upsample" && section.name != "dropout" &&
               section.name != "avgpool" && section.name != "softmax") {
      known = false;
    }
    channels.push_back(previous);
  }
  if (summary.classes == 0) throw Error(cfg, "no [yolo] or [region] section; expected a detector");
  if (known) summary.parameters = parameters;
  return summary;
}

void check_darknet_weights(const std::filesystem::path& weights, const DarknetSummary& summary) {
  std::error_code error;
  const auto size = static_cast<std::int64_t>(std::filesystem::file_size(weights, error));
  if (error) throw Error(weights, "cannot be read: " + error.message());
  std::ifstream file(weights, std::ios::binary);
  std::int32_t version[2] = {0, 0};
  if (!file.read(reinterpret_cast<char*>(version), sizeof version)) throw Error(weights, "too short for Darknet weights");
  // Since version 0.2 the count of pictures seen in training has 64 bits.
  const bool wide = std::int64_t{version[0]} * 10 + version[1] >= 2 && version[0] < 1000 && version[1] < 1000;
  const std::int64_t header = wide ? 20 : 16;
  if (!summary.parameters) return;
  const std::int64_t expected = header + 4 * *summary.parameters;
  if (size != expected) {
    throw Error(weights, std::to_string(size) + " bytes; the network needs " + std::to_string(expected) +
                             (size < expected ? " (is the file truncated?)" : " (does it belong to another cfg?)"));
  }
}

std::string darknet_cfg_with_all_scores(const std::filesystem::path& cfg) {
  std::istringstream text(read_file(cfg, 16 << 20));
  std::string result;
  for (std::string line; std::getline(text, line);) {
    const std::string bare = without_spaces(line);
    if (bare.starts_with("thresh=")) continue;
    result += line + "\n";
    if (bare == "[yolo]" || bare == "[region]") result += "thresh=0\n";
  }
  return result;
}

}  // namespace waretwin

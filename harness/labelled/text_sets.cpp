#include "harness/labelled/text_sets.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <system_error>

#include "core/error.h"
#include "harness/labelled/label_text.h"

namespace waretwin {

namespace {

namespace fs = std::filesystem;

struct DataFile {
  std::map<std::string, std::string> values;
  std::map<std::string, int> lines;
};

DataFile read_data_file(const fs::path& file) {
  const std::vector<std::string> lines = read_lines(file);
  DataFile data;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (lines[i].empty() || lines[i][0] == '#' || lines[i][0] == ';') continue;
    const int number = static_cast<int>(i) + 1;
    const auto equals = lines[i].find('=');
    const std::string key = equals == std::string::npos ? "" : trimmed(std::string_view(lines[i]).substr(0, equals));
    if (key.empty()) throw Error(file, number, "'" + lines[i].substr(0, 60) + "'; expected a line like names = classes.names");
    if (!data.values.emplace(key, trimmed(std::string_view(lines[i]).substr(equals + 1))).second) {
      throw Error(file, number, "'" + key + "' stands twice");
    }
    data.lines[key] = number;
  }
  return data;
}

bool is_file(const fs::path& path) {
  std::error_code unreadable;
  return fs::is_regular_file(path, unreadable);
}

// Of images/NAME.jpg the text KIND/NAME.txt; empty where there is none.
fs::path text_apart(const fs::path& picture, const char* kind) {
  fs::path text = picture;
  text.replace_extension(".txt");
  std::vector<fs::path> parts(text.begin(), text.end());
  const auto last = std::find(parts.rbegin(), parts.rend(), fs::path("images"));
  if (last == parts.rend()) return {};
  *last = kind;
  fs::path apart;
  for (const fs::path& part : parts) apart /= part;
  return is_file(apart) ? apart : fs::path();
}

// images/NAME.jpg has its labels in labels/NAME.txt, or else beside it; empty where it has none.
fs::path labels_of(const fs::path& picture) {
  if (const fs::path apart = text_apart(picture, "labels"); !apart.empty()) return apart;
  fs::path beside = picture;
  beside.replace_extension(".txt");
  return is_file(beside) ? beside : fs::path();
}

LabelledImage read_image(const fs::path& file, const std::string& name, std::size_t classes) {
  LabelledImage image{file, name, {}};
  if (const fs::path labels = labels_of(file); !labels.empty()) image.boxes = read_label_text(labels, classes);
  if (const fs::path ignored = text_apart(file, "ignored"); !ignored.empty()) {
    for (LabelledBox box : read_label_text(ignored, classes)) {
      box.ignored = true;
      image.boxes.push_back(box);
    }
  }
  return image;
}

}  // namespace

std::vector<fs::path> files_of(const fs::path& folder, const std::vector<std::string>& endings) {
  std::vector<fs::path> found;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    std::string ending = entry->path().extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (std::find(endings.begin(), endings.end(), ending) != endings.end() && is_file(entry->path())) found.push_back(entry->path());
  }
  if (error) throw Error(folder, "cannot be read: " + error.message());
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<std::string> darknet_splits(const fs::path& data) {
  const DataFile file = read_data_file(data);
  std::vector<std::string> splits;
  for (const char* split : {"train", "valid", "test"}) {
    if (file.values.count(split) != 0) splits.emplace_back(split);
  }
  if (splits.empty()) throw Error(data, "names no pictures; expected lines like train = train.txt, valid = ..., test = ...");
  return splits;
}

LabelledSet read_darknet_set(const fs::path& data, const std::string& split) {
  const DataFile file = read_data_file(data);
  const fs::path folder = data.parent_path();
  const auto path_of = [&](const std::string& key) {
    const std::string& value = file.values.at(key);
    if (value.empty()) throw Error(data, file.lines.at(key), "'" + key + "' is empty; expected a file");
    return folder / value;
  };
  if (file.values.count("names") == 0) throw Error(data, "no 'names'; expected a line like names = classes.names");
  LabelledSet set;
  set.classes = read_class_list(path_of("names"));
  const auto classes = file.values.find("classes");
  if (classes != file.values.end() && classes->second != std::to_string(set.classes.size())) {
    throw Error(data, file.lines.at("classes"),
                "classes = '" + classes->second.substr(0, 40) + "'; expected " + std::to_string(set.classes.size()) + ", as many as " +
                    path_of("names").string() + " has names");
  }
  std::set<std::string> seen;  // valid and test often are one list
  for (const std::string& part : darknet_splits(data)) {
    if (split != "all" && split != part) continue;
    const fs::path list = path_of(part);
    const std::vector<std::string> lines = read_lines(list);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      if (lines[i].empty() || !seen.insert(lines[i]).second) continue;
      const fs::path picture = folder / lines[i];
      if (!is_file(picture)) {
        throw Error(list, static_cast<int>(i) + 1, "no picture '" + lines[i].substr(0, 120) + "'; expected a file in " + folder.string());
      }
      set.images.push_back(read_image(picture, lines[i], set.classes.size()));
    }
  }
  return set;
}

std::optional<fs::path> loose_names(const fs::path& folder) {
  std::vector<fs::path> found;
  for (const fs::path& place : {folder, folder / "images", folder / "labels"}) {
    if (!fs::is_directory(place)) continue;
    for (const fs::path& file : files_of(place, {".names"})) found.push_back(file);
    if (is_file(place / "classes.txt")) found.push_back(place / "classes.txt");
  }
  if (found.size() > 1) {
    throw Error(folder, "holds " + found[0].filename().string() + " and " + found[1].filename().string() +
                            "; expected one file of class names, *.names or classes.txt");
  }
  if (found.empty()) return std::nullopt;
  return found.front();
}

LabelledSet read_loose_set(const fs::path& folder, const fs::path& names) {
  LabelledSet set;
  set.classes = read_class_list(names);
  for (const fs::path& place : {folder, folder / "images"}) {
    if (!fs::is_directory(place)) continue;
    for (const fs::path& picture : pictures_in(place)) {
      set.images.push_back(read_image(picture, picture.lexically_relative(folder).generic_string(), set.classes.size()));
    }
  }
  return set;
}

}  // namespace waretwin

#include "harness/labelled/labelled_set.h"

#include <algorithm>
#include <map>
#include <sstream>

#include "core/error.h"
#include "core/files.h"

namespace waretwin {
namespace {

namespace fs = std::filesystem;

std::string trimmed(const std::string& text) {
  const auto begin = text.find_first_not_of(" \t\r"), end = text.find_last_not_of(" \t\r");
  return begin == std::string::npos ? "" : text.substr(begin, end - begin + 1);
}

std::vector<std::string> lines_of(const fs::path& file) {
  std::istringstream text(read_file(file));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(trimmed(line));
  while (!lines.empty() && lines.back().empty()) lines.pop_back();
  return lines;
}

fs::path data_file_of(const fs::path& dataset) {
  if (dataset.extension() == ".data") return dataset;
  std::vector<fs::path> found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(dataset, error)) {
    if (entry.path().extension() == ".data") found.push_back(entry.path());
  }
  if (error) throw Error(dataset, "cannot be read: " + error.message());
  if (found.size() != 1) throw Error(dataset, std::to_string(found.size()) + " .data files; expected one");
  return found.front();
}

// labels/NAME.txt for images/NAME.jpg; NAME.txt beside any other picture.
fs::path label_file_of(const fs::path& picture) {
  fs::path labels = picture;
  labels.replace_extension(".txt");
  if (picture.parent_path().filename() == "images") {
    const fs::path apart = picture.parent_path().parent_path() / "labels" / labels.filename();
    if (fs::exists(apart)) return apart;
  }
  return labels;
}

std::vector<LabelledBox> read_boxes(const fs::path& file, std::size_t classes) {
  std::vector<LabelledBox> boxes;
  if (!fs::exists(file)) return boxes;
  const std::vector<std::string> lines = lines_of(file);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (lines[i].empty()) continue;
    std::istringstream line(lines[i]);
    long number = 0;
    double cx = 0, cy = 0, w = 0, h = 0;
    if (!(line >> number >> cx >> cy >> w >> h) || !(w > 0) || !(h > 0) || w > 1.001 || h > 1.001 || number < 0) {
      throw Error(file, static_cast<int>(i) + 1,
                  "'" + lines[i].substr(0, 60) + "'; expected: class x y width height, shares of the picture");
    }
    if (number >= static_cast<long>(classes)) {
      throw Error(file, static_cast<int>(i) + 1, "class " + std::to_string(number) + "; the set names " + std::to_string(classes));
    }
    boxes.push_back({static_cast<int>(number), cv::Rect2d(cx - 0.5 * w, cy - 0.5 * h, w, h)});
  }
  return boxes;
}

}  // namespace

LabelledSet read_labelled_set(const fs::path& dataset, const std::string& split) {
  const fs::path data = data_file_of(dataset);
  std::map<std::string, std::string> values;
  for (const std::string& line : lines_of(data)) {
    const auto equals = line.find('=');
    if (equals != std::string::npos) values[trimmed(line.substr(0, equals))] = trimmed(line.substr(equals + 1));
  }
  const auto named = [&](const std::string& key) {
    if (values[key].empty()) throw Error(data, "names no '" + key + "'");
    return data.parent_path() / values[key];
  };
  LabelledSet set;
  set.classes = lines_of(named("names"));
  const fs::path list = named(split);
  for (const std::string& line : lines_of(list)) {
    if (line.empty()) continue;
    LabelledImage image{data.parent_path() / line, line, {}};
    image.boxes = read_boxes(label_file_of(image.file), set.classes.size());
    set.images.push_back(std::move(image));
  }
  return set;
}

}  // namespace waretwin

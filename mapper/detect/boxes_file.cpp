#include "mapper/detect/boxes_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "core/error.h"
#include "core/files.h"
#include "core/json_text.h"
#include "mapper/detect/model_files.h"
#include "sensors/recordings/text_formats.h"

namespace waretwin {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr double kLargestCoordinate = 1e6;  // pixels
constexpr int kLargestSide = 30'000;        // of a picture, pixels

std::string shown(const json& value) { return value.dump().substr(0, 60); }

const json& member(const std::filesystem::path& file, const json& object, const std::string& where, const std::string& key) {
  if (!object.is_object()) throw Error(file, where + " is " + shown(object) + "; expected an object with \"" + key + "\"");
  const auto found = object.find(key);
  if (found == object.end()) throw Error(file, where + " has no \"" + key + "\"");
  return *found;
}

std::vector<int> read_runs(const json& counts) {
  if (counts.is_string()) return read_compressed_runs(counts.get_ref<const std::string&>());
  std::vector<int> runs;
  for (const json& count : counts) {
    if (!count.is_number_integer() || count.get<std::int64_t>() < 0 || count.get<std::int64_t>() > kMostMaskPixels) {
      throw Error("has a run of " + shown(count) + " pixels");
    }
    runs.push_back(count.get<int>());
  }
  return runs;
}

MaskRuns read_mask(const fs::path& file, const json& entry, const std::string& where) {
  const json& size = member(file, entry, where, "size");
  const auto side = [&](std::size_t i) {
    const bool usable = size.is_array() && size.size() == 2 && size[i].is_number_integer() && size[i].get<std::int64_t>() >= 1 &&
                        size[i].get<std::int64_t>() <= kLargestSide;
    if (!usable) throw Error(file, where + ": size is " + shown(size) + "; expected [height, width] of the picture in pixels");
    return size[i].get<int>();
  };
  MaskRuns mask{cv::Size(side(1), side(0)), {}};
  const json& counts = member(file, entry, where, "counts");
  if (!counts.is_string() && !counts.is_array()) {
    throw Error(file, where + ": counts is " + shown(counts) + "; expected COCO's run lengths, as a text or a list");
  }
  try {
    mask.runs = read_runs(counts);
    expect_whole(mask);
  } catch (const Error& error) {
    throw Error(file, where + ": counts " + error.what());
  }
  return mask;
}

Detection read_detection(const std::filesystem::path& file, const json& entry, const std::string& where) {
  Detection detection;
  const json& name = member(file, entry, where, "class");
  if (!name.is_string() || name.get_ref<const std::string&>().empty()) {
    throw Error(file, where + ": class is " + shown(name) + "; expected a name");
  }
  detection.class_name = name.get<std::string>();
  const json& box = member(file, entry, where, "box");
  double numbers[4] = {0, 0, 0, 0};
  bool usable = box.is_array() && box.size() == 4;
  for (std::size_t i = 0; usable && i < 4; ++i) {
    usable = box[i].is_number() && std::abs(box[i].get<double>()) <= kLargestCoordinate;
    if (usable) numbers[i] = box[i].get<double>();
  }
  if (!usable || numbers[2] <= 0.0 || numbers[3] <= 0.0) {
    throw Error(file, where + ": box is " + shown(box) + "; expected [x, y, width, height] in pixels, width and height above 0");
  }
  detection.box = cv::Rect2f(static_cast<float>(numbers[0]), static_cast<float>(numbers[1]), static_cast<float>(numbers[2]),
                             static_cast<float>(numbers[3]));
  if (const auto score = entry.find("score"); score != entry.end()) {
    if (!score->is_number() || score->get<double>() < 0.0 || score->get<double>() > 1.0) {
      throw Error(file, where + ": score is " + shown(*score) + "; expected a number from 0 to 1");
    }
    detection.score = score->get<float>();
  }
  for (const char* other : {"masks", "segmentation", "rle"}) {
    if (entry.contains(other)) throw Error(file, where + " has \"" + other + "\"; expected a mask under \"mask\"");
  }
  if (const auto mask = entry.find("mask"); mask != entry.end() && !mask->is_null())
    detection.mask = read_mask(file, *mask, where + ".mask");
  return detection;
}

FrameBoxes read_json(const fs::path& file) {
  FrameBoxes boxes;
  const json document = parse_json<json>(file, read_file(file, std::uintmax_t{1} << 30), "an object with a list \"frames\"");
  const json& frames = member(file, document, "the file", "frames");
  if (!frames.is_array()) throw Error(file, "frames is " + shown(frames) + "; expected a list");
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::string where = "frames[" + std::to_string(i) + "]";
    const json& stamp = member(file, frames[i], where, "stamp");
    if (!stamp.is_number_integer()) throw Error(file, where + ": stamp is " + shown(stamp) + "; expected whole nanoseconds");
    const json& detections = member(file, frames[i], where, "detections");
    if (!detections.is_array()) throw Error(file, where + ": detections is " + shown(detections) + "; expected a list");
    const auto [entry, added] = boxes.try_emplace(stamp.get<Stamp>());
    if (!added) throw Error(file, where + ": stamp " + shown(stamp) + " stands twice");
    for (std::size_t k = 0; k < detections.size(); ++k) {
      entry->second.push_back(read_detection(file, detections[k], where + ".detections[" + std::to_string(k) + "]"));
    }
  }
  return boxes;
}

bool is_number(const std::string& word) {
  return !word.empty() && std::all_of(word.begin(), word.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

// A name that is a time, as "1654000000.123456"; not "classes" or "README".
bool is_stamp(const std::string& stem) {
  const std::size_t dot = std::min(stem.find('.'), stem.size());
  return is_number(stem.substr(0, dot)) && (dot == stem.size() || is_number(stem.substr(dot + 1)));
}

std::vector<fs::path> text_files(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".txt") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

// The names of class numbers: a file that the configuration names, or the one that lies in the folder.
class ClassNumbers {
 public:
  ClassNumbers(const fs::path& folder, const std::string& named, const std::vector<std::string>& rename) {
    for (const std::string& pair : rename) renamed_.insert(pair.substr(0, pair.find('=')));
    if (!named.empty()) {
      file_ = named;
    } else if (fs::exists(folder / "classes.txt")) {
      file_ = folder / "classes.txt";
    } else {
      for (const auto& entry : fs::directory_iterator(folder)) {
        if (entry.path().extension() == ".names") file_ = entry.path();
      }
    }
    if (!file_.empty()) names_ = read_class_names(file_);
  }
  std::string name(const fs::path& file, int line, const std::string& word) const {
    // A number that is renamed needs no name before.
    if (!is_number(word) || renamed_.contains(word)) return word;
    if (file_.empty()) {
      throw Error(file, line,
                  "class " + word + " has no name; expected mapper.detect.names, or classes.txt or a .names file beside the boxes");
    }
    const std::size_t number = word.size() <= 6 ? std::stoul(word) : names_.size();
    if (number >= names_.size()) {
      throw Error(
          file, line,
          "class " + word + " has no name; expected 0 to " + std::to_string(names_.size() - 1) + ", the lines of " + file_.string());
    }
    return names_[number];
  }

 private:
  fs::path file_;
  std::vector<std::string> names_;
  std::set<std::string> renamed_;
};

Detection read_row(const fs::path& file, const TextLine& row, const ClassNumbers& classes) {
  const std::size_t words = row.words.size();
  if (words != 5 && words != 6) {
    throw Error(file, row.line, "has " + std::to_string(words) + " words; expected 'class x y w h' or 'class x y w h score'");
  }
  double numbers[5] = {0, 0, 0, 0, 1};
  for (std::size_t i = 1; i < words; ++i) {
    numbers[i - 1] = parse_text_number(file, row.line, row.words[i]);
    if (!(std::abs(numbers[i - 1]) <= kLargestCoordinate)) throw Error(file, row.line, "'" + row.words[i] + "' is no pixel");
  }
  const auto& [x, y, w, h, score] = numbers;
  if (w <= 0.0 || h <= 0.0) throw Error(file, row.line, "the box is " + row.words[3] + " x " + row.words[4] + " pixels; expected above 0");
  if (x <= 1.0 && y <= 1.0 && w <= 1.0 && h <= 1.0) {
    throw Error(file, row.line, "the box is within one pixel, as shares of a picture are; expected pixels: class x y w h score");
  }
  if (score < 0.0 || score > 1.0) throw Error(file, row.line, "the score is " + row.words[5] + "; expected a number from 0 to 1");
  return {classes.name(file, row.line, row.words[0]),
          cv::Rect2f(static_cast<float>(x), static_cast<float>(y), static_cast<float>(w), static_cast<float>(h)),
          static_cast<float>(score)};
}

FrameBoxes read_folder(const fs::path& folder, const DetectConfig& config) {
  const std::string& names = config.names;
  const ClassNumbers classes(folder, names, config.rename);
  FrameBoxes boxes;
  for (const fs::path& file : text_files(folder)) {
    const std::string stem = file.stem().string();
    if (stem == "classes" || file == fs::path(names)) continue;
    if (!is_stamp(stem))
      throw Error(file, "its name is no stamp; expected one file a frame, called by its seconds (1654000000.123456.txt)");
    std::vector<Detection>& detections = boxes[parse_text_stamp(file, 0, stem)];
    for (const TextLine& row : read_text_lines(file)) detections.push_back(read_row(file, row, classes));
  }
  if (boxes.empty()) throw Error(folder, "holds no boxes; expected a text file a frame, called by its stamp");
  return boxes;
}

// The names that the configuration changes and keeps.
void apply_names(FrameBoxes& boxes, const DetectConfig& config) {
  std::map<std::string, std::string> rename;
  for (const std::string& pair : config.rename) {
    const std::size_t equals = pair.find('=');
    if (equals == 0 || equals == std::string::npos || equals + 1 == pair.size())
      throw Error("detector rename '" + pair + "'; expected from=to");
    rename[pair.substr(0, equals)] = pair.substr(equals + 1);
  }
  for (auto& [stamp, detections] : boxes) {
    for (Detection& detection : detections) {
      if (const auto found = rename.find(detection.class_name); found != rename.end()) detection.class_name = found->second;
    }
    if (config.classes.empty()) continue;
    std::erase_if(detections, [&](const Detection& d) {
      return std::find(config.classes.begin(), config.classes.end(), d.class_name) == config.classes.end();
    });
  }
}

}  // namespace

bool is_boxes(const fs::path& path) {
  if (!fs::is_directory(path)) return path.extension() == ".json";
  const std::vector<fs::path> files = text_files(path);
  return std::any_of(files.begin(), files.end(), [](const fs::path& file) { return is_stamp(file.stem().string()); });
}

FrameBoxes read_boxes(const fs::path& path, const DetectConfig& config) {
  if (!fs::exists(path)) throw Error(path, "no such file or folder with boxes");
  FrameBoxes boxes = fs::is_directory(path) ? read_folder(path, config) : read_json(path);
  apply_names(boxes, config);
  return boxes;
}

}  // namespace waretwin

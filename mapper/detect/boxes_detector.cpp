#include "mapper/detect/boxes_detector.h"

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files.h"

namespace waretwin {
namespace {

using nlohmann::json;

constexpr Stamp kTolerance = 1'000'000;
constexpr double kLargestCoordinate = 1e6;  // pixels

std::string shown(const json& value) { return value.dump().substr(0, 60); }

const json& member(const std::filesystem::path& file, const json& object, const std::string& where, const std::string& key) {
  if (!object.is_object()) throw Error(file, where + " is " + shown(object) + "; expected an object with \"" + key + "\"");
  const auto found = object.find(key);
  if (found == object.end()) throw Error(file, where + " has no \"" + key + "\"");
  return *found;
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
  return detection;
}

}  // namespace

BoxesDetector::BoxesDetector(const std::filesystem::path& file) {
  json document;
  try {
    document = json::parse(read_file(file, std::uintmax_t{1} << 30));
  } catch (const json::exception& problem) {
    throw Error(file, std::string("not JSON: ") + problem.what());
  }
  const json& frames = member(file, document, "the file", "frames");
  if (!frames.is_array()) throw Error(file, "frames is " + shown(frames) + "; expected a list");
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::string where = "frames[" + std::to_string(i) + "]";
    const json& stamp = member(file, frames[i], where, "stamp");
    if (!stamp.is_number_integer()) throw Error(file, where + ": stamp is " + shown(stamp) + "; expected whole nanoseconds");
    const json& detections = member(file, frames[i], where, "detections");
    if (!detections.is_array()) throw Error(file, where + ": detections is " + shown(detections) + "; expected a list");
    const auto [entry, added] = frames_.try_emplace(stamp.get<Stamp>());
    if (!added) throw Error(file, where + ": stamp " + shown(stamp) + " stands twice");
    for (std::size_t k = 0; k < detections.size(); ++k) {
      entry->second.push_back(read_detection(file, detections[k], where + ".detections[" + std::to_string(k) + "]"));
    }
  }
}

std::vector<Detection> BoxesDetector::detect(const RgbdFrame& frame) {
  auto nearest = frames_.lower_bound(frame.stamp);
  if (nearest != frames_.begin()) {
    const auto before = std::prev(nearest);
    if (nearest == frames_.end() || frame.stamp - before->first <= nearest->first - frame.stamp) nearest = before;
  }
  std::vector<Detection> detections;
  if (nearest == frames_.end() || std::abs(nearest->first - frame.stamp) > kTolerance) return detections;
  const cv::Mat& picture = frame.colour.empty() ? frame.depth : frame.colour;
  const cv::Rect2f whole(0.0f, 0.0f, static_cast<float>(picture.cols), static_cast<float>(picture.rows));
  for (Detection detection : nearest->second) {
    detection.box &= whole;
    if (detection.box.width > 0.0f && detection.box.height > 0.0f) detections.push_back(std::move(detection));
  }
  return detections;
}

}  // namespace waretwin

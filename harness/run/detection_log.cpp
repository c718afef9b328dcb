#include "harness/run/detection_log.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace waretwin {

void DetectionLogConfig::visit(Fields& f) {
  labels.visit(f);
  f("match_iou", match_iou, "a box is found from this overlap with the visible one on", {.min = 0.01, .max = 1});
}

DetectionLog::DetectionLog(const Scene& scene, const DetectionLogConfig& config) : config_(config) {
  for (const TrueObject& object : scene.objects) {
    class_of_object_[object.id] = object.class_name;
    if (!class_index(object.class_name)) classes_.push_back(object.class_name);
  }
}

std::optional<int> DetectionLog::class_index(const std::string& name) const {
  const auto found = std::find(classes_.begin(), classes_.end(), name);
  if (found == classes_.end()) return {};
  return static_cast<int>(found - classes_.begin());
}

void DetectionLog::add(const RgbdFrame& frame, const std::vector<Detection>& detections, const std::vector<ObjectView>& views) {
  ScoredPicture picture;
  nlohmann::ordered_json line;
  line["stamp_ns"] = frame.stamp;
  line["sensor"] = frame.sensor;
  line["detections"] = nlohmann::ordered_json::array();
  for (const Detection& d : detections) {
    line["detections"].push_back({{"class", d.class_name}, {"box", {d.box.x, d.box.y, d.box.width, d.box.height}}, {"score", d.score}});
    if (const auto index = class_index(d.class_name)) {
      picture.detections.push_back({*index, cv::Rect2d(d.box), static_cast<double>(d.score)});
    } else {
      ++other_detections_;
    }
  }
  line["truth"] = nlohmann::ordered_json::array();
  for (const ObjectView& view : views) {
    if (view.visible_px == 0) continue;
    const std::string& name = class_of_object_.at(view.id);
    const cv::Rect& box = view.visible_box;
    const bool ignored = !config_.labels.labels(view);
    line["truth"].push_back({{"id", view.id},
                             {"class", name},
                             {"box", {box.x, box.y, box.width, box.height}},
                             {"visible", std::round(view.visible() * 1e4) / 1e4},
                             {"ignored", ignored}});
    picture.truth.push_back({*class_index(name), cv::Rect2d(box), static_cast<double>(view.visible_px), ignored});
  }
  pictures_.push_back(std::move(picture));
  lines_ += line.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::optional<DetectionScore> DetectionLog::score() const {
  if (pictures_.empty() || class_of_object_.empty()) return {};
  DetectionScore score = score_detections(pictures_, classes_, {.confidence = 0.0, .match_iou = config_.match_iou});
  score.other_detections = other_detections_;
  return score;
}

}  // namespace waretwin

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/version.h"
#include "harness/score/detection_json.h"
#include "harness/score/number_text.h"

namespace waretwin {

namespace {

using Json = nlohmann::ordered_json;

Json or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

Json class_json(const DetectionScore& score, std::size_t k) {
  const ThresholdFigures& t = score.at_threshold.classes[k];
  return {{"class", score.classes[k]},
          {"labels", score.labels[k]},
          {"ap50", or_null(score.coco.classes[k].ap50)},
          {"ap", or_null(score.coco.classes[k].ap)},
          {"ap75", or_null(score.coco.classes[k].ap75)},
          {"ar100", or_null(score.coco.classes[k].ar100)},
          {"pascal_ap", or_null(score.pascal.classes[k].every_point)},
          {"pascal_ap_11point", or_null(score.pascal.classes[k].eleven_point)},
          {"precision", or_null(t.precision())},
          {"recall", or_null(t.recall())},
          {"tp", t.right},
          {"fp", t.wrong},
          {"fn", t.missed}};
}

std::string padded(std::string text, std::size_t width, bool left = false) {
  if (text.size() < width) text.insert(left ? text.size() : 0, width - text.size(), ' ');
  return text;
}

std::string class_or(const DetectionScore& score, const std::optional<int>& index, const char* otherwise) {
  return index ? score.classes[static_cast<std::size_t>(*index)] : otherwise;
}

}  // namespace

void add_figures(Json& json, const DetectionScore& score) {
  const CocoFigures& coco = score.coco.all;
  const ThresholdFigures& t = score.at_threshold.all;
  json["ap50"] = or_null(coco.ap50);
  json["ap"] = or_null(coco.ap);
  json["precision"] = or_null(t.precision());
  json["recall"] = or_null(t.recall());
  json["ap75"] = or_null(coco.ap75);
  json["ap_small"] = or_null(coco.ap_small);
  json["ap_medium"] = or_null(coco.ap_medium);
  json["ap_large"] = or_null(coco.ap_large);
  json["ar1"] = or_null(coco.ar1);
  json["ar10"] = or_null(coco.ar10);
  json["ar100"] = or_null(coco.ar100);
  json["ar_small"] = or_null(coco.ar_small);
  json["ar_medium"] = or_null(coco.ar_medium);
  json["ar_large"] = or_null(coco.ar_large);
  json["pascal_ap"] = or_null(score.pascal.all.every_point);
  json["pascal_ap_11point"] = or_null(score.pascal.all.eleven_point);
  json["map_paper"] = or_null(score.at_threshold.map_paper);
  json["tp"] = t.right;
  json["fp"] = t.wrong;
  json["fn"] = t.missed;
  json["classes"] = Json::array();
  for (std::size_t k = 0; k < score.classes.size(); ++k) json["classes"].push_back(class_json(score, k));
  json["confusions"] = Json::array();
  for (const Confusion& confusion : score.at_threshold.confusions) {
    const auto name = [&](const std::optional<int>& k) { return k ? Json(score.classes[static_cast<std::size_t>(*k)]) : Json(nullptr); };
    json["confusions"].push_back({{"truth", name(confusion.truth)}, {"detected", name(confusion.detected)}, {"count", confusion.count}});
  }
}

std::string metrics_json(const DetectionScore& score, const DetectionRunFacts& facts) {
  Json json;
  json["schema"] = 1;
  json["version"] = kVersion;
  json["model"] = facts.model;
  json["dataset"] = facts.dataset;
  json["split"] = facts.split;
  json["images"] = score.images;
  json["labels"] = score.label_count();
  json["ignored_labels"] = score.ignored_labels;
  json["other_detections"] = score.other_detections;
  json["confidence"] = score.rules.confidence;
  json["match_iou"] = score.rules.match_iou;
  json["ap_confidence"] = facts.collect_confidence;
  add_figures(json, score);
  json["median_ms"] = facts.median_ms;
  // Names come from people's files, in whatever encoding.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string metrics_table(const DetectionScore& score, const DetectionRunFacts& facts) {
  constexpr std::size_t kMostConfusions = 10;
  const auto row = [](const std::string& name, int labels, const CocoFigures& coco, const ThresholdFigures& t) {
    return padded(name, 22, true) + padded(std::to_string(labels), 8) + padded(number("%.3f", coco.ap50), 8) +
           padded(number("%.3f", coco.ap), 8) + padded(number("%.3f", coco.ap75), 8) + padded(number("%.3f", coco.ar100), 8) +
           padded(number("%.3f", t.precision()), 11) + padded(number("%.3f", t.recall()), 8) + "\n";
  };
  std::string text = padded("class", 22, true) + "  labels    AP50      AP    AP75   AR100  precision  recall\n";
  for (std::size_t k = 0; k < score.classes.size(); ++k) {
    const ThresholdFigures& t = score.at_threshold.classes[k];
    if (score.labels[k] == 0 && t.wrong == 0) continue;
    text += row(score.classes[k], score.labels[k], score.coco.classes[k], t);
  }
  text += row("all", score.label_count(), score.coco.all, score.at_threshold.all);
  text += "\nprecision and recall at score " + number("%.3g", score.rules.confidence) + ", IoU " + number("%.3g", score.rules.match_iou) +
          "; mAP as in the paper " + number("%.3f", score.at_threshold.map_paper) + "; Pascal AP " +
          number("%.3f", score.pascal.all.every_point) + " (11 points " + number("%.3f", score.pascal.all.eleven_point) + ")\n";
  const std::vector<Confusion>& confusions = score.at_threshold.confusions;
  for (std::size_t i = 0; i < std::min(confusions.size(), kMostConfusions); ++i) {
    const Confusion& c = confusions[i];
    text += (i == 0 ? "what is wrong: " : "               ") + class_or(score, c.truth, "background") +
            (c.detected ? " taken for " + class_or(score, c.detected, "") : " missed") + ", " + std::to_string(c.count) + " times\n";
  }
  text += std::to_string(score.images) + " pictures, " + number("%.1f", facts.median_ms) + " ms each (median)\n";
  return text;
}

}  // namespace waretwin

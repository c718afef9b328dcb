#include <nlohmann/json.hpp>

#include "core/version.h"
#include "harness/score/scenenn_paper.h"
#include "harness/score/scenenn_report.h"

namespace waretwin {

namespace {

using Json = nlohmann::ordered_json;

constexpr int kSceneNnSchema = 1;

Json or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

Json times_json(const std::optional<StageTimes>& times) {
  if (!times) return nullptr;
  return {{"frames", times->frames},       {"localise", times->localise},   {"detect", times->detect}, {"segment", times->segment},
          {"associate", times->associate}, {"integrate", times->integrate}, {"total", times->total()}};
}

Json sequence_json(const SequenceScore& sequence) {
  Json classes = Json::array();
  for (const ClassScore& one : sequence.classes) {
    classes.push_back({{"class", one.class_name},
                       {"truth", one.truth},
                       {"mapped", one.mapped},
                       {"assigned", one.assigned},
                       {"matched", one.matched},
                       {"mean_iou3d", or_null(one.mean_iou3d)},
                       {"ap_paper", or_null(one.ap_paper)},
                       {"ap50", or_null(one.ap50)}});
  }
  return {{"name", sequence.name},
          {"classes", classes},
          {"mean_iou3d", or_null(sequence.mean_iou3d)},
          {"mean_iou3d_found", or_null(sequence.mean_iou3d_found)},
          {"map_paper", or_null(sequence.map_paper)},
          {"ap50", or_null(sequence.ap50)},
          {"timing_ms", times_json(sequence.times)}};
}

// How many times as long the paper takes; null where we take no time.
Json ratios_json(const StageTimes& times, double PaperModule::*column) {
  const std::vector<std::pair<const char*, double>> ours = {{"detect", times.detect},
                                                            {"segment", times.segment},
                                                            {"associate", times.associate},
                                                            {"integrate", times.integrate},
                                                            {"total", times.total()}};
  Json json;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    const auto& [name, ms] = ours[i];
    json[name] = ms > 0.0 ? Json(paper_table4()[i].*column / ms) : Json(nullptr);
  }
  return json;
}

Json published_sequences(const std::vector<PaperSequence>& rows) {
  Json list = Json::array();
  for (const PaperSequence& row : rows) {
    Json json = {{"sequence", row.id}, {"classes", Json::object()}, {"average", row.average}};
    for (std::size_t i = 0; i < row.classes.size(); ++i) {
      if (row.classes[i]) json["classes"][kSceneNnClasses[i]] = *row.classes[i];
    }
    if (row.average_voxbloxpp) json["average_voxbloxpp"] = *row.average_voxbloxpp;
    list.push_back(std::move(json));
  }
  return list;
}

Json published_json() {
  Json json = {{"source", "Zhou et al., Efficient Object-Level Semantic Mapping with RGB-D Cameras, Tables 1 to 5, as printed"},
               {"iou3d_percent", published_sequences(paper_table1())},
               {"ap_percent", published_sequences(paper_table2())},
               {"map_percent", Json::array()},
               {"timing_ms", Json::array()},
               {"systems", Json::array()}};
  for (const PaperMethod& row : paper_table3()) {
    Json method = {{"method", row.name}, {"sequences", Json::object()}, {"average", row.average}};
    for (std::size_t i = 0; i < row.sequences.size(); ++i) method["sequences"][kSceneNnSequences[i]] = row.sequences[i];
    json["map_percent"].push_back(std::move(method));
  }
  for (const PaperModule& row : paper_table4())
    json["timing_ms"].push_back({{"module", row.name}, {"cpu", row.cpu_ms}, {"gpu", row.gpu_ms}});
  for (const PaperSystem& row : paper_table5()) {
    json["systems"].push_back(
        {{"method", row.name}, {"platform", row.platform}, {"frequency", row.frequency}, {"map", row.map}, {"fps", row.fps}});
  }
  return json;
}

}  // namespace

std::string scenenn_json(const SceneNnScore& score) {
  Json json = {{"schema", kSceneNnSchema}, {"version", kVersion}, {"protocol", "scenenn"}};
  json["rules"] = {{"max_centre_distance_m", score.rules.max_centre_distance_m},
                   {"match_iou", score.rules.match_iou},
                   {"min_visible_fraction", score.rules.min_visible_fraction}};
  json["summary"] = {{"sequences", score.sequences.size()},
                     {"mean_iou3d", or_null(score.mean_iou3d)},
                     {"map_paper", or_null(score.map_paper)},
                     {"ap50", or_null(score.ap50)}};
  json["classes"] = Json::array();
  for (const ClassMean& one : score.classes) {
    json["classes"].push_back({{"class", one.class_name},
                               {"sequences", one.sequences},
                               {"mean_iou3d", one.mean_iou3d},
                               {"ap_paper", one.ap_paper},
                               {"ap50", one.ap50}});
  }
  json["sequences"] = Json::array();
  for (const SequenceScore& sequence : score.sequences) json["sequences"].push_back(sequence_json(sequence));
  json["timing_ms"] = times_json(score.times);
  if (score.times) {
    json["timing_ms"]["fps"] = score.times->total() > 0.0 ? Json(1000.0 / score.times->total()) : Json(nullptr);
    json["timing_ms"]["paper_cpu_ratio"] = ratios_json(*score.times, &PaperModule::cpu_ms);
    json["timing_ms"]["paper_gpu_ratio"] = ratios_json(*score.times, &PaperModule::gpu_ms);
  }
  json["published"] = published_json();
  // Folders may have names that are no UTF-8.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace waretwin

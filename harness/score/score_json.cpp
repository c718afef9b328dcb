#include "harness/score/score_json.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/cpu_features.h"
#include "core/pose.h"
#include "core/version.h"
#include "harness/score/detection_json.h"

namespace waretwin {

namespace {

using Json = nlohmann::ordered_json;

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json objects_json(const ObjectListScore& score) {
  Json list = Json::array();
  for (const ObjectScore& row : score.objects) {
    list.push_back({{"truth_id", row.truth_id},
                    {"map_id", or_null(row.map_id)},
                    {"class", row.class_name},
                    {"iou3d", row.iou3d},
                    {"e_trans_m", or_null(row.e_trans_m)},
                    {"e_rot_deg", or_null(row.e_rot_deg)},
                    {"visible_fraction", row.visible_fraction},
                    {"counted", row.counted}});
  }
  return list;
}

Json summary_json(const ScoreSummary& summary) {
  return {{"truth", summary.truth},
          {"mapped", summary.mapped},
          {"matched", summary.matched},
          {"recall", or_null(summary.recall)},
          {"precision", or_null(summary.precision)},
          {"mean_iou3d", or_null(summary.mean_iou3d)},
          {"mean_e_trans_m", or_null(summary.mean_e_trans_m)},
          {"mean_e_rot_deg", or_null(summary.mean_e_rot_deg)},
          {"ap50", or_null(summary.ap50)},
          {"map_paper", or_null(summary.map_paper)}};
}

void add_objects(Json& json, const ComparedLists& objects) {
  json["objects"] = objects_json(objects.plain);
  json["summary"] = summary_json(objects.plain.summary);
  json["objects_aligned"] = objects.aligned ? objects_json(*objects.aligned) : Json(nullptr);
  json["summary_aligned"] = objects.aligned ? summary_json(objects.aligned->summary) : Json(nullptr);
  json["explanations"] = Json::array();
  for (const Explanation& line : objects.explanations) {
    json["explanations"].push_back({{"truth_id", or_null(line.truth_id)}, {"map_id", or_null(line.map_id)}, {"text", line.text}});
  }
  json["alignment"] = nullptr;
  if (objects.X_TM) {
    const Eigen::Vector3d shift = objects.X_TM->translation();
    json["alignment"] = {{"x_m", shift.x()}, {"y_m", shift.y()}, {"yaw_deg", to_degrees(yaw_of(*objects.X_TM))}};
  }
}

Json trajectory_json(const TrajectoryScore& score) {
  return {{"ate_rmse_m", score.ate_rmse_m},   {"ate_max_m", score.ate_max_m},     {"ate_mean_m", score.ate_mean_m},
          {"rpe_trans_m", score.rpe_trans_m}, {"rpe_rot_deg", score.rpe_rot_deg}, {"poses", score.pairs}};
}

Json motion_json(const MotionReport& motion) {
  Json json = {{"contacts", Json::array()},
               {"items",
                {{"came_in", motion.items_in},
                 {"delivered", motion.items_delivered},
                 {"in_hall", motion.items_in_hall},
                 {"fell_off", motion.items_fell_off},
                 {"fell_through", motion.items_fell_through},
                 {"waited", motion.items_waited}}},
               {"belts", Json::array()}};
  for (const RobotContact& contact : motion.contacts) {
    json["contacts"].push_back({{"with", contact.with},
                                {"begin_s", to_seconds(contact.begin)},
                                {"end_s", to_seconds(contact.end)},
                                {"x_m", contact.p_W.x()},
                                {"y_m", contact.p_W.y()},
                                {"z_m", contact.p_W.z()},
                                {"force_n", contact.force_n}});
  }
  for (const BeltReport& belt : motion.belts) {
    json["belts"].push_back({{"name", belt.name},
                             {"wanted_mps", belt.wanted_mps},
                             {"mean_ratio", belt.mean_ratio},
                             {"worst_ratio", belt.worst_ratio},
                             {"carried_s", belt.carried_s}});
  }
  return json;
}

std::string text(const Json& json) { return json.dump(2) + "\n"; }

}  // namespace

std::string score_json(const RunScore& score) {
  Json json;
  json["schema"] = kScoreSchema;
  json["scenario"] = score.scenario;
  json["profile"] = score.profile;
  json["seed"] = score.seed;
  json["version"] = kVersion;
  json["digest"] = score.digest;
  json["cpu"] = {{"model", cpu_model()}, {"features", cpu_features()}};
  json["stages"] = score.stages;
  add_objects(json, score.objects);
  json["detection"] = nullptr;
  if (score.detection) {
    json["detection"] = {{"frames", score.detection->images},
                         {"labels", score.detection->label_count()},
                         {"ignored_labels", score.detection->ignored_labels},
                         {"other_detections", score.detection->other_detections},
                         {"match_iou", score.detection->rules.match_iou}};
    add_figures(json["detection"], *score.detection);
  }
  json["depth"] = nullptr;
  if (score.depth) {
    json["depth"]["valid_share"] = score.depth->valid_share;
    json["depth"]["object_missing_share"] = score.depth->object_missing_share;
    json["depth"]["flying_share"] = score.depth->flying_share;
    json["depth"]["median_abs_error_m"] = score.depth->median_abs_error_m;
    json["depth"]["p95_abs_error_m"] = score.depth->p95_abs_error_m;
  }
  json["surface"] = nullptr;
  if (score.surface) {
    json["surface"] = {{"mean_m", score.surface->mean_m},
                       {"median_m", score.surface->median_m},
                       {"p95_m", score.surface->p95_m},
                       {"share_over_30mm", score.surface->share_over_30mm},
                       {"found", score.surface->found},
                       {"vertices", score.surface->vertices},
                       {"seen_points", score.surface->seen_points}};
  }
  json["motion"] = score.motion ? motion_json(*score.motion) : Json(nullptr);
  json["trajectory"] = nullptr;
  if (score.trajectory) {
    json["trajectory"] = trajectory_json(*score.trajectory);
    json["trajectory"]["ate_aligned_rmse_m"] = score.trajectory_aligned ? Json(score.trajectory_aligned->ate_rmse_m) : Json(nullptr);
    json["trajectory"]["unlocalised_share"] = or_null(score.unlocalised_share);
    json["trajectory"]["ate_aligned_max_m"] = score.trajectory_aligned ? Json(score.trajectory_aligned->ate_max_m) : Json(nullptr);
  }
  json["timing_ms"] = Json::object();
  for (const auto& [stage, timing] : score.timing_ms) {
    json["timing_ms"][stage] = {{"median", timing.median}, {"p95", timing.p95}, {"max", timing.max}};
  }
  json["frames"] = {{"simulated", score.frames_simulated},
                    {"mapped", score.frames_mapped},
                    {"dropped", score.frames_dropped},
                    {"without_pose", score.frames_without_pose}};
  json["rejected"] = score.rejected;
  json["realtime_factor"] = score.realtime_factor;
  json["peak_rss_mb"] = score.peak_rss_mb;
  return text(json);
}

std::string score_json(const ComparedLists& objects) {
  Json json;
  json["schema"] = kScoreSchema;
  json["version"] = kVersion;
  add_objects(json, objects);
  return text(json);
}

}  // namespace waretwin

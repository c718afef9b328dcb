#include "harness/run/budget.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "harness/calibrate/extrinsics.h"
#include "harness/run/closed_loop.h"
#include "harness/run/truth_stages.h"
#include "harness/score/number_text.h"
#include "mapper/mapper.h"

namespace waretwin {

namespace {

struct Variant {
  std::string name;
  RunConfig config;
  bool same = false;
};

std::vector<Variant> variants_of(const RunConfig& config) {
  const auto with = [&](const std::string& name, bool already, const std::function<void(RunConfig&)>& change) {
    Variant variant{name, config, already};
    change(variant.config);
    return variant;
  };
  const TruthStages& now = config.truth_stages;
  const bool depth = config.simulation.truth_depth;
  return {
      with("as configured", false, [](RunConfig&) {}),
      with("true poses", now.poses, [](RunConfig& c) { c.truth_stages.poses = true; }),
      with("true boxes", now.detector, [](RunConfig& c) { c.truth_stages.detector = true; }),
      with("true depth", depth, [](RunConfig& c) { c.simulation.truth_depth = true; }),
      with("true association", now.association, [](RunConfig& c) { c.truth_stages.association = true; }),
      with("all true", now.poses && now.detector && now.association && depth,
           [](RunConfig& c) {
             c.truth_stages = {true, true, true};
             c.simulation.truth_depth = true;
           }),
  };
}

// The event for one of several mappers. Whoever asks for the pictures first makes them, for all.
SensorEvent share_of(const SensorEvent& event, const std::shared_ptr<RgbdFrame>& pictures, bool true_depth, const SimulatedStream& stream) {
  if (!pictures) return event;
  RgbdFrame frame = std::get<RgbdFrame>(event);
  frame.load = [pictures, true_depth, &stream](RgbdFrame& f) {
    if (pictures->load) load_pictures(*pictures);
    f.colour = pictures->colour;
    f.depth = pictures->depth;
    f.native_depth = pictures->native_depth;
    if (!true_depth) return;
    const FrameTruth& truth = stream.last_frame_truth();
    WARETWIN_CHECK(truth.stamp == f.stamp && truth.sensor == f.sensor, "the mapped frame is the stream's newest");
    f.depth = depth_from_millimetres(depth_to_millimetres(truth.ideal_depth));
    f.native_depth = cv::Mat();
  };
  return frame;
}

std::optional<double> difference(const std::optional<double>& a, const std::optional<double>& b) {
  if (!a || !b) return std::nullopt;
  return *a - *b;
}

}  // namespace

std::vector<BudgetRow> run_budget(const RunConfig& config, const std::shared_ptr<const Scene>& scene,
                                  const std::vector<ListedObject>& truth, const std::function<void(double)>& progress) {
  SimulatedStream stream(config.scenario, scene, config.simulation);
  const StreamInfo told = told_by_extrinsics(stream.info(), config.extrinsics);
  std::vector<Variant> variants = variants_of(config);
  std::vector<std::unique_ptr<Mapper>> mappers;
  for (const Variant& variant : variants) {
    mappers.push_back(
        variant.same ? nullptr : std::make_unique<Mapper>(variant.config.mapper, stages_with_truth(variant.config, stream, told), told));
  }
  std::optional<Stamp> first;
  while (auto event = stream.next()) {
    std::shared_ptr<RgbdFrame> pictures;
    if (const auto* frame = std::get_if<RgbdFrame>(&*event)) pictures = std::make_shared<RgbdFrame>(*frame);
    for (std::size_t i = 0; i < variants.size(); ++i) {
      if (!mappers[i]) continue;
      const bool replaced = variants[i].config.simulation.truth_depth && !config.simulation.truth_depth;
      mappers[i]->consume(share_of(*event, pictures, replaced, stream));
    }
    const Stamp stamp = stamp_of(*event);
    if (!first) first = stamp;
    const std::optional<double> length = stream.info().duration_s;
    if (progress) progress(length && *length > 0.0 ? std::min(1.0, to_seconds(stamp - *first) / *length) : 0.0);
  }
  std::vector<BudgetRow> rows;
  for (std::size_t i = 0; i < variants.size(); ++i) {
    BudgetRow row;
    row.name = variants[i].name;
    row.same = variants[i].same;
    if (row.same) {
      row.objects = rows.front().objects;
      row.trajectory = rows.front().trajectory;
    } else {
      const ObjectMap map = mappers[i]->finish();
      row.objects = compare_lists(listed(map.objects), truth, config.score);
      std::vector<std::pair<Pose, Pose>> pairs;
      for (const TrajectoryPoint& point : map.trajectory) pairs.emplace_back(point.X_WB, stream.true_X_WB(point.stamp));
      if (!pairs.empty()) row.trajectory = score_trajectory(pairs, TrajectoryAlignment::kNone);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

std::string budget_text(const std::vector<BudgetRow>& rows, const std::string& title) {
  std::string text =
      "# Budget of errors: " + title +
      "\n\nEach row maps the same drive with the truth in place of one stage. What a stage costs is what the truth in its place gains:\n"
      "IoU that it adds, metres and degrees that it takes away. Costs do not add up: stages hide each other's errors.\n\n"
      "| stage | matched | mapped | mean IoU | translation (m) | yaw (deg) | trajectory (m) | costs IoU | costs m | costs deg |\n"
      "|---|---|---|---|---|---|---|---|---|---|\n";
  WARETWIN_CHECK(!rows.empty(), "a budget has a first row");
  const ScoreSummary& base = rows.front().objects.plain.summary;
  for (const BudgetRow& row : rows) {
    const ScoreSummary& s = row.objects.plain.summary;
    text += "| " + row.name + " | ";
    if (row.same) {
      text += "the configuration has it already | | | | | | | | |\n";
      continue;
    }
    text += std::to_string(s.matched) + " of " + std::to_string(s.truth) + " | " + std::to_string(s.mapped) + " | " +
            number("%.3f", s.mean_iou3d) + " | " + number("%.4f", s.mean_e_trans_m) + " | " + number("%.2f", s.mean_e_rot_deg) + " | " +
            (row.trajectory ? number("%.4f", row.trajectory->ate_rmse_m) : "-") + " | ";
    if (&row == &rows.front()) {
      text += "| | |\n";
      continue;
    }
    text += number("%+.3f", difference(s.mean_iou3d, base.mean_iou3d)) + " | " +
            number("%+.4f", difference(base.mean_e_trans_m, s.mean_e_trans_m)) + " | " +
            number("%+.2f", difference(base.mean_e_rot_deg, s.mean_e_rot_deg)) + " |\n";
  }
  return text;
}

}  // namespace waretwin

#include "harness/run/record.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "core/error.h"
#include "core/files.h"
#include "core/own_name.h"
#include "core/staged_folder.h"
#include "core/version.h"
#include "harness/run/run_config.h"
#include "harness/score/scenenn_annotation.h"
#include "harness/score/trajectory_file.h"
#include "harness/truth/true_list.h"
#include "mapper/frame_schedule.h"
#include "sensors/recordings/recording_writer.h"

namespace waretwin {

namespace fs = std::filesystem;

namespace {

// SceneNN calls a scene's annotation as its folder.
std::string annotation_name(const fs::path& folder) { return own_name(folder) + ".xml"; }

// A folder is replaced as a whole, so nothing but an earlier recording of a simulation may stand in it: a mistyped --out must not cost
// anybody's files, and a real recording cannot be made again.
void expect_replaceable(const fs::path& folder, bool truth_beside) {
  static const std::set<std::string> beside = {"truth.json", "config.yaml", "trajectory_truth.tum", "truth_boxes.json", "boxes.json"};
  if (!fs::exists(folder)) return;
  if (!fs::is_directory(folder)) throw Error(folder, "is a file; expected a folder or a new name");
  if (fs::is_empty(folder)) return;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (!beside.contains(name) && !is_recording_part(name) && name != annotation_name(folder)) {
      throw Error(folder, "holds '" + name +
                              "', which is no part of a simulated recording; expected a new name, an empty folder or an earlier recording");
    }
  }
  for (const std::string name : {"recording.yaml", "trajectory_truth.tum"}) {
    if (!fs::exists(folder / name) && (truth_beside || name == "recording.yaml")) {
      throw Error(folder,
                  "holds no " + name + ", as a simulated recording does; expected a new name, an empty folder or an earlier recording");
    }
  }
}

// The file that BoxesDetector reads, frame by frame.
class BoxesFile {
 public:
  explicit BoxesFile(const fs::path& file) : file_(file) {}
  void add(Stamp stamp, const std::vector<Detection>& detections) {
    nlohmann::json entry = {{"stamp", stamp}, {"detections", nlohmann::json::array()}};
    for (const Detection& d : detections) {
      nlohmann::json& found = entry["detections"].emplace_back();
      found = {{"class", d.class_name}, {"box", {d.box.x, d.box.y, d.box.width, d.box.height}}, {"score", d.score}};
      if (!d.mask.empty()) found["mask"] = {{"size", {d.mask.size.height, d.mask.size.width}}, {"counts", compressed_runs(d.mask.runs)}};
    }
    file_.append((frames_++ == 0 ? "{\"frames\":[\n" : ",\n") + entry.dump());
  }
  void close() {
    file_.append(frames_ == 0 ? "{\"frames\":[]}\n" : "\n]}\n");
    file_.close();
  }

 private:
  GrowingFile file_;
  int frames_ = 0;
};

}  // namespace

void RecordConfig::visit(Fields& f) {
  scenario.visit(f);
  f.group("simulation", simulation, "how the sensors are simulated");
  f.group("truth_detector", truth_detector, "which objects get a true box");
  f.group("bag", bag, "how a ROS bag is written (--format rosbag)");
}

RecordConfig load_record_config(const fs::path& scenario, const SimulationConfig& simulation, const std::vector<Setting>& settings) {
  RecordConfig config{load_scenario(scenario), simulation, {}, {}};
  if (!settings.empty()) apply_settings(settings, [&](Fields& f) { config.visit(f); });
  return config;
}

RecordPlan record_plan(const std::string& format) {
  RecordPlan plan;
  plan.format = format;
  plan.true_poses = format == "scenenn" || format == "7scenes";
  return plan;
}

RecordedDrive record_drive(const RecordConfig& config, const std::shared_ptr<const Scene>& scene, const RecordPlan& plan,
                           const fs::path& folder, const std::string& source,
                           const std::function<void(double, const RecordSummary&)>& progress) {
  expect_replaceable(folder, plan.truth_beside);
  SimulatedStream stream(config.scenario, scene, config.simulation);
  const StreamInfo& info = stream.info();
  calibration_of(info);  // throws before anything is written
  std::unique_ptr<SurfaceCoverage> coverage;
  if (plan.visible_share && !info.cameras.empty() && !scene->objects.empty()) {
    coverage = std::make_unique<SurfaceCoverage>(stream.ray_caster(), config.scenario.sensors.cameras, config.scenario.robot);
  }

  StagedFolder staged(folder);
  const auto writer =
      make_recording_writer(plan.format, staged.path(), info, "waretwin " + std::string(kVersion) + ", " + source, config.bag);
  std::optional<BoxesFile> boxes;
  if (plan.truth_beside || plan.true_boxes) boxes.emplace(staged.path() / (plan.truth_beside ? "truth_boxes.json" : "boxes.json"));
  TruthDetector detector(stream, config.truth_detector);
  FrameSchedule schedule(plan.rate_hz);
  RecordedDrive drive;
  RecordSummary& summary = drive.summary;
  std::optional<Stamp> first;
  int frames_seen = 0;
  while (auto event = stream.next()) {
    const Stamp stamp = stamp_of(*event);
    if (!first) first = stamp;
    if (drive.true_trajectory.empty() || drive.true_trajectory.back().stamp != stamp) {
      drive.true_trajectory.push_back({stamp, stream.true_X_WB(stamp)});
    }
    if (auto* frame = std::get_if<RgbdFrame>(&*event)) {
      ++frames_seen;
      if (schedule.due(frame->sensor, stamp)) {
        load_pictures(*frame);
        const Pose& X_WC = stream.last_frame_truth().X_WC;
        if (plan.true_poses) frame->recorded_X_WC = X_WC;
        writer->add(*frame);
        if (boxes) boxes->add(stamp, detector.detect(*frame));
        if (coverage) coverage->add_frame(frame->sensor, X_WC);
        ++summary.frames;
      }
    } else if (const auto* scan = std::get_if<LaserScan>(&*event)) {
      writer->add(*scan);
      ++summary.scans;
    } else {
      writer->add(std::get<OdometryReading>(*event));
      ++summary.readings;
    }
    summary.duration_s = to_seconds(stamp - *first);
    if (!progress) continue;
    double done = info.duration_s && *info.duration_s > 0.0 ? summary.duration_s / *info.duration_s : 0.0;
    if (info.frame_count && *info.frame_count > 0) done = std::max(done, static_cast<double>(frames_seen) / *info.frame_count);
    progress(std::min(done, 1.0), summary);
  }
  writer->finish();
  if (boxes) boxes->close();
  drive.truth = true_list(*scene, coverage.get());
  if (!plan.visible_share) {
    for (ListedObject& object : drive.truth) object.visible_fraction = 1.0;
  }
  drive.motion = stream.motion();
  if (plan.truth_beside) {
    RecordConfig resolved = config;
    write_file(staged.path() / "config.yaml", resolved_config([&](Fields& f) { resolved.visit(f); }, source));
    write_file(staged.path() / "trajectory_truth.tum", tum_text(drive.true_trajectory));
    write_file(staged.path() / "truth.json", truth_json(drive.truth));
    if (plan.format == "scenenn") write_file(staged.path() / annotation_name(folder), scenenn_annotation(drive.truth));
  }
  expect_replaceable(folder, plan.truth_beside);
  staged.commit();
  return drive;
}

}  // namespace waretwin

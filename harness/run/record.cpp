#include "harness/run/record.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "core/error.h"
#include "core/files.h"
#include "core/staged_folder.h"
#include "core/version.h"
#include "harness/run/run_config.h"
#include "harness/score/scenenn_annotation.h"
#include "harness/score/trajectory_file.h"
#include "harness/truth/true_list.h"
#include "sensors/recordings/recording_writer.h"

namespace waretwin {

namespace fs = std::filesystem;

namespace {

// SceneNN calls a scene's annotation as its folder.
std::string annotation_name(const fs::path& folder) {
  const fs::path whole = fs::absolute(folder).lexically_normal();
  return (whole.has_filename() ? whole : whole.parent_path()).filename().string() + ".xml";
}

// A folder is replaced as a whole, so nothing but an earlier recording of a simulation may stand in it: a mistyped --out must not cost
// anybody's files, and a real recording cannot be made again.
void expect_replaceable(const fs::path& folder) {
  static const std::set<std::string> beside = {"truth.json", "config.yaml", "trajectory_truth.tum", "truth_boxes.json"};
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
  for (const char* name : {"recording.yaml", "trajectory_truth.tum"}) {
    if (!fs::exists(folder / name)) {
      throw Error(folder, "holds no " + std::string(name) +
                              ", as a simulated recording does; expected a new name, an empty folder or an earlier recording");
    }
  }
}

// One frame of the file that BoxesDetector reads.
std::string boxes_entry(Stamp stamp, const std::vector<Detection>& detections) {
  nlohmann::json entry = {{"stamp", stamp}, {"detections", nlohmann::json::array()}};
  for (const Detection& d : detections) {
    entry["detections"].push_back({{"class", d.class_name}, {"box", {d.box.x, d.box.y, d.box.width, d.box.height}}, {"score", d.score}});
  }
  return entry.dump();
}

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

RecordSummary record_drive(const RecordConfig& config, const std::shared_ptr<const Scene>& scene, const std::string& format,
                           const fs::path& folder, const std::string& source,
                           const std::function<void(double, const RecordSummary&)>& progress) {
  expect_replaceable(folder);
  SimulatedStream stream(config.scenario, scene, config.simulation);
  const StreamInfo& info = stream.info();
  calibration_of(info);  // throws before anything is written
  std::unique_ptr<SurfaceCoverage> coverage;
  if (!info.cameras.empty() && !scene->objects.empty()) {
    coverage = std::make_unique<SurfaceCoverage>(stream.ray_caster(), config.scenario.sensors.cameras, config.scenario.robot);
  }

  StagedFolder staged(folder);
  RecordConfig resolved = config;
  write_file(staged.path() / "config.yaml", resolved_config([&](Fields& f) { resolved.visit(f); }, source));
  const auto writer = make_recording_writer(format, staged.path(), info, "waretwin " + std::string(kVersion) + ", " + source, config.bag);
  const bool with_poses = format == "scenenn" || format == "7scenes";
  GrowingFile truth(staged.path() / "trajectory_truth.tum");
  GrowingFile boxes(staged.path() / "truth_boxes.json");
  TruthDetector detector(stream, config.truth_detector);
  RecordSummary summary;
  std::optional<Stamp> first, last;
  while (auto event = stream.next()) {
    const Stamp stamp = stamp_of(*event);
    if (!first) first = stamp;
    if (last != stamp) truth.append(tum_text({{stamp, stream.true_X_WB(stamp)}}));
    last = stamp;
    if (auto* frame = std::get_if<RgbdFrame>(&*event)) {
      load_pictures(*frame);
      if (with_poses) frame->recorded_X_WC = stream.last_frame_truth().X_WC;
      writer->add(*frame);
      boxes.append((summary.frames == 0 ? "{\"frames\":[\n" : ",\n") + boxes_entry(stamp, detector.detect(*frame)));
      if (coverage) coverage->add_frame(frame->sensor, stream.last_frame_truth().X_WC);
      ++summary.frames;
    } else if (const auto* scan = std::get_if<LaserScan>(&*event)) {
      writer->add(*scan);
      ++summary.scans;
    } else {
      writer->add(std::get<OdometryReading>(*event));
      ++summary.readings;
    }
    summary.duration_s = to_seconds(*last - *first);
    if (!progress) continue;
    double done = info.duration_s && *info.duration_s > 0.0 ? summary.duration_s / *info.duration_s : 0.0;
    if (info.frame_count && *info.frame_count > 0) done = std::max(done, static_cast<double>(summary.frames) / *info.frame_count);
    progress(std::min(done, 1.0), summary);
  }
  writer->finish();
  truth.close();
  boxes.append(summary.frames == 0 ? "{\"frames\":[]}\n" : "\n]}\n");
  boxes.close();
  const std::vector<ListedObject> objects = true_list(*scene, coverage.get());
  write_file(staged.path() / "truth.json", truth_json(objects));
  if (format == "scenenn") write_file(staged.path() / annotation_name(folder), scenenn_annotation(objects));
  expect_replaceable(folder);
  staged.commit();
  return summary;
}

}  // namespace waretwin

#include "harness/run/closed_loop.h"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>

#include "core/digest.h"
#include "core/error.h"
#include "harness/calibrate/extrinsics.h"
#include "harness/run/truth_stages.h"
#include "harness/truth/sensor_poses.h"
#include "harness/truth/true_list.h"
#include "harness/truth/truth_frames.h"
#include "mapper/integrate/tsdf_volume.h"
#include "mapper/own_body_mask.h"
#include "sensors/depth_field.h"
#include "sim/ray_caster.h"
#include "sim/visibility.h"

namespace waretwin {

namespace {

void score_trajectories(const ClosedLoopResult& result, RunScore& score) {
  std::vector<std::pair<Pose, Pose>> pairs;
  for (std::size_t i = 0; i < result.trajectory.size(); ++i) {
    pairs.emplace_back(result.trajectory[i].X_WB, result.true_trajectory[i].X_WB);
  }
  if (pairs.empty()) return;
  score.trajectory = score_trajectory(pairs, TrajectoryAlignment::kNone);
  score.trajectory_aligned = score_trajectory(pairs, TrajectoryAlignment::kSe3);
}

std::optional<double> unlocalised_share(const std::vector<TrajectoryPoint>& trajectory, const std::vector<StampedPose>& truth) {
  // Beyond what a standing vehicle rocks.
  constexpr double kMoved_m = 2e-4, kTurned_rad = 2e-4;
  int moving = 0, lost = 0;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    const Pose X = truth[i - 1].X_WB.inverse() * truth[i].X_WB;
    if (X.translation().norm() < kMoved_m && std::abs(Eigen::AngleAxisd(X.linear()).angle()) < kTurned_rad) continue;
    ++moving;
    lost += trajectory[i].localised ? 0 : 1;
  }
  return moving > 0 ? std::optional(static_cast<double>(lost) / moving) : std::nullopt;
}

}  // namespace

ClosedLoopResult run_closed_loop(const RunConfig& config, const std::shared_ptr<const Scene>& scene, const std::function<void()>& ready,
                                 const std::function<void(double, const ObjectMap&)>& progress) {
  if (!config.external_mapper.command.empty()) throw Error("external_mapper.command: this drives our own mapper alone; expected none here");
  SimulationConfig simulation = config.simulation;
  simulation.ideal_depth = config.extras.depth || config.extras.pictures;
  SimulatedStream stream(config.scenario, scene, simulation);
  ToldStream told(stream, told_by_extrinsics(stream.info(), config.extrinsics));
  const std::map<std::string, CameraConfig>& cameras = config.scenario.sensors.cameras;
  std::unique_ptr<SurfaceCoverage> coverage;
  if (config.extras.visible_share && !cameras.empty() && !scene->objects.empty()) {
    coverage = std::make_unique<SurfaceCoverage>(stream.ray_caster(), cameras, config.scenario.robot);
  }

  std::map<std::string, cv::Mat> fields;
  for (const auto& [name, camera] : cameras) fields[name] = depth_field_mask(camera);
  DepthQualityMeter depth_quality;
  SurfaceMeter surface(stream.ray_caster());
  SensorPoses sensor_poses(stream, config.scenario.sensors);
  std::vector<ObjectView> views;  // of the frame that was mapped last
  // What the mapper leaves out of the measured depth is no missing measurement.
  const OwnBodyMask own_body(told.info());
  const auto without_vehicle = [&own_body](const FrameTruth& truth) {
    RgbdFrame frame;
    frame.sensor = truth.sensor;
    frame.depth = truth.ideal_depth;
    own_body.mask(frame);
    return frame.depth;
  };
  const bool detects = config.truth_stages.detector || config.mapper.detector != "none";
  DetectionLog detections(*scene, config.detection_score);
  ClosedLoopResult result;
  MappingHooks hooks;
  hooks.progress = progress;
  hooks.on_frame = [&](const Mapper::FrameResult& frame) {
    const FrameTruth& truth = stream.last_frame_truth();
    if (coverage) coverage->add_frame(frame.frame.sensor, truth.X_WC);
    const CameraConfig& camera = cameras.at(frame.frame.sensor);
    if (config.extras.surface) surface.add_frame(camera, truth.X_WC);
    if (config.extras.depth)
      depth_quality.add(frame.frame.depth, without_vehicle(truth), truth.instances, fields.at(frame.frame.sensor), camera.depth_min_m,
                        camera.depth_max_m);
    if (!config.truth_frames.enabled && !detects) return;
    WARETWIN_CHECK(truth.stamp == frame.frame.stamp && truth.sensor == frame.frame.sensor, "the mapped frame is the stream's newest");
    views = stream.object_views();
    if (detects) detections.add(frame.frame, frame.detections, views);
    if (!config.truth_frames.enabled) return;
    result.truth_frames += truth_frame_line(truth, views, *scene, config.truth_frames.masks);
  };
  hooks.pictures = config.extras.pictures;
  hooks.on_event = [&](const SensorEvent& event) { sensor_poses.add(event); };
  hooks.true_depth = [&](const RgbdFrame&) { return stream.last_frame_truth().ideal_depth; };
  if (config.truth_frames.enabled) {
    hooks.truth_picture = [&](const RgbdFrame& frame) { return draw_truth(frame.colour, stream.last_frame_truth(), views, *scene); };
  }
  Stages stages = stages_with_truth(config, stream, told.info());
  // Before the folder is made: the map may be the one that is there.
  std::optional<LoadedMap> resumed = load_resumed(config.resume, config.mapper.integrate);
  if (ready) ready();
  result.mapping = map_stream(told, config.mapper, std::move(stages), config.simulation.max_frames, hooks, std::move(resumed));

  const ObjectMap& map = result.mapping.map;
  result.mapped = listed(map.objects);
  result.truth = true_list(*scene, coverage.get());
  if (!config.extras.visible_share) {
    for (ListedObject& object : result.truth) object.visible_fraction = 1.0;
  }
  result.trajectory = stamped(map.trajectory);
  result.sensor_poses = sensor_poses.poses();
  for (const StampedPose& point : result.trajectory) result.true_trajectory.push_back({point.stamp, stream.true_X_WB(point.stamp)});

  RunScore& score = result.score;
  score.scenario = config.scenario.name;
  score.profile = config.mapper.profile;
  score.seed = config.scenario.seed;
  score.digest = digest_of(map);
  score.stages = stage_names(config, told.info());
  result.detections = detections.lines();
  score.detection = detections.score();
  score.objects = compare_lists(result.mapped, result.truth, config.score);
  score_trajectories(result, score);
  score.unlocalised_share = unlocalised_share(map.trajectory, result.true_trajectory);
  if (config.extras.depth && !map.frames.empty()) score.depth = depth_quality.result();
  if (config.extras.surface && !map.frames.empty()) score.surface = surface.result(extract_mesh(*map.volume));
  score.motion = stream.motion();
  score.timing_ms = summarise_stages(result.mapping.frames);
  score.frames_simulated = map.frames_seen;
  score.frames_mapped = static_cast<int>(map.frames.size());
  score.frames_dropped = map.frames_dropped_by_rate;
  score.frames_without_pose = map.frames_without_pose;
  score.rejected = map.rejected;
  score.realtime_factor = result.mapping.wall_s > 0.0 ? result.mapping.stream_s / result.mapping.wall_s : 0.0;
  score.peak_rss_mb = peak_rss_mb();
  return result;
}

void add_to(Digest& digest, const std::vector<ListedObject>& objects, const std::vector<StampedPose>& trajectory) {
  for (const ListedObject& object : objects) {
    digest.add(object.id);
    digest.add(object.class_name);
    for (const Eigen::Vector3d& v : {object.cuboid.centre, object.cuboid.size}) digest.add_bytes(v.data(), 3 * sizeof(double));
    digest.add(object.cuboid.yaw);
  }
  for (const StampedPose& point : trajectory) {
    digest.add(point.stamp);
    const Eigen::Matrix4d X = point.X_WB.matrix();
    digest.add_bytes(X.data(), 16 * sizeof(double));
  }
}

std::string digest_of(const ObjectMap& map) {
  Digest digest;
  add_to(digest, listed(map.objects), stamped(map.trajectory));
  if (map.volume) map.volume->add_to(digest);
  return digest.hex();
}

std::vector<ListedObject> listed(const ObjectList& objects) {
  std::vector<ListedObject> list;
  for (const MappedObject& object : objects) {
    ListedObject entry;
    entry.id = object.id;
    entry.class_name = object.class_name;
    entry.cuboid = canonical(object.cuboid);
    entry.score = static_cast<double>(object.score);
    list.push_back(entry);
  }
  std::sort(list.begin(), list.end(), [](const ListedObject& a, const ListedObject& b) { return a.id < b.id; });
  return list;
}

std::vector<StampedPose> stamped(const std::vector<TrajectoryPoint>& trajectory) {
  std::vector<StampedPose> poses;
  for (const TrajectoryPoint& point : trajectory) poses.push_back({point.stamp, point.X_WB});
  return poses;
}

std::map<std::string, TimingSummary> summarise_stages(const std::vector<FrameRow>& frames) {
  std::map<std::string, std::vector<double>> values;
  for (const char* stage : {"simulate", "localise", "detect", "segment", "associate", "integrate", "frame"}) values[stage];
  for (const FrameRow& row : frames) {
    values["simulate"].push_back(row.source_ms);
    values["localise"].push_back(row.report.localise_ms);
    values["detect"].push_back(row.report.detect_ms);
    values["segment"].push_back(row.report.segment_ms);
    values["associate"].push_back(row.report.associate_ms);
    values["integrate"].push_back(row.report.integrate_ms);
    values["frame"].push_back(row.report.frame_ms());
  }
  std::map<std::string, TimingSummary> summaries;
  for (const auto& [stage, list] : values) summaries[stage] = summarise_timing(list);
  return summaries;
}

double peak_rss_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;  // Linux counts in kB
}

}  // namespace waretwin

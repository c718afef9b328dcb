#include "mapper/mapper.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "mapper/integrate/tsdf_volume.h"

namespace waretwin {

namespace {

class Stopwatch {
 public:
  // Milliseconds since the last call.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double ms = std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
    return ms;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

// Turns a recording's own world R into the map's W, whose z points up: the smallest rotation that does it.
Pose world_from_recording(const StreamInfo& info) {
  Pose X_WR = Pose::Identity();
  X_WR.linear() = Eigen::Quaterniond::FromTwoVectors(info.up_W, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return X_WR;
}

// Labels the pixels of each object with its map id. Where boxes overlap, the earlier object keeps the pixel.
// `margin` (metres; negative: any): a pixel farther outside the mapped object's cuboid shows something else in the box.
std::vector<std::int32_t> label_pixels(const Segmentation& segmentation, const std::vector<int>& map_ids, const ObjectList& map,
                                       double margin, std::size_t pixel_count) {
  std::vector<std::int32_t> labels;
  for (std::size_t i = 0; i < segmentation.objects.size(); ++i) {
    if (map_ids[i] == 0) continue;
    if (labels.empty()) labels.assign(pixel_count, 0);
    const SegmentedObject& object = segmentation.objects[i];
    const auto mapped = std::find_if(map.begin(), map.end(), [&](const MappedObject& m) { return m.id == map_ids[i]; });
    const bool bounded = margin >= 0.0 && mapped != map.end();
    Eigen::Matrix3f R_OW = Eigen::Matrix3f::Identity();
    Eigen::Vector3f centre = Eigen::Vector3f::Zero(), half = Eigen::Vector3f::Zero();
    if (bounded) {
      R_OW = mapped->cuboid.pose().linear().transpose().cast<float>();
      centre = mapped->cuboid.centre.cast<float>();
      half = (0.5 * mapped->cuboid.size + Eigen::Vector3d::Constant(margin)).cast<float>();
    }
    for (std::size_t k = 0; k < object.pixels.size(); ++k) {
      if (bounded && ((R_OW * (object.points_W[k] - centre)).array().abs() > half.array()).any()) continue;
      std::int32_t& label = labels[static_cast<std::size_t>(object.pixels[k])];
      if (label == 0) label = map_ids[i];
    }
  }
  return labels;
}

}  // namespace

Mapper::Mapper(const MapperConfig& config, Stages stages, const StreamInfo& info)
    : config_(config), stages_(std::move(stages)), info_(info), own_body_(info), schedule_(config.rate_hz) {
  X_WR_ = world_from_recording(info);
  map_.X_RW = X_WR_.inverse();
  map_.volume = std::make_unique<TsdfVolume>(config.integrate);
}

Mapper::~Mapper() = default;

void Mapper::resume(LoadedMap map) {
  map.volume->configure(config_.integrate);
  map_.objects = std::move(map.objects);
  map_.volume = std::move(map.volume);
  map_.frames_before = map.frames;
}

void Mapper::consume(SensorEvent event) {
  const Stamp stamp = stamp_of(event);
  if (last_stamp_ && stamp < *last_stamp_) {
    throw Error(info_.source + ": an event at " + std::to_string(stamp) + " ns comes after one at " + std::to_string(*last_stamp_) +
                " ns; expected events in order of time");
  }
  last_stamp_ = stamp;
  std::visit([this](auto& measurement) { take(std::move(measurement)); }, event);
}

ObjectMap Mapper::finish() {
  if (map_.volume) {
    stages_.associator->finish(map_.objects, *map_.volume);
    map_.volume->merge_labels(stages_.associator->take_merges());
  }
  return std::exchange(map_, ObjectMap{});
}

void Mapper::take(const OdometryReading& reading) {
  Stopwatch watch;
  stages_.localiser->add(reading);
  pending_localise_ms_ += watch.lap();
}

void Mapper::take(LaserScan scan) {
  Stopwatch watch;
  own_body_.mask(scan);
  stages_.localiser->add(scan);
  // One laser localises, the first by name: a scan of another one brings no pose.
  if (!info_.lasers.empty() && scan.sensor != info_.lasers.begin()->first) return;
  if (const auto X_WB = stages_.localiser->current_pose())
    map_.trajectory.push_back({scan.stamp, *X_WB, stages_.localiser->covariance(), stages_.localiser->localised()});
  pending_localise_ms_ += watch.lap();
}

void Mapper::take(RgbdFrame frame) {
  ++map_.frames_seen;
  if (!schedule_.due(frame.sensor, frame.stamp)) {
    ++map_.frames_dropped_by_rate;
    return;
  }
  const auto camera = info_.cameras.find(frame.sensor);
  if (camera == info_.cameras.end())
    throw Error(info_.source + ": a frame of camera '" + frame.sensor + "', which the stream does not name");
  if (frame.recorded_X_WC) frame.recorded_X_WC = X_WR_ * *frame.recorded_X_WC;

  FrameReport report;
  report.stamp = frame.stamp;
  report.frame_id = map_.frames_before + static_cast<int>(map_.frames.size());
  Stopwatch watch;
  const std::optional<Pose> X_WB = stages_.localiser->pose_at(frame);
  // Localising goes on between frames: a frame answers for all scans since the one before.
  report.localise_ms = std::exchange(pending_localise_ms_, 0.0) + watch.lap();
  if (!X_WB) {
    ++map_.frames_without_pose;
    return;
  }
  if (info_.lasers.empty()) map_.trajectory.push_back({frame.stamp, *X_WB, std::nullopt, stages_.localiser->localised()});
  load_pictures(frame);
  own_body_.mask(frame);
  map_frame(frame, *X_WB * camera->second.X_BC, report);
}

void Mapper::map_frame(const RgbdFrame& frame, const Pose& X_WC, FrameReport report) {
  const Intrinsics& intrinsics = info_.cameras.at(frame.sensor).intrinsics;
  Stopwatch watch;

  const std::vector<Detection> detections = stages_.detector->detect(frame);
  report.detect_ms = watch.lap();

  const Segmentation segmentation = stages_.segmenter->segment(frame, intrinsics, detections, X_WC);
  report.segment_ms = watch.lap();

  const AssociationContext context = {.frame_id = report.frame_id,
                                      .stamp = frame.stamp,
                                      .X_WC = X_WC,
                                      .intrinsics = intrinsics,
                                      .depth = frame.depth,
                                      .detections = detections,
                                      .tells_nothing = segmentation.tells_nothing,
                                      .volume = map_.volume.get()};
  std::vector<int> map_ids = stages_.associator->associate(segmentation.objects, context, map_.objects);
  map_.volume->merge_labels(stages_.associator->take_merges());
  report.associate_ms = watch.lap();

  stages_.integrator->integrate(frame, intrinsics,
                                label_pixels(segmentation, map_ids, map_.objects, config_.label_margin_m, frame.depth.total()), X_WC,
                                *map_.volume);
  report.integrate_ms = watch.lap();

  report.detections = static_cast<int>(detections.size());
  report.segmented = static_cast<int>(segmentation.objects.size());
  for (const auto& [reason, count] : segmentation.rejected) map_.rejected[reason] += count;
  map_.frames.push_back(report);
  for (int& id : map_ids) id = stages_.associator->object_of(id);
  if (on_frame) on_frame({frame, X_WC, detections, segmentation, map_ids});
}

}  // namespace waretwin

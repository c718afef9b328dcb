// The mapper: a sensor stream in, an object map out. Mapper::map_frame is the paper's Fig. 1 on one screen.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mapper/frame_schedule.h"
#include "mapper/mapper_config.h"
#include "mapper/object_list.h"
#include "mapper/output/map_archive.h"
#include "mapper/own_body_mask.h"
#include "mapper/stages.h"
#include "sensors/sensor_stream.h"

namespace waretwin {

struct TrajectoryPoint {
  Stamp stamp = 0;
  Pose X_WB = Pose::Identity();
  std::optional<Eigen::Matrix3d> covariance = std::nullopt;  // Localiser::covariance
  bool localised = true;                                     // Localiser::localised
};

// What one mapped frame took and found.
struct FrameReport {
  Stamp stamp = 0;
  int frame_id = 0;
  double localise_ms = 0, detect_ms = 0, segment_ms = 0, associate_ms = 0, integrate_ms = 0;
  int detections = 0, segmented = 0;
  double frame_ms() const { return localise_ms + detect_ms + segment_ms + associate_ms + integrate_ms; }
};

// The map's world W is z up. A recording whose own world R is not (7-Scenes) is turned on the way in; X_RW turns results back.
struct ObjectMap {
  Pose X_RW = Pose::Identity();  // a pure rotation; identity where the recording's world is z up
  ObjectList objects;
  std::unique_ptr<TsdfVolume> volume;
  std::vector<TrajectoryPoint> trajectory;  // one point a scan
  std::vector<FrameReport> frames;
  int frames_before = 0;           // mapped frames of the map that this one went on from
  int frames_seen = 0;             // camera frames in the stream
  int frames_dropped_by_rate = 0;  // left out to keep the mapping rate
  int frames_without_pose = 0;
  std::map<std::string, int> rejected;  // reasons why detections came to nothing
};

class Mapper {
 public:
  Mapper(const MapperConfig& config, Stages stages, const StreamInfo& info);
  ~Mapper();

  // Goes on from a saved map: its objects with their ids, its volume; frames count on from its last. The poses must be in its world.
  // Before the first event. Throws Error where its voxels or truncation are not the configuration's.
  void resume(LoadedMap map);

  // Takes the next event. Throws Error where stamps go back or a frame's camera is not in the stream's info. Frames beyond the mapping rate
  // are dropped and counted.
  void consume(SensorEvent event);
  const ObjectMap& map() const { return map_; }
  // Hands over the map; the mapper is then empty.
  ObjectMap finish();

  // Called after each mapped frame with its detections and what became of them (debug pictures, per-frame records).
  struct FrameResult {
    const RgbdFrame& frame;
    const Pose& X_WC;
    const std::vector<Detection>& detections;
    const Segmentation& segmentation;
    const std::vector<int>& map_ids;
  };
  std::function<void(const FrameResult&)> on_frame;

 private:
  void take(const OdometryReading& reading);
  void take(LaserScan scan);
  void take(RgbdFrame frame);
  void map_frame(const RgbdFrame& frame, const Pose& X_WC, FrameReport report);

  MapperConfig config_;
  Stages stages_;
  StreamInfo info_;
  OwnBodyMask own_body_;
  ObjectMap map_;
  double pending_localise_ms_ = 0.0;
  Pose X_WR_ = Pose::Identity();
  std::optional<Stamp> last_stamp_;
  FrameSchedule schedule_;
};

}  // namespace waretwin

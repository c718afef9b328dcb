// One drive through a stream: every event goes to the mapper, and what a report needs is kept on the way.
#pragma once

#include <functional>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "harness/report/frame_log.h"
#include "mapper/mapper.h"
#include "sensors/sensor_stream.h"

namespace waretwin {

// A mapped frame: the mapper's report and how long its pictures took to be made or read.
struct FrameRow {
  FrameReport report;
  double source_ms = 0.0;
};

struct FramePicture {
  std::string name;  // "frame-0012.colour"
  cv::Mat image;     // BGR
};

struct MappingResult {
  ObjectMap map;
  std::vector<FrameRow> frames;
  std::vector<FramePicture> pictures;    // of a few frames spread over the drive
  std::vector<LoggedFrame> kept_frames;  // more of them, small, for the report and the video
  std::optional<Pose> X_BL;              // of a stream with a laser and no camera: the laser on the vehicle, see write_mapping
  double stream_s = 0.0;                 // between the first and the last event
  double wall_s = 0.0;
};

struct MappingHooks {
  // After each event: share of the drive that is done in [0, 1] (0 where its length is unknown), and the map so far.
  std::function<void(double, const ObjectMap&)> progress;
  // Each event before the mapper gets it; pictures are not loaded yet.
  std::function<void(const SensorEvent&)> on_event;
  // After a frame is mapped, before the pictures below are asked for.
  std::function<void(const Mapper::FrameResult&)> on_frame;
  // True depth of the frame that was mapped last, as FrameTruth::ideal_depth; makes pictures of the depth's error. May be empty.
  std::function<cv::Mat(const RgbdFrame&)> true_depth;
  // Picture of the truth about the frame that was mapped last (BGR). May be empty.
  std::function<cv::Mat(const RgbdFrame&)> truth_picture;
  bool pictures = true;  // false: none are kept
};

// The map.waretwin to go on from, where one is named. Throws Error naming the file where it is none or its voxels are not the
// configuration's.
std::optional<LoadedMap> load_resumed(const std::string& file, const TsdfConfig& config);

// Maps the stream to its end, or up to `max_frames` camera frames (0 = all), into a new map or on from `resumed`.
MappingResult map_stream(SensorStream& stream, const MapperConfig& config, Stages stages, int max_frames, const MappingHooks& hooks,
                         std::optional<LoadedMap> resumed = std::nullopt);

}  // namespace waretwin

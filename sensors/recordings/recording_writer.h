// A sensor stream as a recording that open_recording reads back to the same bits.
#pragma once

#include <filesystem>
#include <optional>

#include "core/files.h"
#include "sensors/recordings/recording.h"

namespace waretwin {

// What recording.yaml says of a stream. Throws Error where the layout cannot hold it: it has room for one camera and one laser, and is no
// recording without either.
RecordingCalibration calibration_of(const StreamInfo& info);

// The TUM RGB-D layout: rgb.txt and rgb/, depth.txt and depth/ in millimetres, depth_native.txt and depth_native/ where the camera has
// a view of its own, laser.txt, odometry.txt, recording.yaml. No groundtruth.txt: a mapper that reads the folder learns no true pose.
// Everything goes to disk at once, so that a long drive takes no more memory than a short one.
class RecordingWriter {
 public:
  // Into an empty folder; `source` is the comment at the top of recording.yaml. Throws Error as calibration_of does and where the folder
  // cannot be written.
  RecordingWriter(const std::filesystem::path& folder, const StreamInfo& info, const std::string& source);

  // Events of the stream in its order; a frame's pictures are loaded. Throws Error where the disk is full.
  void add(const OdometryReading& reading);
  void add(const LaserScan& scan);
  void add(const RgbdFrame& frame);
  // Closes the files; nothing may be added after it. Throws Error where not everything reached the disk.
  void finish();

 private:
  std::filesystem::path folder_;
  int frames_ = 0;
  std::optional<GrowingFile> colour_, depth_, native_, laser_, odometry_;
};

}  // namespace waretwin

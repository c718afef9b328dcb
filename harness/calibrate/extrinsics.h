// A calibration as a file that `run` and `map` take with --extrinsics. It holds what was estimated, never the truth.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/fields.h"
#include "harness/calibrate/calibration.h"
#include "sensors/mount.h"
#include "sensors/sensor_stream.h"

namespace waretwin {

// YAML. Poses are the upper three rows of their 4 x 4 matrix, row by row, as in recording.yaml. Only camera, laser, X_BC and X_BL need be
// there: a calibration that was made by other means is quickly written down.
struct Extrinsics {
  std::string camera, laser;
  std::vector<double> X_BC, X_BL;
  Mount mount;  // X_BC once more, in a scenario's words; not read
  // In the vehicle's axes: shift x, y, z in metres, turn about x, y, z in degrees; and the whole covariance, metres and radians, row by
  // row.
  std::vector<double> sigma_m, sigma_deg, covariance;
  double range_bias_m = 0.0, range_bias_sigma_m = 0.0;  // ranges read so much too long
  int poses = 0, points = 0;
  double beam_rms_m = 0.0, corner_sigma_px = 0.0;
  void visit(Fields& f);
};

Extrinsics extrinsics_of(const Calibration& calibration);
std::string extrinsics_yaml(const Extrinsics& extrinsics, const std::string& source);
// Throws Error naming the file for what is none.
Extrinsics read_extrinsics(const std::filesystem::path& file);

// The mount that has this pose; roll, pitch and yaw as in Mount.
Mount mount_of(const Pose& X_BC);

// What a mapper is told that goes by `file`: X_BC = (the stream's X_BL) * X_LC, so that the laser stays where the stream has it; without
// that laser in the stream, X_BC itself. An empty name changes nothing. Throws Error where the file is none or its camera is not in the
// stream.
StreamInfo told_by_extrinsics(StreamInfo info, const std::filesystem::path& file);

// A stream that says other things of itself than it would. The stream must outlive it.
class ToldStream : public SensorStream {
 public:
  ToldStream(SensorStream& stream, StreamInfo told) : stream_(stream), told_(std::move(told)) {}
  const StreamInfo& info() const override { return told_; }
  std::optional<SensorEvent> next() override { return stream_.next(); }

 private:
  SensorStream& stream_;
  StreamInfo told_;
};

}  // namespace waretwin

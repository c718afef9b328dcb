#include "sensors/recordings/recording_writer.h"

#include <cstdio>
#include <string>

#include "core/config.h"
#include "core/error.h"
#include "core/parallel.h"
#include "sensors/recordings/recorded_image.h"
#include "sensors/recordings/text_formats.h"

namespace waretwin {

namespace fs = std::filesystem;

namespace {

template <class T>
void expect_one(const std::map<std::string, T>& sensors, const std::string& kind) {
  if (sensors.size() <= 1) return;
  std::string names;
  for (const auto& entry : sensors) names += (names.empty() ? "" : ", ") + entry.first;
  throw Error("the layout tum holds one " + kind + ", the stream has " + std::to_string(sensors.size()) + " (sensors." + kind +
              "s: " + names + "); expected one");
}

}  // namespace

RecordingCalibration calibration_of(const StreamInfo& info) {
  expect_one(info.cameras, "camera");
  expect_one(info.lasers, "laser");
  if (info.cameras.empty() && info.lasers.empty()) {
    throw Error(info.source + ": has neither camera nor laser (sensors.cameras, sensors.lasers); expected one of them");
  }
  RecordingCalibration calibration;
  for (const auto& [name, camera] : info.cameras) {
    const Intrinsics& k = camera.intrinsics;
    calibration.has_camera = true;
    RecordingCalibration::Camera& c = calibration.camera;
    c.name = name;
    c.width = k.width, c.height = k.height;
    c.fx = k.fx, c.fy = k.fy, c.cx = k.cx, c.cy = k.cy;
    c.depth_min_m = camera.depth_min_m, c.depth_max_m = camera.depth_max_m;
    c.depth_scale = 1000.0;
    c.rate_hz = camera.rate_hz;
    c.X_BC = pose_numbers(camera.X_BC);
    if (!camera.native) continue;
    const Intrinsics& own = camera.native->lens.intrinsics();
    c.has_native = true;
    c.native.width = own.width, c.native.height = own.height;
    c.native.fx = own.fx, c.native.fy = own.fy, c.native.cx = own.cx, c.native.cy = own.cy;
    c.native.distortion = camera.native->lens.distortion();
    c.native.X_CD = pose_numbers(camera.native->X_CD);
  }
  for (const auto& [name, laser] : info.lasers) {
    calibration.has_laser = true;
    calibration.laser = {name, laser.rate_hz, pose_numbers(laser.X_BL)};
  }
  calibration.X_WB_start = pose_numbers(info.X_WB_start);
  if (info.own_body_B) {
    const Eigen::Vector3d &low = info.own_body_B->min(), &high = info.own_body_B->max();
    calibration.own_body = {low.x(), low.y(), low.z(), high.x(), high.y(), high.z()};
  }
  calibration.up = {info.up_W.x(), info.up_W.y(), info.up_W.z()};
  return calibration;
}

RecordingWriter::RecordingWriter(const fs::path& folder, const StreamInfo& info, const std::string& source) : folder_(folder) {
  RecordingCalibration calibration = calibration_of(info);
  const auto list = [&](std::optional<GrowingFile>& file, const std::string& name) {
    make_folder(folder_ / name);
    file.emplace(folder_ / (name + ".txt"));
    file->append("# seconds file\n");
  };
  if (calibration.has_camera) {
    list(colour_, "rgb");
    list(depth_, "depth");
    if (calibration.camera.has_native) list(native_, "depth_native");
  }
  if (calibration.has_laser) {
    laser_.emplace(folder_ / "laser.txt");
    laser_->append("# seconds angle_min angle_increment beam_interval_s range_min range_max count ranges; radians, metres, 0 = none\n");
  }
  if (info.has_odometry) {
    odometry_.emplace(folder_ / "odometry.txt");
    odometry_->append("# seconds x y yaw; metres, radians\n");
  }
  write_file(folder_ / "recording.yaml", "# " + source + "\n" + write_config([&](Fields& f) { calibration.visit(f); }));
}

void RecordingWriter::add(const OdometryReading& reading) {
  WARETWIN_CHECK(odometry_, "the stream said that it has odometry");
  odometry_->append(odometry_line(reading));
}

void RecordingWriter::add(const LaserScan& scan) {
  WARETWIN_CHECK(laser_, "the stream said that it has a laser");
  laser_->append(laser_line(scan));
}

void RecordingWriter::add(const RgbdFrame& frame) {
  WARETWIN_CHECK(colour_ && depth_, "the stream said that it has a camera");
  WARETWIN_CHECK(!frame.colour.empty() && !frame.depth.empty(), "the frame's pictures are loaded");
  char name[32];
  std::snprintf(name, sizeof name, "/%06d.png", frames_++);
  // Packing the pictures takes longer than writing them.
  parallel_for(3, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (i == 0) write_colour_image(folder_ / ("rgb" + std::string(name)), frame.colour);
      if (i == 1) write_depth_image(folder_ / ("depth" + std::string(name)), frame.depth);
      if (i == 2 && native_ && !frame.native_depth.empty()) {
        write_depth_image(folder_ / ("depth_native" + std::string(name)), frame.native_depth);
      }
    }
  });
  const std::string stamp = stamp_text(frame.stamp) + " ";
  colour_->append(stamp + "rgb" + name + "\n");
  depth_->append(stamp + "depth" + name + "\n");
  if (native_ && !frame.native_depth.empty()) native_->append(stamp + "depth_native" + name + "\n");
}

void RecordingWriter::finish() {
  for (auto* file : {&colour_, &depth_, &native_, &laser_, &odometry_}) {
    if (*file) (*file)->close();
  }
}

}  // namespace waretwin

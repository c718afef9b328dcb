// The keys of RecordingConfig.
#include <Eigen/Core>

#include "sensors/recordings/recording.h"

namespace waretwin {

namespace {

bool has_direction(const std::vector<double>& numbers) {
  return numbers.size() == 3 && Eigen::Vector3d(numbers[0], numbers[1], numbers[2]).norm() > 1e-6;
}

void visit_some(Fields& f, const char* key, std::vector<double>& numbers, std::size_t count, const char* doc, const char* expected) {
  f(key, numbers, doc);
  if (!numbers.empty() && numbers.size() != count) {
    f.reject(key, "has " + std::to_string(numbers.size()) + " numbers; expected " + expected + ", or none");
  }
}

}  // namespace

void ClockOffsets::visit(Fields& f) {
  const FieldRule range{.min = -1e6, .max = 1e6};
  f("colour_s", colour_s, "added to the stamps of colour pictures (where a frame has one stamp: to it)", range);
  f("depth_s", depth_s, "added to the stamps of depth images", range);
  f("laser_s", laser_s, "added to the stamps of scans", range);
  f("odometry_s", odometry_s, "added to the stamps of odometry readings", range);
}

void RecordingConfig::visit(Fields& f) {
  f("up", up, "direction that points up in the recording's world; empty = as the layout says");
  if (!up.empty() && !has_direction(up)) f.reject("up", "is not a direction; expected three numbers that are not all 0, or none");
  visit_some(f, "start", start, 3, "where the vehicle stands at the first event: x_m, y_m, yaw_deg; empty = the recording's",
             "x_m, y_m, yaw_deg");
  const char* mount = "x_m, y_m, z_m, yaw_deg, pitch_deg, roll_deg";
  visit_some(f, "camera_mount", camera_mount, 6,
             "the camera (of upright pictures) on the vehicle, as in sensors.cameras.*.mount: x_m, y_m, z_m, yaw_deg, pitch_deg, roll_deg; "
             "empty = the recording's",
             mount);
  visit_some(f, "laser_mount", laser_mount, 6, "the laser on the vehicle, likewise; empty = the recording's", mount);
  visit_some(f, "intrinsics", intrinsics, 4, "fx, fy, cx, cy in pixels; empty = the recording's own", "fx, fy, cx, cy");
  f("rotate_deg", rotate_deg, "clockwise turn that makes the pictures upright: 0, 90, 180, 270", {.min = 0, .max = 270});
  if (rotate_deg % 90 != 0) f.reject("rotate_deg", "is " + std::to_string(rotate_deg) + "; expected 0, 90, 180 or 270");
  f("depth_min_m", depth_min_m, "nearer depth is not trusted; 0 = the recording's, else 0.4", {.min = 0, .max = 100});
  f("depth_max_m", depth_max_m, "farther depth is not trusted; 0 = the recording's, else 5", {.min = 0, .max = 100});
  if (depth_max_m > 0.0 && depth_max_m <= depth_min_m) f.reject("depth_max_m", "must be greater than depth_min_m");
  f("depth_scale", depth_scale, "units of a 16-bit depth image in one metre; 0 = as the layout says", {.min = 0, .max = 1e6});
  f("depth_invalid", depth_invalid, "units of a 16-bit depth image that mean nothing was measured, beside 0 and 65535");
  f("frame_rate_hz", frame_rate_hz, "frames a second, where frames are numbered", {.min = 0.001, .max = 10000});
  f("association_s", association_s, "most time between a picture and its depth image", {.min = 0, .max = 10});
  f("max_pose_gap_s", max_pose_gap_s, "most time between two recorded poses that are interpolated; frames in longer gaps have no pose",
    {.min = 0, .max = 1e6});
  f.group("clock", clock, "what the sensors' clocks are behind by");
  f.group("bag", bag, "topics and frames of a ROS bag");
}

}  // namespace waretwin

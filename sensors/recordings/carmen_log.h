// CARMEN logs (Carnegie Mellon Navigation toolkit), plain or gzipped: laser scans and wheel odometry as lines of text.
#pragma once

#include <filesystem>

#include "sensors/recordings/contents.h"

namespace waretwin {

// Lines that are read, by their first word; all others are passed over:
//   FLASER n r_1 ... r_n  x y theta  odom_x odom_y odom_theta  ipc_timestamp ipc_hostname logger_timestamp
//   ODOM x y theta tv rv accel  ipc_timestamp ipc_hostname logger_timestamp
//   PARAM robot_front_laser_max M    the laser's largest range; else 80 m. Readings from there on are error codes (81.91): no measurement
//   PARAM robot_frontlaser_offset M  how far in front of the vehicle's centre the laser stands, else 0; it looks forward
// Beams are spread evenly over 180 deg, from right to left: with an even number 180 / n deg apart, with an odd one 180 / (n - 1) deg.
// Stamps are the ipc_timestamp: when the driver sent the reading. The log does not tell when single beams were measured
// (beam_interval = 0).
// The poses in FLASER lines are never used: in published logs both are often corrected by somebody's SLAM. Such programs also write an ODOM
// line without a stamp (ipc_timestamp 0) after each scan, which holds its corrected pose, and let the odometry go on from there. That line
// is no reading: odometry is put together again from the motion between each stamped line and the line before it, in which the corrected
// pose cancels out.
// Throws Error with file and line for a malformed line, for a log without scans or with one stamp for all, and for a damaged .gz.
RecordingContents read_carmen_log(const std::filesystem::path& file);

}  // namespace waretwin

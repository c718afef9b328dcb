// Lines of numbers in recordings, read and written in one place so that what is written reads back to the same bits.
//
//   laser.txt     seconds angle_min angle_increment beam_interval_s range_min range_max count r_0 ... r_count-1   (one scan a line;
//                 radians, metres, seconds; a range of 0 = no measurement)
//   odometry.txt  seconds x y yaw   (metres, radians; the base in the odometry's own frame)
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sensors/measurements.h"

namespace waretwin {

// A line of a text file without its comments; `line` counts from 1.
struct TextLine {
  int line = 0;
  std::vector<std::string> words;
};

// The lines that hold words; "#" begins a comment. Throws Error for a missing file.
std::vector<TextLine> read_text_lines(const std::filesystem::path& file);

// A word as a number; infinities and NaN are read as such (lost poses). Throws Error naming file, line and word.
double parse_text_number(const std::filesystem::path& file, int line, const std::string& word);
// A word as seconds, exact to the nanosecond (a double would lose digits of a time since the epoch). Throws Error beyond +- 4.5e9 s.
Stamp parse_text_stamp(const std::filesystem::path& file, int line, const std::string& word);

std::string stamp_text(Stamp stamp);  // seconds with nine decimals
std::string laser_line(const LaserScan& scan);
std::string odometry_line(const OdometryReading& reading);

// All scans or readings of a file, sorted by stamp. Throws Error for a malformed line, and where several have one stamp and no other.
std::vector<LaserScan> read_laser_file(const std::filesystem::path& file, const std::string& sensor);
std::vector<OdometryReading> read_odometry_file(const std::filesystem::path& file, const std::string& sensor);

}  // namespace waretwin

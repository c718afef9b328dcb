#include "sensors/recordings/carmen_log.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <sstream>
#include <string>

#include "core/error.h"
#include "sensors/recordings/stamped_files.h"
#include "sensors/recordings/text_formats.h"

namespace waretwin {

namespace fs = std::filesystem;

namespace {

constexpr double kRangeMax = 80.0;  // SICK LMS, the laser of most logs
constexpr std::size_t kTail = 9;    // words of a FLASER line after the ranges
constexpr std::size_t kMostBytes = std::size_t{2} << 30;

// The text of a file, unpacked where it is gzipped.
std::string unpacked(const fs::path& file) {
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> in(gzopen(file.c_str(), "rb"), gzclose);
  if (!in) throw Error(file, "cannot be read");
  std::string text;
  std::string piece(std::size_t{1} << 18, '\0');
  while (true) {
    const int count = gzread(in.get(), piece.data(), static_cast<unsigned>(piece.size()));
    int code = Z_OK;
    const char* message = gzerror(in.get(), &code);
    if (count < 0 || (code != Z_OK && code != Z_STREAM_END)) throw Error(file, "is damaged: " + std::string(message));
    if (count == 0) break;
    text.append(piece, 0, static_cast<std::size_t>(count));
    if (text.size() > kMostBytes) throw Error(file, "holds more than 2 GB of text; expected a CARMEN log");
  }
  return text;
}

class Reader {
 public:
  explicit Reader(const fs::path& file) : file_(file) {}

  void take(int line, std::vector<std::string> words) {
    line_ = line;
    words_ = std::move(words);
    if (words_.front() == "FLASER") {
      take_scan();
    } else if (words_.front() == "ODOM") {
      take_odometry();
    } else if (words_.front() == "PARAM") {
      take_parameter();
    }
  }

  RecordingContents finish() {
    if (contents_.scans.empty()) throw Error(file_, "holds no FLASER line; expected a CARMEN log with laser scans");
    expect_times(contents_.scans, file_, "FLASER lines");
    expect_times(contents_.readings, file_, "ODOM lines");
    contents_.has_laser = true;
    contents_.X_BL = make_upright_pose(offset_, 0.0, 0.0, 0.0);
    contents_.laser_rate_hz = median_rate_hz(contents_.scans);
    for (LaserScan& scan : contents_.scans) {
      scan.range_max = range_max_;
      for (float& range : scan.ranges) range = range < range_max_ ? range : 0.0f;
    }
    return std::move(contents_);
  }

 private:
  double number(std::size_t i) const {
    const double value = parse_text_number(file_, line_, words_[i]);
    if (!std::isfinite(value)) throw Error(file_, line_, "'" + words_[i] + "' is not finite; expected a finite number");
    return value;
  }

  // Of an odometry's place. Steps between larger numbers lose their millimetres, and those between the largest are infinite.
  double metres(std::size_t i) const {
    constexpr double kMost = 1e9;
    const double value = number(i);
    if (!(std::abs(value) <= kMost)) throw Error(file_, line_, "'" + words_[i] + "' is no place; expected metres from -1e9 to 1e9");
    return value;
  }

  void take_scan() {
    constexpr double kMostBeams = 100000;
    const double announced = words_.size() > 1 ? number(1) : 0.0;
    if (!(announced >= 1.0 && announced <= kMostBeams) || announced != std::floor(announced)) {
      throw Error(file_, line_,
                  "a FLASER line announces no number of ranges; expected FLASER, a count from 1 to 100000 and that many ranges");
    }
    const auto count = static_cast<std::size_t>(announced);
    if (words_.size() != count + 2 + kTail) {
      throw Error(file_, line_,
                  "a FLASER line of " + std::to_string(count) + " ranges has " + std::to_string(words_.size()) + " words; expected " +
                      std::to_string(count + 2 + kTail) + ": two poses, a stamp, a host and a stamp follow the ranges");
    }
    LaserScan scan;
    scan.stamp = parse_text_stamp(file_, line_, words_[count + 8]);
    scan.sensor = "laser";
    scan.angle_min = -0.5 * std::numbers::pi;
    scan.angle_increment = count == 1 ? 0.0 : std::numbers::pi / static_cast<double>(count % 2 == 0 ? count : count - 1);
    scan.ranges.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      const double range = number(i + 2);
      if (range < 0.0) throw Error(file_, line_, "'" + words_[i + 2] + "' is not a range; expected metres from 0 on");
      scan.ranges.push_back(static_cast<float>(range));
    }
    for (std::size_t i = count + 2; i < count + 8; ++i) number(i);  // unused, but a line that breaks off in them is damaged
    contents_.scans.push_back(std::move(scan));
  }

  void take_odometry() {
    constexpr std::size_t kWords = 10;
    if (words_.size() != kWords) {
      throw Error(file_, line_,
                  "an ODOM line has " + std::to_string(words_.size()) + " words; expected 10: ODOM x y theta tv rv accel stamp host stamp");
    }
    const Pose X_here = make_upright_pose(metres(1), metres(2), 0.0, number(3));
    const Stamp stamp = parse_text_stamp(file_, line_, words_[7]);
    if (stamp != 0) {
      if (last_line_) X_OB_ = X_OB_ * (last_line_->inverse() * X_here);
      contents_.readings.push_back(
          OdometryReading{stamp, "odometry", make_upright_pose(X_OB_.translation().x(), X_OB_.translation().y(), 0.0, yaw_of(X_OB_))});
      contents_.has_odometry = true;
    }
    last_line_ = X_here;
  }

  void take_parameter() {
    if (words_.size() < 3) return;
    if (words_[1] == "robot_front_laser_max") {
      range_max_ = number(2);
      if (!(range_max_ > 0.0)) throw Error(file_, line_, "robot_front_laser_max is '" + words_[2] + "'; expected metres above 0");
    } else if (words_[1] == "robot_frontlaser_offset") {
      offset_ = number(2);
    }
  }

  fs::path file_;
  int line_ = 0;
  std::vector<std::string> words_;
  RecordingContents contents_;
  std::optional<Pose> last_line_;  // of the last ODOM line, stamped or not
  Pose X_OB_ = Pose::Identity();   // put together from the steps
  double range_max_ = kRangeMax;
  double offset_ = 0.0;
};

}  // namespace

RecordingContents read_carmen_log(const fs::path& file) {
  Reader reader(file);
  std::istringstream in(unpacked(file));
  std::string text;
  for (int number = 1; std::getline(in, text); ++number) {
    if (text.empty() || text.front() == '#') continue;
    std::istringstream split(text);
    std::vector<std::string> words;
    for (std::string word; split >> word;) words.push_back(std::move(word));
    if (!words.empty()) reader.take(number, std::move(words));
  }
  return reader.finish();
}

}  // namespace waretwin

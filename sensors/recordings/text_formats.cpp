#include "sensors/recordings/text_formats.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <sstream>

#include "core/error.h"
#include "core/files.h"
#include "sensors/recordings/stamped_files.h"

namespace waretwin {

namespace {

std::string shown(const std::string& word) { return "'" + word.substr(0, 40) + (word.size() > 40 ? "..." : "") + "'"; }

template <class T>
std::string shortest(T value) {
  char text[40];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

double finite_number(const std::filesystem::path& file, int line, const std::string& word) {
  const double value = parse_text_number(file, line, word);
  if (!std::isfinite(value)) throw Error(file, line, shown(word) + " is not finite; expected a finite number");
  return value;
}

}  // namespace

std::vector<TextLine> read_text_lines(const std::filesystem::path& file) {
  std::istringstream in(read_file(file));
  std::vector<TextLine> lines;
  std::string text;
  for (int number = 1; std::getline(in, text); ++number) {
    TextLine line;
    line.line = number;
    std::istringstream words(text.substr(0, text.find('#')));
    for (std::string word; words >> word;) line.words.push_back(word);
    if (!line.words.empty()) lines.push_back(std::move(line));
  }
  return lines;
}

double parse_text_number(const std::filesystem::path& file, int line, const std::string& word) {
  const char* begin = word.data();
  const char* const end = begin + word.size();
  if (begin != end && *begin == '+') ++begin;
  double value = 0.0;
  const auto result = std::from_chars(begin, end, value);
  // Too small for a double is 0, too large infinity; from_chars does not say which of the two it met.
  if (result.ec == std::errc::result_out_of_range && result.ptr == end) return std::strtod(word.c_str(), nullptr);
  if (result.ec != std::errc() || result.ptr != end) throw Error(file, line, shown(word) + " is not a number");
  return value;
}

Stamp parse_text_stamp(const std::filesystem::path& file, int line, const std::string& word) {
  const std::size_t dot = std::min(word.find('.'), word.size());
  std::string fraction = dot < word.size() ? word.substr(dot + 1) : "";
  const bool digits = std::all_of(fraction.begin(), fraction.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
  fraction.resize(9, '0');
  const bool negative = !word.empty() && word.front() == '-';
  std::int64_t seconds = 0;
  std::int64_t nanoseconds = 0;
  const auto whole = std::from_chars(word.data() + (negative ? 1 : 0), word.data() + dot, seconds);
  constexpr std::int64_t kMost = 4'500'000'000;  // the year 2112; the time between any two stamps fits into 64 bits of nanoseconds
  if (!digits || whole.ec != std::errc() || whole.ptr != word.data() + dot || seconds < 0 || seconds > kMost) {
    // Exponents are rare in stamps, but legal.
    const double value = finite_number(file, line, word);
    if (!(std::abs(value) <= static_cast<double>(kMost))) throw Error(file, line, shown(word) + " is no time; expected seconds");
    return from_seconds(value);
  }
  std::from_chars(fraction.data(), fraction.data() + fraction.size(), nanoseconds);
  const Stamp stamp = seconds * kNanosecondsPerSecond + nanoseconds;
  return negative ? -stamp : stamp;
}

std::string stamp_text(Stamp stamp) {
  // Unsigned, so that the smallest stamp has a magnitude too.
  const auto bits = static_cast<unsigned long long>(stamp);
  const unsigned long long magnitude = stamp < 0 ? 0ULL - bits : bits;
  char text[40];
  std::snprintf(text, sizeof text, "%s%llu.%09llu", stamp < 0 ? "-" : "", magnitude / 1'000'000'000ULL, magnitude % 1'000'000'000ULL);
  return text;
}

std::string laser_line(const LaserScan& scan) {
  std::string line = stamp_text(scan.stamp) + " " + shortest(scan.angle_min) + " " + shortest(scan.angle_increment) + " " +
                     stamp_text(scan.beam_interval) + " " + shortest(scan.range_min) + " " + shortest(scan.range_max) + " " +
                     std::to_string(scan.ranges.size());
  for (const float range : scan.ranges) line += " " + shortest(range);
  return line + "\n";
}

std::string odometry_line(const OdometryReading& reading) {
  char text[120];
  std::snprintf(text, sizeof text, " %.9f %.9f %.9f\n", reading.X_OB.translation().x(), reading.X_OB.translation().y(),
                yaw_of(reading.X_OB));
  return stamp_text(reading.stamp) + text;
}

std::vector<LaserScan> read_laser_file(const std::filesystem::path& file, const std::string& sensor) {
  std::vector<LaserScan> scans;
  for (const TextLine& line : read_text_lines(file)) {
    constexpr std::size_t kHead = 7;
    if (line.words.size() < kHead) {
      throw Error(file, line.line, "has " + std::to_string(line.words.size()) + " numbers; expected seven and the ranges of a scan");
    }
    const auto number = [&](std::size_t i) { return finite_number(file, line.line, line.words[i]); };
    LaserScan scan;
    scan.stamp = parse_text_stamp(file, line.line, line.words[0]);
    scan.sensor = sensor;
    scan.angle_min = number(1);
    scan.angle_increment = number(2);
    scan.beam_interval = parse_text_stamp(file, line.line, line.words[3]);
    scan.range_min = number(4);
    scan.range_max = number(5);
    if (number(6) != static_cast<double>(line.words.size() - kHead)) {
      throw Error(
          file, line.line,
          "announces " + shown(line.words[6]) + " ranges and holds " + std::to_string(line.words.size() - kHead) + "; expected as many");
    }
    scan.ranges.reserve(line.words.size() - kHead);
    for (std::size_t i = kHead; i < line.words.size(); ++i) {
      const std::string& word = line.words[i];
      float range = 0.0f;
      const auto result = std::from_chars(word.data(), word.data() + word.size(), range);
      if (result.ec != std::errc() || result.ptr != word.data() + word.size() || !(range >= 0.0f) || !std::isfinite(range)) {
        throw Error(file, line.line, shown(word) + " is not a range; expected metres, 0 where nothing was measured");
      }
      scan.ranges.push_back(range);
    }
    scans.push_back(std::move(scan));
  }
  expect_times(scans, file, "scans");
  sort_by_stamp(scans);
  return scans;
}

std::vector<OdometryReading> read_odometry_file(const std::filesystem::path& file, const std::string& sensor) {
  std::vector<OdometryReading> readings;
  for (const TextLine& line : read_text_lines(file)) {
    if (line.words.size() != 4) {
      throw Error(file, line.line, "has " + std::to_string(line.words.size()) + " numbers; expected 'seconds x y yaw'");
    }
    const auto number = [&](std::size_t i) { return finite_number(file, line.line, line.words[i]); };
    OdometryReading reading;
    reading.stamp = parse_text_stamp(file, line.line, line.words[0]);
    reading.sensor = sensor;
    reading.X_OB = make_upright_pose(number(1), number(2), 0.0, number(3));
    readings.push_back(std::move(reading));
  }
  expect_times(readings, file, "readings");
  sort_by_stamp(readings);
  return readings;
}

}  // namespace waretwin

#include "harness/score/trajectory_file.h"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "core/error.h"
#include "core/files.h"
#include "sensors/recordings/text_formats.h"

namespace waretwin {

namespace {

double parse_number(const std::string& word, const std::filesystem::path& file, int line) {
  double value = 0.0;
  const char* begin = word.data() + (word.starts_with('+') ? 1 : 0);
  const auto [end, status] = std::from_chars(begin, word.data() + word.size(), value);
  if (status != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) {
    throw Error(file, line, "'" + word.substr(0, 40) + "' is not a finite number");
  }
  return value;
}

// Seconds to nanoseconds digit by digit: a double holds seconds since 1970 only to about 200 ns.
Stamp parse_stamp(const std::string& word, const std::filesystem::path& file, int line) {
  const double seconds = parse_number(word, file, line);
  // Differences of stamps, and what is added to them, still fit 64 bits.
  if (std::abs(seconds) > 4.0e9) throw Error(file, line, "stamp " + word.substr(0, 40) + " is beyond 4e9 s");
  if (word.find_first_of("eE") != std::string::npos) return from_seconds(seconds);
  const std::size_t point = word.find('.');
  const std::string whole = word.substr(0, point);
  std::string digits = point == std::string::npos ? "" : word.substr(point + 1, 9);
  digits.resize(9, '0');
  const bool negative = whole.starts_with('-');
  Stamp stamp = std::abs(std::atoll(whole.c_str())) * kNanosecondsPerSecond + std::atoll(digits.c_str());
  return negative ? -stamp : stamp;
}

Pose pose_of_tum(const std::vector<double>& v, const std::filesystem::path& file, int line) {
  Eigen::Quaterniond q(v[7], v[4], v[5], v[6]);
  if (q.norm() < 1e-6) throw Error(file, line, "the quaternion has length 0");
  Pose X = Pose::Identity();
  X.linear() = q.normalized().toRotationMatrix();
  X.translation() = Eigen::Vector3d(v[1], v[2], v[3]);
  return X;
}

Pose pose_of_kitti(const std::vector<double>& v, const std::filesystem::path& file, int line) {
  Pose X = Pose::Identity();
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index column = 0; column < 4; ++column) X.matrix()(row, column) = v[static_cast<std::size_t>(row * 4 + column)];
  }
  if (std::abs(X.linear().determinant() - 1.0) > 0.05) throw Error(file, line, "the matrix is not a rotation");
  return orthonormalised(X);
}

}  // namespace

Trajectory read_trajectory(const std::filesystem::path& file) {
  std::istringstream text(read_file(file));
  Trajectory trajectory;
  std::size_t columns = 0;
  std::string row;
  for (int line = 1; std::getline(text, row); ++line) {
    std::istringstream words(row);
    std::vector<std::string> fields;
    for (std::string word; words >> word;) fields.push_back(word);
    if (fields.empty() || fields.front().starts_with('#')) continue;
    if (columns == 0) columns = fields.size();
    if (fields.size() != columns || (columns != 8 && columns != 12)) {
      throw Error(file, line, "has " + std::to_string(fields.size()) + " numbers; expected 8 (TUM) or 12 (KITTI) in every row");
    }
    std::vector<double> values;
    for (const std::string& field : fields) values.push_back(parse_number(field, file, line));
    if (columns == 8) {
      const Stamp stamp = parse_stamp(fields.front(), file, line);
      if (!trajectory.poses.empty() && stamp < trajectory.poses.back().stamp) throw Error(file, line, "the stamp goes back");
      trajectory.poses.push_back({stamp, pose_of_tum(values, file, line)});
    } else {
      trajectory.has_stamps = false;
      trajectory.poses.push_back({static_cast<Stamp>(trajectory.poses.size()), pose_of_kitti(values, file, line)});
    }
  }
  if (trajectory.poses.empty()) throw Error(file, "holds no poses");
  return trajectory;
}

std::string tum_text(const std::vector<StampedPose>& poses) {
  std::string text;
  for (const StampedPose& point : poses) {
    Eigen::Quaterniond q(point.X_WB.rotation());
    if (q.w() < 0.0) q.coeffs() = -q.coeffs();
    const Eigen::Vector3d p = point.X_WB.translation();
    char line[256];
    std::snprintf(line, sizeof line, " %.9g %.9g %.9g %.9g %.9g %.9g %.9g\n", p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
    text += stamp_text(point.stamp) + line;
  }
  return text;
}

}  // namespace waretwin

#include "sensors/recordings/numbered_frames.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "core/error.h"
#include "sensors/recordings/stamped_files.h"
#include "sensors/recordings/text_formats.h"

namespace waretwin {

namespace fs = std::filesystem;

namespace {

constexpr const char* kStamps = "stamps.txt";

bool all_digits(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

}  // namespace

std::map<std::int64_t, fs::path> numbered_files(const fs::path& folder, const std::string& head, const std::string& tail) {
  constexpr std::size_t kMostDigits = 9;
  std::map<std::int64_t, fs::path> files;
  std::error_code failure;
  for (const auto& entry : fs::directory_iterator(folder, failure)) {
    const std::string name = entry.path().filename().string();
    if (name.size() <= head.size() + tail.size() || !name.starts_with(head) || !name.ends_with(tail)) continue;
    const std::string digits = name.substr(head.size(), name.size() - head.size() - tail.size());
    if (digits.size() <= kMostDigits && all_digits(digits)) files.emplace(std::stoll(digits), entry.path());
  }
  return files;
}

FrameStamps::FrameStamps(const fs::path& folder, double rate_hz) : file_(folder / kStamps), rate_hz_(rate_hz) {
  if (!fs::exists(file_)) return;
  for (const TextLine& line : read_text_lines(file_)) {
    if (line.words.size() != 2 || line.words[0].size() > 9 || !all_digits(line.words[0])) {
      throw Error(file_, line.line, "expected the number of a frame and its seconds");
    }
    stamps_[std::stoll(line.words[0])] = parse_text_stamp(file_, line.line, line.words[1]);
  }
}

Stamp FrameStamps::of(std::int64_t number) const {
  if (!exact()) {
    const double seconds = static_cast<double>(number) / rate_hz_;
    constexpr double kMost = 4.5e9;
    if (!(seconds <= kMost))
      throw Error("frame " + std::to_string(number) + " at " + std::to_string(rate_hz_) +
                  " Hz is no time; expected recording.frame_rate_hz to be greater");
    return static_cast<Stamp>(std::llround(seconds * 1e9));
  }
  const auto found = stamps_.find(number);
  if (found == stamps_.end())
    throw Error(file_, "has no stamp for frame " + std::to_string(number) + "; expected one for each or no such file");
  return found->second;
}

void expect_times_of(const std::vector<RecordedFrame>& frames, const fs::path& file) {
  expect_times(frames, file, "frames", "or no such file (they are then recording.frame_rate_hz a second)");
}

std::optional<Pose> matrix_pose(const std::vector<double>& m, const fs::path& file, int line) {
  WARETWIN_CHECK(m.size() == 16, "a matrix of 4 x 4");
  if (!std::all_of(m.begin(), m.end(), [](double v) { return std::isfinite(v); })) return std::nullopt;
  Eigen::Matrix3d rotation;
  Eigen::Vector3d translation;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) rotation(row, column) = m[static_cast<std::size_t>(4 * row + column)];
    translation[row] = m[static_cast<std::size_t>(4 * row + 3)];
  }
  const bool last_row = std::abs(m[12]) + std::abs(m[13]) + std::abs(m[14]) + std::abs(m[15] - 1) < 1e-6;
  const std::optional<Pose> pose = rigid_pose(rotation, translation);
  if (!pose || !last_row) throw Error(file, line, "is not a rigid motion; expected a rotation, a translation and the row 0 0 0 1");
  return pose;
}

Eigen::Vector3d guess_up(const std::vector<RecordedFrame>& frames) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const RecordedFrame& frame : frames) {
    if (frame.X_WC) sum -= frame.X_WC->linear().col(1);
  }
  if (sum.isZero()) return -Eigen::Vector3d::UnitY();
  Eigen::Index axis = 0;
  sum.cwiseAbs().maxCoeff(&axis);
  return (sum[axis] > 0 ? 1.0 : -1.0) * Eigen::Vector3d::Unit(axis);
}

}  // namespace waretwin

// The layout of 7-Scenes and 3DMatch.
#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "core/error.h"
#include "sensors/recordings/contents.h"
#include "sensors/recordings/text_formats.h"

namespace waretwin {

namespace fs = std::filesystem;

namespace {

constexpr const char* kIntrinsics = "camera-intrinsics.txt";

// "frame-000123.color.png" -> 123; nothing for other names.
std::optional<std::int64_t> colour_number(const std::string& name) {
  const std::string head = "frame-";
  for (const std::string tail : {".color.png", ".color.jpg"}) {
    if (name.size() <= head.size() + tail.size() || name.rfind(head, 0) != 0) continue;
    const std::string digits = name.substr(head.size(), name.size() - head.size() - tail.size());
    if (name.substr(head.size() + digits.size()) != tail || digits.size() > 9) continue;
    if (std::all_of(digits.begin(), digits.end(), [](unsigned char c) { return std::isdigit(c) != 0; })) return std::stoll(digits);
  }
  return std::nullopt;
}

std::map<std::int64_t, fs::path> colour_files(const fs::path& folder) {
  std::map<std::int64_t, fs::path> files;
  std::error_code failure;
  for (const auto& entry : fs::directory_iterator(folder, failure)) {
    const auto number = colour_number(entry.path().filename().string());
    if (!number) continue;
    const auto inserted = files.emplace(*number, entry.path());
    if (!inserted.second) {
      throw Error(folder, "holds two colour pictures of frame " + std::to_string(*number) + "; expected .color.png or .color.jpg");
    }
  }
  return files;
}

// The numbers of a small matrix file.
std::vector<double> read_matrix(const fs::path& file, std::size_t rows, std::size_t columns) {
  std::vector<double> numbers;
  for (const TextLine& line : read_text_lines(file)) {
    for (const std::string& word : line.words) numbers.push_back(parse_text_number(file, line.line, word));
  }
  if (numbers.size() != rows * columns) {
    throw Error(file, "holds " + std::to_string(numbers.size()) + " numbers; expected a matrix of " + std::to_string(rows) + " x " +
                          std::to_string(columns));
  }
  return numbers;
}

std::vector<double> read_intrinsics(const fs::path& file) {
  const std::vector<double> k = read_matrix(file, 3, 3);
  const bool finite = std::all_of(k.begin(), k.end(), [](double v) { return std::isfinite(v); });
  if (!finite || k[0] <= 0 || k[4] <= 0 || k[3] != 0 || k[6] != 0 || k[7] != 0 || k[8] != 1) {
    throw Error(file, "is not a camera matrix; expected fx 0 cx / 0 fy cy / 0 0 1 with positive fx and fy");
  }
  return {k[0], k[4], k[2], k[5]};
}

// Nothing for a lost camera.
std::optional<Pose> read_pose(const fs::path& file) {
  const std::vector<double> m = read_matrix(file, 4, 4);
  if (!std::all_of(m.begin(), m.end(), [](double v) { return std::isfinite(v); })) return std::nullopt;
  Eigen::Matrix3d rotation;
  Eigen::Vector3d translation;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) rotation(row, column) = m[static_cast<std::size_t>(4 * row + column)];
    translation[row] = m[static_cast<std::size_t>(4 * row + 3)];
  }
  const bool last_row = std::abs(m[12]) + std::abs(m[13]) + std::abs(m[14]) + std::abs(m[15] - 1) < 1e-6;
  const std::optional<Pose> pose = rigid_pose(rotation, translation);
  if (!pose || !last_row) throw Error(file, "is not a rigid motion; expected a rotation, a translation and the row 0 0 0 1");
  return pose;
}

// Whichever world axis the cameras' upper edges point along on average.
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

}  // namespace

bool is_frame_folder(const fs::path& folder) { return fs::exists(folder / kIntrinsics) || !colour_files(folder).empty(); }

RecordingContents read_frame_folder(const fs::path& folder, const RecordingConfig& config) {
  RecordingContents contents;
  contents.rate_hz = config.frame_rate_hz;
  if (config.intrinsics.empty()) contents.intrinsics = read_intrinsics(folder / kIntrinsics);
  bool some_pose = false;
  std::optional<fs::path> without_pose;
  for (const auto& [number, colour] : colour_files(folder)) {
    const std::string stem = colour.filename().string().substr(0, colour.filename().string().find('.'));
    RecordedFrame frame;
    frame.stamp = static_cast<Stamp>(std::llround(static_cast<double>(number) / config.frame_rate_hz * 1e9));
    frame.colour = colour;
    frame.depth = folder / (stem + ".depth.png");
    if (!fs::exists(frame.depth)) throw Error(frame.depth, "no such file; expected a depth image for each colour picture");
    const fs::path pose = folder / (stem + ".pose.txt");
    if (fs::exists(pose)) {
      some_pose = true;
      frame.X_WC = read_pose(pose);
      if (!frame.X_WC) {
        ++contents.lost_frames;
        continue;
      }
    } else if (!without_pose) {
      without_pose = pose;
    }
    contents.frames.push_back(std::move(frame));
  }
  if (some_pose && without_pose) throw Error(*without_pose, "no such file; expected a pose for each frame or for none");
  if (contents.frames.empty()) {
    throw Error(folder, contents.lost_frames > 0 ? "holds no frame with a pose; all " + std::to_string(contents.lost_frames) + " are lost"
                                                 : "holds no frames; expected frame-NNNNNN.color.png or .jpg");
  }
  contents.up_W = guess_up(contents.frames);
  return contents;
}

}  // namespace waretwin

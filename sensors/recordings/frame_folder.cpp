// The layout of 7-Scenes and 3DMatch.
#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "core/error.h"
#include "sensors/recordings/contents.h"
#include "sensors/recordings/numbered_frames.h"
#include "sensors/recordings/text_formats.h"

namespace waretwin {

namespace fs = std::filesystem;

namespace {

constexpr const char* kIntrinsics = "camera-intrinsics.txt";

// Colour pictures by number.
std::map<std::int64_t, fs::path> colour_files(const fs::path& folder) {
  std::map<std::int64_t, fs::path> files = numbered_files(folder, "frame-", ".color.png");
  for (const auto& [number, file] : numbered_files(folder, "frame-", ".color.jpg")) {
    if (!files.emplace(number, file).second) {
      throw Error(folder, "holds two colour pictures of frame " + std::to_string(number) + "; expected .color.png or .color.jpg");
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

}  // namespace

bool is_frame_folder(const fs::path& folder) { return fs::exists(folder / kIntrinsics) || !colour_files(folder).empty(); }

RecordingContents read_frame_folder(const fs::path& folder, const RecordingConfig& config) {
  RecordingContents contents;
  contents.rate_hz = config.frame_rate_hz;
  if (config.intrinsics.empty()) contents.intrinsics = read_intrinsics(folder / kIntrinsics);
  const FrameStamps stamps(folder, config.frame_rate_hz);
  bool some_pose = false;
  std::optional<fs::path> without_pose;
  for (const auto& [number, colour] : colour_files(folder)) {
    const std::string stem = colour.filename().string().substr(0, colour.filename().string().find('.'));
    const fs::path depth = folder / (stem + ".depth.png");
    if (!fs::exists(depth)) throw Error(depth, "no such file; expected a depth image for each colour picture");
    const Stamp stamp = stamps.of(number);
    RecordedFrame frame{stamp, stamp, stored_colour(colour), stored_depth(depth)};
    const fs::path pose = folder / (stem + ".pose.txt");
    if (fs::exists(pose)) {
      some_pose = true;
      frame.X_WC = matrix_pose(read_matrix(pose, 4, 4), pose, 0);
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
  expect_times_of(contents.frames, stamps.file());
  contents.up_W = guess_up(contents.frames);
  return contents;
}

}  // namespace waretwin

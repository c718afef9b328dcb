// The layout of SceneNN (Hua et al., SceneNN: A Scene Meshes Dataset with aNNotations, 3DV 2016), as the dataset's playback tool unpacks
// it.
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

std::map<std::int64_t, fs::path> colour_files(const fs::path& folder) {
  std::map<std::int64_t, fs::path> files = numbered_files(folder / "image", "image", ".png");
  files.merge(numbered_files(folder / "image", "image", ".jpg"));
  return files;
}

// "frame colour_us depth_us" a line.
struct Times {
  Stamp colour = 0, depth = 0;
};
std::map<std::int64_t, Times> read_times(const fs::path& file) {
  std::map<std::int64_t, Times> times;
  if (!fs::exists(file)) return times;
  for (const TextLine& line : read_text_lines(file)) {
    if (line.words.size() != 3) {
      throw Error(file, line.line, "has " + std::to_string(line.words.size()) + " numbers; expected 'frame colour_us depth_us'");
    }
    const auto whole = [&](std::size_t i) {
      const double value = parse_text_number(file, line.line, line.words[i]);
      constexpr double kMost = 4.5e15;
      if (!(value >= 0 && value <= kMost) || value != std::floor(value)) {
        throw Error(file, line.line, "'" + line.words[i] + "' is no whole number from 0 on; expected 'frame colour_us depth_us'");
      }
      return static_cast<std::int64_t>(value);
    };
    times[whole(0)] = {whole(1) * 1000, whole(2) * 1000};
  }
  return times;
}

// Poses by frame: a line "i i i+1" and four rows for frame i + 1. A lost camera has no value.
std::map<std::int64_t, std::optional<Pose>> read_log(const fs::path& file) {
  std::map<std::int64_t, std::optional<Pose>> poses;
  const std::vector<TextLine> lines = read_text_lines(file);
  constexpr std::size_t kLines = 5;
  for (std::size_t i = 0; i < lines.size(); i += kLines) {
    const TextLine& head = lines[i];
    if (head.words.size() != 3 || i + kLines > lines.size()) {
      throw Error(file, head.line, "is no entry of a trajectory; expected a line 'i i i+1' and the four rows of a matrix");
    }
    const double index = parse_text_number(file, head.line, head.words[0]);
    constexpr double kMost = 1e9;
    if (!(index >= 0 && index < kMost) || index != std::floor(index)) {
      throw Error(file, head.line, "'" + head.words[0] + "' is no frame; expected a whole number from 0 on");
    }
    std::vector<double> numbers;
    for (std::size_t row = 1; row < kLines; ++row) {
      const TextLine& line = lines[i + row];
      if (line.words.size() != 4) {
        throw Error(file, line.line, "has " + std::to_string(line.words.size()) + " numbers; expected a row of a 4 x 4 matrix");
      }
      for (const std::string& word : line.words) numbers.push_back(parse_text_number(file, line.line, word));
    }
    poses[static_cast<std::int64_t>(index) + 1] = matrix_pose(numbers, file, head.line);
  }
  return poses;
}

// fx, fy and the picture's middle from lines "name value".
std::optional<std::vector<double>> read_ini(const fs::path& file) {
  if (!fs::exists(file)) return std::nullopt;
  std::map<std::string, double> values;
  for (const TextLine& line : read_text_lines(file)) {
    if (line.words.size() == 2) values[line.words[0]] = parse_text_number(file, line.line, line.words[1]);
  }
  for (const char* name : {"fx", "fy", "depth_width", "depth_height"}) {
    const auto found = values.find(name);
    if (found == values.end() || !(found->second > 0.0)) {
      throw Error(file, std::string("has no ") + name + " above 0; expected lines 'fx ..', 'fy ..', 'depth_width ..', 'depth_height ..'");
    }
  }
  const auto middle = [&](const char* given, const char* size) {
    return values.contains(given) ? values.at(given) : 0.5 * values.at(size);
  };
  return std::vector<double>{values.at("fx"), values.at("fy"), middle("cx", "depth_width"), middle("cy", "depth_height")};
}

std::vector<double> intrinsics_of(const fs::path& folder) {
  for (const fs::path& place : {folder, folder / "intrinsic", fs::absolute(folder).lexically_normal().parent_path() / "intrinsic"}) {
    for (const char* name : {"asus.ini", "kinect2.ini"}) {
      if (auto found = read_ini(place / name)) return *found;
    }
  }
  return {544.47329, 544.47329, 320.0, 240.0};  // the dataset's asus.ini
}

}  // namespace

bool is_scenenn_folder(const fs::path& folder) { return !colour_files(folder).empty() && fs::is_directory(folder / "depth"); }

RecordingContents read_scenenn_folder(const fs::path& folder, const RecordingConfig& config) {
  RecordingContents contents;
  contents.rate_hz = config.frame_rate_hz;
  if (config.intrinsics.empty()) contents.intrinsics = intrinsics_of(folder);
  const FrameStamps stamps(folder, config.frame_rate_hz);
  const fs::path times_file = folder / "timestamp.txt", log = folder / "trajectory.log";
  const std::map<std::int64_t, Times> times = stamps.exact() ? std::map<std::int64_t, Times>() : read_times(times_file);
  std::map<std::int64_t, std::optional<Pose>> poses;
  const bool has_poses = fs::exists(log);
  if (has_poses) poses = read_log(log);
  std::size_t without_depth = 0, beyond_log = 0;
  for (const auto& [number, colour] : colour_files(folder)) {
    std::string name = std::to_string(number);
    name = "depth" + std::string(name.size() < 5 ? 5 - name.size() : 0, '0') + name + ".png";
    const fs::path depth = folder / "depth" / name;
    if (!fs::exists(depth)) {
      ++without_depth;
      continue;
    }
    RecordedFrame frame{0, 0, stored_colour(colour), stored_depth(depth)};
    if (times.empty()) {
      frame.stamp = frame.depth_stamp = stamps.of(number);
    } else {
      const auto found = times.find(number);
      if (found == times.end())
        throw Error(times_file, "has no line for frame " + std::to_string(number) + "; expected one for each picture");
      frame.stamp = found->second.colour;
      frame.depth_stamp = found->second.depth;
    }
    if (has_poses) {
      const auto found = poses.find(number);
      // The dataset's trajectories end a little before or after its pictures.
      if (found == poses.end()) {
        ++beyond_log;
        continue;
      }
      if (!found->second) {
        ++contents.lost_frames;
        continue;
      }
      frame.X_WC = found->second;
    }
    contents.frames.push_back(std::move(frame));
  }
  if (contents.frames.empty()) {
    throw Error(folder, "holds no frame that has a picture, a depth image" + std::string(has_poses ? " and a pose" : "") +
                            "; expected image/imageNNNNN.png with depth/depthNNNNN.png");
  }
  expect_times_of(contents.frames, times.empty() ? stamps.file() : times_file);
  if (without_depth > 0) contents.remarks.push_back(std::to_string(without_depth) + " pictures without a depth image are left out");
  if (beyond_log > 0) contents.remarks.push_back(std::to_string(beyond_log) + " frames that trajectory.log does not name are left out");
  contents.up_W = guess_up(contents.frames);
  return contents;
}

}  // namespace waretwin

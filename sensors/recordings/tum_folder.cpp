// The layout of the TUM RGB-D benchmark.
#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"
#include "sensors/recordings/contents.h"
#include "sensors/recordings/stamped_files.h"
#include "sensors/recordings/text_formats.h"

namespace waretwin {

namespace fs = std::filesystem;

namespace {

constexpr const char* kPoses = "groundtruth.txt";

struct StampedPose {
  Stamp stamp = 0;
  Pose X_WC = Pose::Identity();
};

std::vector<StampedPose> read_trajectory(const fs::path& file) {
  std::vector<StampedPose> poses;
  for (const TextLine& line : read_text_lines(file)) {
    if (line.words.size() != 8) {
      throw Error(file, line.line, "has " + std::to_string(line.words.size()) + " numbers; expected 'seconds x y z qx qy qz qw'");
    }
    double n[8];
    for (std::size_t i = 1; i < 8; ++i) n[i] = parse_text_number(file, line.line, line.words[i]);
    const Eigen::Vector3d position(n[1], n[2], n[3]);
    const Eigen::Quaterniond rotation(n[7], n[4], n[5], n[6]);
    if (!position.allFinite() || !(std::abs(rotation.norm() - 1.0) < 0.01)) {
      throw Error(file, line.line, "is not a pose; expected finite numbers and a quaternion of length 1");
    }
    StampedPose pose;
    pose.stamp = parse_text_stamp(file, line.line, line.words[0]);
    pose.X_WC.translation() = position;
    pose.X_WC.linear() = rotation.normalized().toRotationMatrix();
    poses.push_back(pose);
  }
  expect_times(poses, file, "poses");
  sort_by_stamp(poses);
  return poses;
}

// The camera's poses, sorted by stamp, and of how many frames they do not tell.
struct RecordedPoses {
  std::vector<StampedPose> poses;
  Stamp max_gap = 0, tolerance = 0;
  std::size_t unknown = 0, in_gaps = 0;

  std::optional<Pose> at(Stamp stamp) {
    if (poses.empty()) return std::nullopt;
    const auto after = std::lower_bound(poses.begin(), poses.end(), stamp, [](const StampedPose& p, Stamp s) { return p.stamp < s; });
    if (after != poses.end() && after->stamp == stamp) return after->X_WC;
    const bool inside = after != poses.begin() && after != poses.end();
    if (inside && after->stamp - (after - 1)->stamp <= max_gap) {
      const StampedPose& before = *(after - 1);
      return interpolate(before.X_WC, after->X_WC,
                         static_cast<double>(stamp - before.stamp) / static_cast<double>(after->stamp - before.stamp));
    }
    const StampedPose& near = poses[nearest_stamp(poses, stamp)];
    if (std::abs(near.stamp - stamp) <= tolerance) return near.X_WC;
    ++(inside ? in_gaps : unknown);
    return std::nullopt;
  }
};

std::vector<double> read_calibration(const fs::path& file) {
  std::vector<double> numbers;
  for (const TextLine& line : read_text_lines(file)) {
    for (const std::string& word : line.words) numbers.push_back(parse_text_number(file, line.line, word));
  }
  if (numbers.size() < 4) throw Error(file, "holds " + std::to_string(numbers.size()) + " numbers; expected 'fx fy cx cy'");
  numbers.resize(4);
  return numbers;
}

}  // namespace

bool is_tum_folder(const fs::path& folder) { return fs::exists(folder / "rgb.txt") || fs::exists(folder / "depth.txt"); }

RecordingContents read_tum_folder(const fs::path& folder, const RecordingConfig& config) {
  RecordingContents contents;
  contents.depth_scale = 5000.0;
  if (fs::exists(folder / "calibration.txt")) {
    contents.intrinsics = read_calibration(folder / "calibration.txt");
  } else {
    contents.intrinsics = {517.3, 516.5, 318.6, 255.3};  // Freiburg 1, from the benchmark's page on its file formats
  }
  const std::vector<StampedFile> colours = read_file_list(folder / "rgb.txt");
  std::vector<StampedFile> depths = read_file_list(folder / "depth.txt");
  for (StampedFile& depth : depths) depth.stamp += depth_delay(config);
  const Stamp tolerance = from_seconds(config.association_s);
  RecordedPoses poses;
  poses.max_gap = from_seconds(config.max_pose_gap_s);
  poses.tolerance = tolerance;
  if (fs::exists(folder / kPoses)) poses.poses = read_trajectory(folder / kPoses);
  for (const auto& [colour, depth] : pairs_by_stamp(colours, depths, tolerance)) {
    RecordedFrame frame{colours[colour].stamp, depths[depth].stamp, stored_colour(colours[colour].file), stored_depth(depths[depth].file)};
    frame.X_WC = poses.at(frame.stamp + from_seconds(config.clock.colour_s));
    contents.frames.push_back(std::move(frame));
  }
  if (contents.frames.empty()) {
    throw Error(folder, "has no colour picture with a depth image within " + std::to_string(config.association_s) + " s (" +
                            std::to_string(colours.size()) + " in rgb.txt, " + std::to_string(depths.size()) + " in depth.txt)");
  }
  remark_unpaired(contents, colours.size(), depths.size(), config.association_s);
  remark_without_pose(contents, poses.unknown, poses.in_gaps, kPoses, config.max_pose_gap_s);
  return contents;
}

}  // namespace waretwin

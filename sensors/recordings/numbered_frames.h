// What layouts have in common whose pictures carry numbers. Internal to sensors/recordings.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/pose.h"
#include "core/stamp.h"
#include "sensors/recordings/contents.h"

namespace waretwin {

// Files of a folder that are called HEAD, up to nine digits, TAIL, by their number. Empty where the folder is missing.
std::map<std::int64_t, std::filesystem::path> numbered_files(const std::filesystem::path& folder, const std::string& head,
                                                             const std::string& tail);

// When each numbered frame was taken: by stamps.txt ("number seconds" a line, exact, as our own recordings add it), else evenly.
class FrameStamps {
 public:
  // Throws Error for a malformed line.
  FrameStamps(const std::filesystem::path& folder, double rate_hz);
  // Throws Error for a number that stamps.txt leaves out.
  Stamp of(std::int64_t number) const;
  bool exact() const { return !stamps_.empty(); }
  const std::filesystem::path& file() const { return file_; }

 private:
  std::filesystem::path file_;
  double rate_hz_;
  std::map<std::int64_t, Stamp> stamps_;
};

// Throws Error naming the file that the stamps are from where all of several frames have one stamp.
void expect_times_of(const std::vector<RecordedFrame>& frames, const std::filesystem::path& file);

// A 4 x 4 matrix, row by row, as a pose. Nothing where a number is not finite (a lost camera); throws Error naming file and line (0: the
// file as a whole) for what is no rigid motion.
std::optional<Pose> matrix_pose(const std::vector<double>& numbers, const std::filesystem::path& file, int line);

// Whichever world axis the cameras' upper edges point along on average; -y without poses.
Eigen::Vector3d guess_up(const std::vector<RecordedFrame>& frames);

}  // namespace waretwin

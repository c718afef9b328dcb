// What a run keeps of its mapped frames for pages and videos: up to 150 of them, spread over the drive, as small pictures with what was
// found in them. frames.jsonl is the list; the pictures are frames/small/*.jpg.
#pragma once

#include <filesystem>
#include <map>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "harness/score/cuboid_file.h"
#include "mapper/mapper.h"

namespace waretwin {

struct LoggedDetection {
  std::string class_name;
  double score = 0.0;
  cv::Rect2d box;  // pixels of the whole picture
  int map_id = 0;  // the object that it became part of; 0: of none
};

struct LoggedFrame {
  int number = 0;  // counts mapped frames, from 0
  int turn = 0;    // counts this camera's, from 0; not in the file
  Stamp stamp = 0;
  std::string sensor;
  Intrinsics intrinsics;                                  // of the whole picture; the small ones show the same
  double range_m = 0.0;                                   // depth is not trusted beyond
  Pose X_WC = Pose::Identity(), X_WB = Pose::Identity();  // as estimated, in the map's world
  std::vector<LoggedDetection> detections;
  std::vector<ListedObject> objects;  // of the map after this frame
  // JPEG, at most 480 x 270. Colour is empty where the frame had none (simulation.colour=false).
  std::string colour, depth;
};

// Small pictures of this frame and its record. `number` counts mapped frames.
LoggedFrame logged_frame(int number, const Mapper::FrameResult& result, const ObjectList& objects, const StreamInfo::Camera& camera);

// Which frames of a drive of unknown length are kept: every step-th of each camera; when there are more than `most`, every second one goes
// and the step doubles. So memory stays flat, and never fewer than about half of `most` are kept of a longer drive.
class FrameLog {
 public:
  explicit FrameLog(std::size_t most = 150) : most_(most) {}
  // Counts a mapped frame of this camera; its turn where it is to be kept, nothing where not.
  std::optional<int> turn_of(const std::string& sensor);
  void add(LoggedFrame frame);
  std::vector<LoggedFrame> take() { return std::move(frames_); }

 private:
  std::size_t most_;
  int step_ = 1;
  std::map<std::string, int> turns_;  // by camera
  std::vector<LoggedFrame> frames_;
};

// Writes frames.jsonl and the pictures into a run's folder, in place of earlier ones.
void write_frame_log(const std::filesystem::path& folder, const std::vector<LoggedFrame>& frames);

// Empty where the folder has no frames.jsonl; a picture that is gone comes back empty. Throws Error with file and line for text that is not
// what was written.
std::vector<LoggedFrame> read_frame_log(const std::filesystem::path& folder);

}  // namespace waretwin

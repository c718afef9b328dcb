// The folder that a run leaves behind. Files of an earlier run are replaced one by one, each whole; score.json goes first and comes back
// last, so that a folder with a score is a complete one.
#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <string>

#include "harness/run/closed_loop.h"
#include "mapper/output/output_config.h"

namespace waretwin {

class RunFolder {
 public:
  // Makes the folder and takes the score, the report and the verdict of an earlier run away. Throws Error where that cannot be,
  // and for a folder that holds a recording, a scenario or a dataset.
  explicit RunFolder(const std::filesystem::path& path);

  // Both create the folders in `name` that are missing.
  void write(const std::string& name, const std::string& bytes);
  void write_png(const std::string& name, const cv::Mat& image);
  std::filesystem::path file(const std::string& name);
  const std::filesystem::path& path() const { return path_; }

  // Takes a file of an earlier run away, if there is one. Throws Error where that cannot be.
  void remove(const std::string& name);
  // Empties a folder of files of an earlier run (objects, frames).
  void clear(const std::string& name);

 private:
  std::filesystem::path path_;
};

// All files that need no truth: map, cloud, occupancy, cuboids, trajectory, timing, frames, pictures of `scene`, which gets the mesh of the
// map. Where the recording's own world is not z up, PLY files and the trajectory are in the recording's world; cuboids, map.glb, occupancy,
// octomap.bt and map.waretwin are in the map's upright one, and upright.json holds the pose of the upright world in the recording's.
// surface_error.ply holds `surface_errors_m` (one a vertex of the mesh) beside the vertices, where they are known.
void write_map(RunFolder& folder, const MappingResult& mapping, MapScene scene, const OutputConfig& output,
               const std::vector<float>& surface_errors_m = {});

// The same with truth, Table 6, report.html, and score.json at the very end.
void write_closed_loop(RunFolder& folder, const ClosedLoopResult& result, const OutputConfig& output);

// What `waretwin map` leaves behind: write_map, map.json (what a score says of a run) and report.html. Of a laser log (no camera) it is the
// trajectory, as poses of the laser (X_WL), its picture, and report.html.
void write_mapping(RunFolder& folder, const MappingResult& mapping, const std::string& source, const std::string& profile,
                   const OutputConfig& output);

// A row for each pose that has a covariance: of the vehicle's x, y and yaw in the map's world. Empty where none has one.
std::string covariance_csv(const std::vector<TrajectoryPoint>& trajectory);

// A row a mapped frame.
std::string timing_csv(const std::vector<FrameRow>& frames);

}  // namespace waretwin

#include "harness/run/external_run.h"

#include <algorithm>
#include <sstream>

#include "core/digest.h"
#include "core/error.h"
#include "core/files.h"
#include "harness/pictures/map_pictures.h"
#include "harness/report/report_file.h"
#include "harness/run/record.h"
#include "harness/score/score_json.h"
#include "harness/score/table6.h"
#include "sensors/recordings/recording_writer.h"

namespace waretwin {

namespace fs = std::filesystem;

namespace {

constexpr const char* kRecording = "{recording}";
constexpr const char* kOut = "{out}";
constexpr const char* kBoxes = "{boxes}";

void check(const RunConfig& config) {
  const ExternalMapper& mapper = config.external_mapper;
  for (const char* needed : {kRecording, kOut}) {
    if (mapper.command.find(needed) == std::string::npos) {
      throw Error("--mapper '" + mapper.command + "': does not say " + needed + "; expected a command with {recording} and {out}");
    }
  }
  if (mapper.command.find(kBoxes) != std::string::npos && !config.truth_stages.detector) {
    throw Error("--mapper '" + mapper.command + "': asks for {boxes}; expected --detector truth, which makes them");
  }
  if (config.truth_stages.poses && mapper.format == "rosbag") {
    throw Error("--poses truth: format rosbag has no place for the camera's true poses; expected tum, scenenn or 7scenes");
  }
}

std::vector<std::string> last_lines(const fs::path& file, std::size_t count) {
  std::vector<std::string> lines;
  std::istringstream in(read_file(file));
  for (std::string line; std::getline(in, line);) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    lines.push_back(line);
    if (lines.size() > count) lines.erase(lines.begin());
  }
  return lines;
}

// The folder of what the command leaves, empty.
void make_empty(const fs::path& folder) {
  std::error_code error;
  fs::remove_all(folder, error);
  if (error) throw Error(folder, "cannot be emptied: " + error.message());
  make_folder(folder);
}

RunScore score_of(const RunConfig& config, const ShellResult& shell, const RecordedDrive& drive, const std::vector<ListedObject>& mapped,
                  const std::optional<Trajectory>& trajectory, const std::vector<std::pair<Pose, Pose>>& pairs) {
  RunScore score;
  score.scenario = config.scenario.name;
  score.profile = "mapper";
  score.seed = config.scenario.seed;
  Digest digest;
  add_to(digest, mapped, trajectory ? trajectory->poses : std::vector<StampedPose>());
  score.digest = digest.hex();
  score.stages = {{"detector", config.truth_stages.detector ? "truth" : "mapper"},
                  {"poses", config.truth_stages.poses ? "truth" : "mapper"},
                  {"association", "mapper"},
                  {"depth", config.simulation.truth_depth ? "truth" : "sensor"}};
  score.objects = compare_lists(mapped, drive.truth, config.score);
  if (trajectory) {
    score.trajectory = score_trajectory(pairs, TrajectoryAlignment::kNone);
    score.trajectory_aligned = score_trajectory(pairs, TrajectoryAlignment::kSe3);
  }
  score.motion = drive.motion;
  score.frames_simulated = score.frames_mapped = drive.summary.frames;
  score.realtime_factor = shell.wall_s > 0.0 ? drive.summary.duration_s / shell.wall_s : 0.0;
  score.peak_rss_mb = shell.peak_rss_mb;
  return score;
}

}  // namespace

ExternalRunResult run_external(const RunConfig& config, const std::shared_ptr<const Scene>& scene, const std::function<RunFolder&()>& ready,
                               const std::function<void(double, const std::string&)>& progress) {
  const ExternalMapper& mapper = config.external_mapper;
  check(config);
  RunFolder& folder = ready();
  // Of an earlier run: it would stand beside this one's, and the truth where the command might look.
  for (const char* earlier : {"cuboids.json",
                              "truth.json",
                              "trajectory.tum",
                              "trajectory_truth.tum",
                              "trajectory_covariance.csv",
                              "table6.md",
                              "topdown.png",
                              "mesh.png",
                              "timing.csv",
                              "frames.jsonl",
                              "map.glb",
                              "map.ply",
                              "map.waretwin",
                              "cloud.ply",
                              "surface_error.ply",
                              "occupancy.pgm",
                              "occupancy.yaml",
                              "esdf.nrrd",
                              "octomap.bt",
                              "detections.jsonl",
                              "truth_frames.jsonl",
                              "budget.md",
                              "upright.json"}) {
    folder.remove(earlier);
  }
  for (const char* part : {"objects", "frames", "frames/small", "truth_poses", "truth_poses/cameras", "truth_poses/lasers"})
    folder.clear(part);
  const fs::path base = fs::absolute(folder.path()).lexically_normal() / "mapper", recording = base / "recording", out = base / "out";
  make_empty(out);
  const RecordPlan plan{mapper.format, false, config.truth_stages.poses, config.truth_stages.detector, config.mapper.rate_hz};
  const RecordConfig to_record{config.scenario, config.simulation, config.truth_detector, config.bag};
  ExternalRunResult result;
  const RecordedDrive drive =
      record_drive(to_record, scene, plan, recording, "scenario " + config.scenario.name,
                   [&](double done, const RecordSummary& so_far) { progress(done, std::to_string(so_far.frames) + " frames recorded"); });
  const std::string command =
      with_words(mapper.command, {{kRecording, recording.string()}, {kOut, out.string()}, {kBoxes, (recording / "boxes.json").string()}});
  result.shell = run_shell(command, base / "stdout.log", base / "stderr.log", mapper.timeout_s, [&](double seconds) {
    progress(1.0, "the mapper runs for " + std::to_string(static_cast<int>(seconds)) + " s");
  });
  result.last_words = last_lines(base / "stderr.log", 5);
  folder.write("truth.json", truth_json(drive.truth));
  folder.write("trajectory_truth.tum", tum_text(drive.true_trajectory));
  if (result.shell.timed_out || result.shell.exit_code != 0) return result;

  const fs::path cuboids = out / "cuboids.json", poses = out / "trajectory.tum";
  if (!fs::exists(cuboids)) throw Error(cuboids, "is missing though the mapper ended well; expected a list of objects as cuboids.json");
  const std::vector<ListedObject> mapped = read_object_list(cuboids);
  std::optional<Trajectory> trajectory;
  std::vector<std::pair<Pose, Pose>> pairs;
  try {
    if (fs::exists(poses)) {
      trajectory = read_trajectory(poses);
      pairs = associate_poses(*trajectory, {drive.true_trajectory, true});
    }
  } catch (const Error& error) {
    // The objects are scored all the same.
    trajectory.reset();
    result.trajectory_problem = poses.string() + " is not scored: " + error.what();
  }
  result.score = score_of(config, result.shell, drive, mapped, trajectory, pairs);
  folder.write("cuboids.json", read_file(cuboids));
  MapScene picture;
  picture.mapped = mapped;
  picture.truth = drive.truth;
  picture.true_trajectory = drive.true_trajectory;
  if (trajectory) {
    picture.trajectory = trajectory->poses;
    folder.write("trajectory.tum", read_file(poses));
  }
  folder.write_png("topdown.png", draw_from_above(picture, 0.0));
  folder.write("table6.md", table6(result.score->objects, config.scenario.name + ", mapper " + mapper.command));
  const std::string json = score_json(*result.score);
  write_report(folder.path(), ReportKind::kRun, json);
  folder.write("score.json", json);
  std::error_code stays;
  if (!mapper.keep_recording) fs::remove_all(recording, stays);
  return result;
}

}  // namespace waretwin

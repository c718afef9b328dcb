#include "harness/run/external_run.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

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
constexpr std::size_t kMostOfALine = 200;  // of the command's own words

// Of a log that may be as long as the disk is large; none where the command took it away.
std::vector<std::string> last_lines(const fs::path& file, std::size_t count) {
  constexpr std::streamoff kTail = 64 << 10;
  std::vector<std::string> lines;
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return lines;
  std::ifstream in(file, std::ios::binary);
  in.seekg(0, std::ios::end);
  const std::streamoff size = in.tellg(), begin = std::max<std::streamoff>(0, size - kTail);
  in.seekg(begin);
  std::string tail(static_cast<std::size_t>(std::min(std::max<std::streamoff>(0, size), kTail)), '\0');
  in.read(tail.data(), static_cast<std::streamsize>(tail.size()));
  tail.resize(static_cast<std::size_t>(in.gcount()));
  std::istringstream text(tail);
  for (std::string line; std::getline(text, line);) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    lines.push_back(line);
    if (lines.size() > count) lines.erase(lines.begin());
  }
  return lines;
}

// Whether the command left the file. Throws Error for what is there and is no file: a pipe would be read for ever.
bool is_left(const fs::path& file) {
  std::error_code error;
  const fs::file_status found = fs::status(file, error);
  if (found.type() == fs::file_type::not_found) return false;
  if (error) throw Error(file, "cannot be looked at: " + error.message());
  if (!fs::is_regular_file(found)) throw Error(file, "is a folder, a pipe or the like; expected a file");
  return true;
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
  score.profile = kExternalProfile;
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

// The text as one line of UTF-8, whatever a program printed: of a line that it wrote over (a progress bar) what was seen last.
std::string one_line(const std::string& text) {
  using Json = nlohmann::json;
  std::string line = Json::parse(Json(text).dump(-1, ' ', false, Json::error_handler_t::replace)).get<std::string>();
  while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
  const std::size_t over = line.rfind('\r');
  if (over != std::string::npos) line.erase(0, over + 1);
  for (char& c : line) {
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  }
  return line;
}

// At most so many bytes, never within a character.
std::string shortened(const std::string& text, std::size_t bytes) {
  if (text.size() <= bytes) return text;
  while (bytes > 0 && (static_cast<unsigned char>(text[bytes]) & 0xC0) == 0x80) --bytes;
  return text.substr(0, bytes) + "..";
}

std::string with_folder(std::string text, const fs::path& folder, const fs::path& shown) {
  const std::string from = folder.string(), to = shown.string();
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) text.replace(at, from.size(), to);
  return text;
}

}  // namespace

void check_external(const RunConfig& config) {
  const ExternalMapper& mapper = config.external_mapper;
  const std::string key = "external_mapper.command '" + mapper.command + "': ";
  for (const char* needed : {kRecording, kOut}) {
    if (mapper.command.find(needed) == std::string::npos)
      throw Error(key + "does not say " + needed + "; expected a command with {recording} and {out}");
  }
  if (mapper.command.find(kBoxes) != std::string::npos && !config.truth_stages.detector)
    throw Error(key + "asks for {boxes}; expected --detector truth (truth_stages.detector), which makes them");
  if (config.truth_stages.poses && mapper.format == "rosbag") {
    throw Error("--poses truth: format rosbag has no place for the camera's true poses; expected tum, scenenn or 7scenes");
  }
  for (const auto& [name, file] : {std::pair("resume", &config.resume), std::pair("extrinsics", &config.extrinsics)}) {
    if (!file->empty()) throw Error(std::string(name) + ": " + *file + " is for our own mapper; expected none with another one");
  }
  for (const std::string& file : mapper.depends) {
    std::error_code error;
    const fs::file_status found = fs::status(file, error);
    if (!fs::is_regular_file(found) && !fs::is_directory(found)) {
      const std::string what = found.type() == fs::file_type::not_found ? "is not there"
                               : error                                  ? "cannot be looked at (" + error.message() + ")"
                                                                        : "is neither of both";
      throw Error("external_mapper.depends: '" + file + "' " + what + "; expected a file or folder, named from " +
                  fs::current_path().string());
    }
  }
}

ExternalRunResult run_external(const RunConfig& config, const std::shared_ptr<const Scene>& scene, const std::function<RunFolder&()>& ready,
                               const std::function<void(double, const std::string&)>& progress) {
  const ExternalMapper& mapper = config.external_mapper;
  check_external(config);
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
  ExternalRunResult result;
  result.folder = fs::absolute(folder.path()).lexically_normal();
  result.timeout_s = mapper.timeout_s;
  const fs::path base = result.folder / "mapper", recording = base / "recording", out = base / "out";
  make_empty(out);
  const RecordPlan plan{.format = mapper.format,
                        .truth_beside = false,
                        .true_poses = config.truth_stages.poses,
                        .true_boxes = config.truth_stages.detector,
                        .rate_hz = config.mapper.rate_hz,
                        .visible_share = config.extras.visible_share};
  const RecordConfig to_record{config.scenario, config.simulation, config.truth_detector, config.bag};
  const RecordedDrive drive =
      record_drive(to_record, scene, plan, recording, "scenario " + config.scenario.name,
                   [&](double done, const RecordSummary& so_far) { progress(done, std::to_string(so_far.frames) + " frames recorded"); });
  const std::string command =
      with_words(mapper.command, {{kRecording, recording.string()}, {kOut, out.string()}, {kBoxes, (recording / "boxes.json").string()}});
  result.shell = run_shell(command, base / "stdout.log", base / "stderr.log", mapper.timeout_s, [&](double seconds) {
    progress(1.0, "the mapper runs for " + std::to_string(static_cast<int>(seconds)) + " s");
  });
  result.last_words = last_lines(base / "stderr.log", 5);
  result.truth = drive.truth;
  result.true_trajectory = drive.true_trajectory;
  if (result.shell.timed_out || result.shell.exit_code != 0) return result;

  const fs::path cuboids = out / "cuboids.json", poses = out / "trajectory.tum";
  try {
    if (!is_left(cuboids)) throw Error(cuboids, "is missing though the mapper ended well; expected a list of objects as cuboids.json");
    result.mapped = read_object_list(cuboids);
    for (const ListedObject& object : result.mapped) {
      if (object.cuboid.frame != "world")
        throw Error(cuboids, "its frame is '" + object.cuboid.frame + "'; expected \"world\", the hall's");
    }
  } catch (const Error& error) {
    result.list_problem = error.what();
    return result;
  }
  std::vector<std::pair<Pose, Pose>> pairs;
  try {
    if (is_left(poses)) {
      result.trajectory = read_trajectory(poses);
      pairs = associate_poses(*result.trajectory, {drive.true_trajectory, true});
    }
  } catch (const Error& error) {
    // The objects are scored all the same.
    result.trajectory.reset();
    result.trajectory_problem = error.what();
  }
  result.score = score_of(config, result.shell, drive, result.mapped, result.trajectory, pairs);
  return result;
}

std::string failure_text(const ExternalRunResult& result, const fs::path& shown) {
  const ShellResult& shell = result.shell;
  if (!shell.timed_out && shell.exit_code == 0) return one_line(with_folder(result.list_problem, result.folder, shown));
  char seconds[32];
  std::snprintf(seconds, sizeof seconds, "%g", result.timeout_s);
  std::string text = shell.timed_out
                         ? std::string("the mapper was ended after ") + seconds + " s (external_mapper.timeout_s, --mapper-timeout)"
                         : "the mapper ended with exit code " + std::to_string(shell.exit_code);
  text += ", see " + (shown / "mapper/stderr.log").string();
  if (!result.last_words.empty())
    text += ": " + shortened(one_line(with_folder(result.last_words.back(), result.folder, shown)), kMostOfALine);
  return text;
}

std::string trajectory_text(const ExternalRunResult& result, const fs::path& shown) {
  if (result.trajectory_problem.empty()) return "";
  return one_line("the trajectory is not scored: " + with_folder(result.trajectory_problem, result.folder, shown));
}

void write_external(RunFolder& folder, const RunConfig& config, const ExternalRunResult& result) {
  folder.write("truth.json", truth_json(result.truth));
  folder.write("trajectory_truth.tum", tum_text(result.true_trajectory));
  if (!result.score) return;
  const fs::path out = folder.path() / "mapper/out";
  folder.write("cuboids.json", read_file(out / "cuboids.json"));
  MapScene picture;
  picture.mapped = result.mapped;
  picture.truth = result.truth;
  picture.true_trajectory = result.true_trajectory;
  if (result.trajectory) {
    picture.trajectory = result.trajectory->poses;
    folder.write("trajectory.tum", read_file(out / "trajectory.tum"));
  }
  folder.write_png("topdown.png", draw_from_above(picture, 0.0));
  folder.write("table6.md", table6(result.score->objects, config.scenario.name + ", mapper " + config.external_mapper.command));
  const std::string json = score_json(*result.score);
  write_report(folder.path(), ReportKind::kRun, json);
  folder.write("score.json", json);
  if (!config.external_mapper.keep_recording) remove_recording(folder);
}

void remove_recording(const RunFolder& folder) {
  std::error_code stays;
  fs::remove_all(folder.path() / "mapper/recording", stays);
}

}  // namespace waretwin

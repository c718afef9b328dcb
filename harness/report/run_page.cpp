#include "harness/report/run_page.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <sstream>

#include "core/error.h"
#include "core/files.h"
#include "core/json_text.h"
#include "core/version.h"
#include "harness/pictures/picture_file.h"
#include "harness/report/frame_log.h"
#include "harness/report/page_json.h"
#include "harness/report/page_mesh.h"
#include "harness/report/run_facts.h"
#include "harness/score/table6.h"
#include "harness/score/trajectory_file.h"
#include "harness/score/upright.h"

namespace waretwin {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMaxTriangles = 200'000;
constexpr std::size_t kMaxPoses = 1500, kMaxTimingRows = 1200;
constexpr int kPictureWidth = 1100, kPictureQuality = 85;

const std::array<const char*, 25> kFiles = {
    "score.json",       "table6.md",  "budget.md",         "baseline.md",    "cuboids.json",         "truth.json",
    "map.json",         "map.glb",    "map.ply",           "cloud.ply",      "map.waretwin",         "occupancy.pgm",
    "occupancy.yaml",   "esdf.nrrd",  "octomap.bt",        "trajectory.tum", "trajectory_truth.tum", "trajectory_covariance.csv",
    "detections.jsonl", "timing.csv", "surface_error.ply", "frames.jsonl",   "truth_frames.jsonl",   "topdown.png",
    "config.yaml"};

bool has(const fs::path& file) {
  std::error_code error;
  return fs::is_regular_file(file, error);
}

Json text_or_null(const fs::path& file) { return has(file) ? Json(read_file(file)) : Json(nullptr); }

// `most` of `count` indices, the first and the last among them.
std::vector<std::size_t> spread(std::size_t count, std::size_t most) {
  std::vector<std::size_t> indices;
  if (count <= most) {
    for (std::size_t i = 0; i < count; ++i) indices.push_back(i);
  } else {
    for (std::size_t i = 0; i < most; ++i) indices.push_back(i * (count - 1) / (most - 1));
  }
  return indices;
}

// Returns the stamp that times count from.
Stamp add_paths(PageData& page, const fs::path& folder, const Pose& X_UR) {
  Json& json = page.json;
  if (!has(folder / "trajectory.tum")) return 0;
  // A map of which no frame had a pose has an empty one.
  std::error_code error;
  if (fs::file_size(folder / "trajectory.tum", error) == 0) return 0;
  const std::vector<StampedPose> poses = read_trajectory(folder / "trajectory.tum").poses;
  std::vector<StampedPose> truth;
  if (has(folder / "trajectory_truth.tum")) truth = read_trajectory(folder / "trajectory_truth.tum").poses;
  const bool together = std::equal(truth.begin(), truth.end(), poses.begin(), poses.end(),
                                   [](const StampedPose& a, const StampedPose& b) { return a.stamp == b.stamp; });
  const Stamp start = poses.front().stamp;
  const auto row = [&](const StampedPose& point) {
    const Pose X = X_UR * point.X_WB;
    const Eigen::Vector3d p = X.translation();
    return Json{rounded(to_seconds(point.stamp - start), 3), rounded(p.x(), 4), rounded(p.y(), 4), rounded(p.z(), 4),
                rounded(yaw_of(X), 4)};
  };
  json["path"] = Json::array();
  for (const std::size_t i : spread(poses.size(), kMaxPoses)) json["path"].push_back(row(poses[i]));
  if (truth.empty()) return start;
  json["true_path"] = Json::array();
  for (const std::size_t i : spread(truth.size(), kMaxPoses)) json["true_path"].push_back(row(truth[i]));
  if (!together) return start;
  json["path_error"] = Json::array();
  for (const std::size_t i : spread(poses.size(), kMaxPoses)) {
    const Pose &X = poses[i].X_WB, &X_true = truth[i].X_WB;
    json["path_error"].push_back({rounded(to_seconds(poses[i].stamp - start), 3),
                                  rounded((X.translation() - X_true.translation()).norm(), 5),
                                  rounded(to_degrees(rotation_between(X, X_true)), 4)});
  }
  return start;
}

Json summary_of(const std::string& stage, std::vector<double> values) {
  std::sort(values.begin(), values.end());
  double sum = 0.0;
  for (const double v : values) sum += v;
  const auto at = [&](double share) {
    return values[std::min(values.size() - 1, static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size()))) - 1)];
  };
  return {{"stage", stage},
          {"mean", rounded(sum / static_cast<double>(values.size()), 3)},
          {"median", rounded(at(0.5), 3)},
          {"p95", rounded(at(0.95), 3)},
          {"max", rounded(values.back(), 3)}};
}

void add_timing(PageData& page, const fs::path& folder, Stamp start) {
  const fs::path file = folder / "timing.csv";
  if (!has(file)) return;
  std::istringstream lines(read_file(file));
  std::string line;
  std::getline(lines, line);
  const std::array<const char*, 7> stages = {"simulate", "localise", "detect", "segment", "associate", "integrate", "frame"};
  std::array<std::vector<double>, 7> values;
  std::vector<double> times;
  for (int number = 2; std::getline(lines, line); ++number) {
    std::istringstream cells(line);
    std::string cell;
    std::vector<double> row;
    while (std::getline(cells, cell, ',')) {
      try {
        row.push_back(std::stod(cell));
      } catch (const std::exception&) {
        throw Error(file, number, "'" + cell + "'; expected a number");
      }
    }
    if (row.size() < 9) throw Error(file, number, "has " + std::to_string(row.size()) + " columns; expected at least 9");
    times.push_back(row[1] - to_seconds(start));
    for (std::size_t k = 0; k < values.size(); ++k) values[k].push_back(row[2 + k]);
  }
  if (times.empty()) return;
  Json timing = {{"stages", Json::array()}, {"frames", Json::array()}};
  for (std::size_t k = 0; k < stages.size(); ++k) timing["stages"].push_back(summary_of(stages[k], values[k]));
  for (const std::size_t i : spread(times.size(), kMaxTimingRows)) {
    Json row = {rounded(times[i], 3)};
    for (std::size_t k = 1; k < 6; ++k) row.push_back(rounded(values[k][i], 2));
    timing["frames"].push_back(std::move(row));
  }
  page.json["timing"] = std::move(timing);
}

// The cameras of the frames, in their order.
std::vector<SeeingCamera> add_frames(PageData& page, const fs::path& folder, Stamp start) {
  std::vector<SeeingCamera> cameras;
  std::vector<LoggedFrame> frames = read_frame_log(folder);
  if (frames.empty()) return cameras;
  if (frames.size() > 255) throw Error(folder / "frames.jsonl", std::to_string(frames.size()) + " frames; expected at most 255");
  page.json["frames"] = Json::array();
  for (LoggedFrame& frame : frames) {
    const Intrinsics& k = frame.intrinsics;
    cameras.push_back({frame.X_WC, k.fx, k.fy, k.cx, k.cy, k.width, k.height, std::min(frame.range_m, 8.0)});
    const auto block = [&](const char* kind, std::string& bytes) -> Json {
      if (bytes.empty()) return nullptr;
      const std::string name = "frame." + std::to_string(frame.number) + "." + kind;
      page.blocks[name] = std::move(bytes);
      return name;
    };
    Json detections = Json::array();
    for (const LoggedDetection& d : frame.detections) {
      detections.push_back({{"class", d.class_name},
                            {"score", rounded(d.score, 3)},
                            {"box", {rounded(d.box.x, 1), rounded(d.box.y, 1), rounded(d.box.width, 1), rounded(d.box.height, 1)}},
                            {"map_id", d.map_id}});
    }
    const Json colour = block("colour", frame.colour), depth = block("depth", frame.depth);
    page.json["frames"].push_back({{"frame", frame.number},
                                   {"t_s", rounded(to_seconds(frame.stamp - start), 3)},
                                   {"sensor", frame.sensor},
                                   {"size", {k.width, k.height}},
                                   {"intrinsics", {k.fx, k.fy, k.cx, k.cy}},
                                   {"range_m", frame.range_m},
                                   {"X_WC", pose_json(frame.X_WC)},
                                   {"X_WB", pose_json(frame.X_WB)},
                                   {"detections", std::move(detections)},
                                   {"objects", objects_json(frame.objects)},
                                   {"colour", colour},
                                   {"depth", depth}});
  }
  return cameras;
}

void add_mesh(PageData& page, const fs::path& folder, const Pose& X_UR, const std::vector<SeeingCamera>& cameras) {
  if (!has(folder / "map.ply") || !has(folder / "cloud.ply")) return;
  const PageMesh whole = read_page_mesh(folder);
  if (whole.triangles.empty()) return;
  PageMesh mesh = thinned(whole, kMaxTriangles);
  const Eigen::Isometry3f X = X_UR.cast<float>();
  for (Eigen::Vector3f& p : mesh.vertices) p = X * p;
  std::vector<float> heights;
  for (const Eigen::Vector3f& p : mesh.vertices) heights.push_back(p.z());
  const auto low = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 200);
  std::nth_element(heights.begin(), low, heights.end());
  const PackedMesh bytes = packed(mesh);
  page.json["mesh"] = {{"vertices", mesh.vertices.size()},
                       {"triangles", mesh.triangles.size()},
                       {"of_triangles", whole.triangles.size()},
                       {"low", {bytes.low.x(), bytes.low.y(), bytes.low.z()}},
                       {"step", bytes.step},
                       {"label_ids", bytes.label_ids},
                       {"floor", rounded(static_cast<double>(*low), 3)},
                       {"seen", !cameras.empty()},
                       {"error_step", bytes.errors.empty() ? Json(nullptr) : Json(rounded(static_cast<double>(kErrorStep), 6))}};
  page.blocks["mesh.positions"] = bytes.positions;
  page.blocks["mesh.colours"] = bytes.colours;
  page.blocks["mesh.labels"] = bytes.labels;
  page.blocks["mesh.indices"] = bytes.indices;
  if (!bytes.errors.empty()) page.blocks["mesh.errors"] = bytes.errors;
  if (!cameras.empty()) {
    const std::vector<std::uint8_t> seen = first_seen(mesh, cameras);
    page.blocks["mesh.seen"] = std::string(seen.begin(), seen.end());
  }
}

void add_picture(PageData& page, const fs::path& file, const std::string& name, const std::string& caption) {
  if (!has(file)) return;
  cv::Mat image = cv::imread(file.string(), cv::IMREAD_COLOR);
  if (image.empty()) throw Error(file, "is no picture");
  if (image.cols > kPictureWidth) {
    const double scale = static_cast<double>(kPictureWidth) / image.cols;
    cv::resize(image, image, {}, scale, scale, cv::INTER_AREA);
  }
  page.blocks[name] = encoded_jpeg(image, kPictureQuality);
  page.json["pictures"].push_back({{"caption", caption}, {"block", name}});
}

Json paper_json() {
  Json paper = {{"table6", Json::array()}, {"table4", Json::array()}};
  for (const PaperRow& row : paper_table6()) {
    paper["table6"].push_back({{"id", row.id}, {"iou3d", row.iou3d}, {"e_trans_m", row.e_trans_m}, {"e_rot_deg", row.e_rot_deg}});
  }
  // Zhou et al., Table 4: "Average execution time of each processing module in our proposed system", ms on a CPU and on a GPU.
  const auto row = [&](const char* name, const char* stage, double cpu, double gpu) {
    paper["table4"].push_back({{"name", name}, {"stage", stage}, {"cpu", cpu}, {"gpu", gpu}});
  };
  row("Object Detection", "detect", 725.0, 32.0);
  row("Object Segmentation", "segment", 17.75, 15.0);
  row("Object Association", "associate", 5.22, 5.0);
  row("Object Mapping", "integrate", 299.0, 50.0);
  row("Total", "frame", 1046.97, 102.0);
  return paper;
}

}  // namespace

PageData run_page(const fs::path& folder, const std::string& score) {
  PageData page;
  Json& json = page.json;
  json["schema"] = kPageSchema;
  json["version"] = kVersion;
  json["kind"] = "map";
  for (const char* key : {"title", "subtitle"}) json[key] = "";
  json["facts"] = Json::array();
  json["files"] = Json::array();
  for (const char* key : {"score", "map", "path", "true_path", "path_error", "timing", "mesh"}) json[key] = nullptr;
  json["mapped"] = Json::array();
  json["truth"] = Json::array();
  json["frames"] = Json::array();
  json["pictures"] = Json::array();
  json["paper"] = paper_json();
  json["budget"] = text_or_null(folder / "budget.md");
  json["verdict"] = text_or_null(folder / "baseline.md");

  if (!score.empty() || has(folder / "score.json")) {
    json["score"] = parse_json<Json>(folder / "score.json", score.empty() ? read_file(folder / "score.json") : score, "a score.json");
    json["kind"] = "run";
  } else if (has(folder / "map.json")) {
    json["map"] = parse_json<Json>(folder / "map.json", read_file(folder / "map.json"), "a map.json");
  }
  try {
    add_facts(json);
  } catch (const nlohmann::json::exception& problem) {
    throw Error(folder / (json["score"].is_null() ? "map.json" : "score.json"),
                "is not as waretwin writes it (" + std::string(problem.what()) + ")");
  }
  if (has(folder / "cuboids.json")) json["mapped"] = objects_json(read_object_list(folder / "cuboids.json"));
  if (has(folder / "truth.json")) json["truth"] = objects_json(read_object_list(folder / "truth.json"));
  const Pose X_UR = upright_from_recording(folder);
  const Stamp start = add_paths(page, folder, X_UR);
  add_timing(page, folder, start);
  const std::vector<SeeingCamera> cameras = add_frames(page, folder, start);
  add_mesh(page, folder, X_UR, cameras);
  if (json["mesh"].is_null() && !has(folder / "map.ply") && json["score"].is_null()) json["kind"] = "laser";
  const bool laser = json["kind"] == "laser";
  add_picture(page, folder / "topdown.png", "topdown",
              laser
                  ? "The vehicle's path from above"
                  : "The map from above, with mapped cuboids" + std::string(json["truth"].empty() ? "" : ", true ones") + " and the path");
  add_picture(page, folder / "mesh.png", "oblique", "The mapped mesh, objects in colours of their own");
  // score.json of a run is written after its page.
  for (const char* name : kFiles) {
    if (has(folder / name) || (name == std::string("score.json") && !score.empty())) json["files"].push_back(name);
  }
  return page;
}

}  // namespace waretwin

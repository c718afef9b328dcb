#include "harness/run/run_folder.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files.h"
#include "harness/pictures/picture_file.h"
#include "harness/score/motion_text.h"
#include "harness/score/score_json.h"
#include "harness/score/table6.h"
#include "mapper/integrate/tsdf_volume.h"
#include "mapper/output/map_archive.h"
#include "mapper/output/map_files.h"
#include "mapper/output/octomap_file.h"

namespace waretwin {

namespace {

// Objects of the map in the frame that their cuboids are written in.
ObjectList named_frame(ObjectList objects, const Pose& X_RW) {
  if (X_RW.isApprox(Pose::Identity(), 1e-12)) return objects;
  for (MappedObject& object : objects) object.cuboid.frame = "upright";
  return objects;
}

SurfaceMesh turned(SurfaceMesh mesh, const Pose& X_AW) {
  const Eigen::Isometry3f X = X_AW.cast<float>();
  for (Eigen::Vector3f& p : mesh.vertices) p = X * p;
  for (Eigen::Vector3f& n : mesh.normals) n = X.linear() * n;
  return mesh;
}

std::string upright_json(const Pose& X_RW) {
  nlohmann::ordered_json json;
  json["frame"] = "recording";
  json["X_recording_upright"] = nlohmann::ordered_json::array();
  for (Eigen::Index row = 0; row < 4; ++row) {
    nlohmann::ordered_json values = nlohmann::ordered_json::array();
    for (Eigen::Index column = 0; column < 4; ++column) values.push_back(X_RW.matrix()(row, column));
    json["X_recording_upright"].push_back(values);
  }
  return json.dump(2) + "\n";
}

std::string text(const char* pattern, double value) {
  char buffer[96];
  std::snprintf(buffer, sizeof buffer, pattern, value);
  return buffer;
}

// Height beyond which pictures cut the map off, so that a ceiling does not hide the hall: 2.5 m above the lowest half percent of vertices.
double picture_ceiling(const SurfaceMesh& mesh) {
  constexpr double kHeight = 2.5;
  if (mesh.vertices.empty()) return kHeight;
  std::vector<float> heights;
  for (const Eigen::Vector3f& p : mesh.vertices) heights.push_back(p.z());
  const auto low = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 200);
  std::nth_element(heights.begin(), low, heights.end());
  return static_cast<double>(*low) + kHeight;
}

const std::vector<std::string> kMapFiles = {"cuboids.json",   "map.glb",   "map.ply",        "cloud.ply",  "map.waretwin", "occupancy.pgm",
                                            "occupancy.yaml", "esdf.nrrd", "trajectory.tum", "timing.csv", "config.yaml"};
constexpr const char* kOctomap = "octomap.bt";

std::vector<std::string> map_files(const OutputConfig& output) {
  std::vector<std::string> names = kMapFiles;
  if (output.wants_octomap()) names.emplace_back(kOctomap);
  return names;
}

}  // namespace

RunFolder::RunFolder(const std::filesystem::path& path) : path_(path) {
  make_folder(path);
  for (const char* name : {"score.json", "report.html", "baseline.md"}) remove(name);
}

void RunFolder::remove(const std::string& name) {
  std::error_code error;
  std::filesystem::remove(path_ / name, error);
  if (error) throw Error(path_ / name, "cannot be replaced: " + error.message());
}

std::filesystem::path RunFolder::file(const std::string& name) {
  std::filesystem::path path = path_ / name;
  make_folder(path.parent_path());
  return path;
}

void RunFolder::write(const std::string& name, const std::string& bytes) { write_file(file(name), bytes); }

void RunFolder::write_png(const std::string& name, const cv::Mat& image) { waretwin::write_png(file(name), image); }

void RunFolder::clear(const std::string& name) {
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(path_ / name, error)) {
    const std::string extension = entry.path().extension().string();
    if (entry.is_regular_file() && (extension == ".png" || extension == ".ply" || extension == ".tum"))
      std::filesystem::remove(entry.path(), error);
  }
}

std::string covariance_csv(const std::vector<TrajectoryPoint>& trajectory) {
  std::string csv;
  for (const TrajectoryPoint& point : trajectory) {
    if (!point.covariance) continue;
    const Eigen::Matrix3d& c = *point.covariance;
    char line[200];
    std::snprintf(line, sizeof line, "%.9f,%.4e,%.4e,%.4e,%.4e,%.4e,%.4e\n", to_seconds(point.stamp), c(0, 0), c(0, 1), c(0, 2), c(1, 1),
                  c(1, 2), c(2, 2));
    if (csv.empty()) csv = "stamp_s,xx_m2,xy_m2,x_yaw_m_rad,yy_m2,y_yaw_m_rad,yaw_yaw_rad2\n";
    csv += line;
  }
  return csv;
}

std::string timing_csv(const std::vector<FrameRow>& frames) {
  std::string csv = "frame,stamp_s,simulate_ms,localise_ms,detect_ms,segment_ms,associate_ms,integrate_ms,frame_ms,detections,segmented\n";
  for (const FrameRow& row : frames) {
    const FrameReport& r = row.report;
    char line[256];
    std::snprintf(line, sizeof line, "%d,%.9f,%.3f,%.3f,%.3f,%.3f,%.3f,%.3f,%.3f,%d,%d\n", r.frame_id, to_seconds(r.stamp), row.source_ms,
                  r.localise_ms, r.detect_ms, r.segment_ms, r.associate_ms, r.integrate_ms, r.frame_ms(), r.detections, r.segmented);
    csv += line;
  }
  return csv;
}

// trajectory.tum and, where the localiser knows how far its poses can be trusted, trajectory_covariance.csv. The poses are those of
// frame F on the vehicle, in the recording's world.
void write_trajectory(RunFolder& folder, const ObjectMap& map, const Pose& X_BF) {
  std::vector<StampedPose> trajectory = stamped(map.trajectory);
  for (StampedPose& point : trajectory) point.X_WB = map.X_RW * point.X_WB * X_BF;
  folder.write("trajectory.tum", tum_text(trajectory));
  folder.remove("trajectory_covariance.csv");
  const std::string covariances = covariance_csv(map.trajectory);
  if (!covariances.empty()) folder.write("trajectory_covariance.csv", covariances);
}

std::vector<ReportPicture> write_map(RunFolder& folder, const MappingResult& mapping, MapScene scene, const OutputConfig& output) {
  const ObjectMap& map = mapping.map;
  WARETWIN_CHECK(map.volume != nullptr, "a map has a volume");
  const bool upright = map.X_RW.isApprox(Pose::Identity(), 1e-12);
  const ObjectList objects = named_frame(map.objects, map.X_RW);
  const SurfaceMesh mesh = extract_mesh(*map.volume);
  {
    const SurfaceMesh mesh_R = upright ? mesh : turned(mesh, map.X_RW);
    write_ply(folder.file("map.ply"), mesh_R);
    folder.clear("objects");
    make_folder(folder.path() / "objects");
    write_object_plys(folder.path() / "objects", mesh_R, objects);
    write_cloud_ply(folder.file("cloud.ply"), mesh_R);
  }
  if (!upright) folder.write("upright.json", upright_json(map.X_RW));
  write_map_glb(folder.file("map.glb"), mesh, objects);
  save_map(folder.file("map.waretwin"), objects, *map.volume, map.frames_before + static_cast<int>(map.frames.size()));
  write_occupancy(folder.file("occupancy.pgm"), make_occupancy_grid(*map.volume, OccupancyConfig{}));
  write_distance_field(folder.file("esdf.nrrd"), make_distance_field(*map.volume, DistanceFieldConfig{}));
  if (output.wants_octomap()) {
    write_octomap(folder.file(kOctomap), *map.volume);
  } else {
    folder.remove(kOctomap);
  }
  write_cuboids(folder.file("cuboids.json"), upright ? "world" : "upright", objects);
  write_trajectory(folder, map, Pose::Identity());
  folder.write("timing.csv", timing_csv(mapping.frames));

  const double ceiling = picture_ceiling(mesh);
  scene.mesh = {mesh.vertices, mesh.colours, mesh.triangles};
  scene.labels = mesh.labels;
  std::vector<ReportPicture> pictures;
  pictures.push_back({"The map from above, with mapped cuboids" + std::string(scene.truth.empty() ? "" : ", true ones") + " and the path",
                      draw_from_above(scene, ceiling)});
  folder.write_png("topdown.png", pictures.back().image);
  pictures.push_back({"The mapped mesh, objects in colours of their own", draw_oblique(scene, ceiling)});
  folder.write_png("mesh.png", pictures.back().image);
  folder.clear("frames");
  for (const FramePicture& picture : mapping.pictures) folder.write_png("frames/" + picture.name + ".png", picture.image);
  // The report shows two frames: one early, one late.
  const auto shown = [&](const std::string& kind, const std::string& caption, std::size_t third) {
    std::vector<const FramePicture*> all;
    for (const FramePicture& picture : mapping.pictures) {
      if (picture.name.ends_with(kind)) all.push_back(&picture);
    }
    if (all.empty()) return;
    const FramePicture& picture = *all[all.size() * third / 3];
    pictures.push_back({picture.name + ": " + caption, picture.image});
  };
  for (const std::size_t third : {std::size_t{1}, std::size_t{2}}) {
    shown(".colour", "detections, segmented pixels, mapped cuboids", third);
    shown(".depth", "depth as measured", third);
    shown(".truth", "true objects, their visible (solid) and whole (dashed) boxes", third);
  }
  return pictures;
}

void write_closed_loop(RunFolder& folder, const ClosedLoopResult& result, const OutputConfig& output) {
  const RunScore& score = result.score;
  MapScene scene;
  scene.mapped = result.mapped;
  scene.truth = result.truth;
  scene.trajectory = result.trajectory;
  scene.true_trajectory = result.true_trajectory;
  ReportPage page;
  page.pictures = write_map(folder, result.mapping, std::move(scene), output);
  folder.write("truth.json", truth_json(result.truth));
  folder.write("trajectory_truth.tum", tum_text(result.true_trajectory));
  for (const char* earlier : {"truth_frames.jsonl", "detections.jsonl", "budget.md"}) folder.remove(earlier);
  if (!result.detections.empty()) folder.write("detections.jsonl", result.detections);
  if (!result.truth_frames.empty()) folder.write("truth_frames.jsonl", result.truth_frames);
  for (const char* part : {"truth_poses", "truth_poses/cameras", "truth_poses/lasers"}) folder.clear(part);
  for (const auto& [name, poses] : result.sensor_poses) folder.write("truth_poses/" + name, tum_text(poses));
  folder.write("table6.md", table6(score.objects, score.scenario + ", profile " + score.profile));

  page.title = "waretwin: " + score.scenario;
  page.subtitle = "Profile " + score.profile + ", seed " + std::to_string(score.seed) + ", digest " + score.digest;
  page.score = &score;
  page.mapped = result.mapped;
  page.timing_ms = score.timing_ms;
  std::string stages = "Stages:";
  for (const auto& [stage, maker] : score.stages) stages += " " + stage + " " + maker + ",";
  stages.pop_back();
  page.facts = {stages,
                std::to_string(score.frames_simulated) + " camera frames, " + std::to_string(score.frames_mapped) + " mapped, " +
                    std::to_string(score.frames_dropped) + " dropped to keep the mapping rate",
                text("%.2f times real time", score.realtime_factor) + text(", at most %.0f MB of memory", score.peak_rss_mb)};
  if (score.trajectory && score.trajectory_aligned) {
    page.facts.push_back(text("Trajectory error %.3f m rmse", score.trajectory->ate_rmse_m) +
                         text(", %.3f m at most", score.trajectory->ate_max_m) +
                         text("; %.3f m rmse after SE(3) alignment", score.trajectory_aligned->ate_rmse_m));
  }
  for (const auto& [reason, count] : score.rejected)
    page.facts.push_back("Not segmented: " + reason + ", " + std::to_string(count) + " times");
  if (score.motion) {
    for (const RobotContact& contact : score.motion->contacts) page.facts.push_back("Error: " + contact_text(contact));
  }
  page.files = map_files(output);
  for (const char* name : {"truth.json", "trajectory_truth.tum", "table6.md", "score.json"}) page.files.emplace_back(name);
  if (!result.detections.empty()) page.files.emplace_back("detections.jsonl");
  if (!result.truth_frames.empty()) page.files.emplace_back("truth_frames.jsonl");
  for (const auto& entry : result.sensor_poses) page.files.push_back("truth_poses/" + entry.first);
  folder.write("report.html", report_html(page));
  folder.write("score.json", score_json(score));
}

void write_laser_log(RunFolder& folder, const MappingResult& mapping, const std::string& source, const std::string& profile) {
  for (const std::string& name : kMapFiles) {
    if (name != "config.yaml") folder.remove(name);
  }
  folder.remove(kOctomap);
  write_trajectory(folder, mapping.map, *mapping.X_BL);
  MapScene scene;
  scene.trajectory = stamped(mapping.map.trajectory);
  ReportPage page;
  page.pictures.push_back({"The vehicle's path from above", draw_from_above(scene, 0.0)});
  folder.write_png("topdown.png", page.pictures.back().image);
  page.title = "waretwin: path of " + source;
  page.subtitle = "Profile " + profile + ", digest " + digest_of(mapping.map);
  page.facts = {std::to_string(mapping.map.trajectory.size()) + " scans, no camera: the trajectory alone, as poses of the laser (X_WL)"};
  page.files = {"trajectory.tum", "config.yaml"};
  if (std::filesystem::exists(folder.path() / "trajectory_covariance.csv")) page.files.emplace_back("trajectory_covariance.csv");
  folder.write("report.html", report_html(page));
}

void write_mapping(RunFolder& folder, const MappingResult& mapping, const std::string& source, const std::string& profile,
                   const OutputConfig& output) {
  if (mapping.X_BL) {
    write_laser_log(folder, mapping, source, profile);
    return;
  }
  MapScene scene;
  scene.mapped = listed(mapping.map.objects);
  scene.trajectory = stamped(mapping.map.trajectory);
  ReportPage page;
  page.mapped = scene.mapped;
  page.pictures = write_map(folder, mapping, std::move(scene), output);
  page.title = "waretwin: map of " + source;
  page.subtitle = "Profile " + profile + ", digest " + digest_of(mapping.map);
  page.timing_ms = summarise_stages(mapping.frames);
  page.facts = {std::to_string(mapping.map.frames_seen) + " camera frames, " + std::to_string(mapping.frames.size()) + " mapped, " +
                std::to_string(mapping.map.frames_without_pose) + " without a pose"};
  for (const auto& [reason, count] : mapping.map.rejected)
    page.facts.push_back("Not segmented: " + reason + ", " + std::to_string(count) + " times");
  page.files = map_files(output);
  folder.write("report.html", report_html(page));
}

}  // namespace waretwin

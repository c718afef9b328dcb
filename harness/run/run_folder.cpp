#include "harness/run/run_folder.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files.h"
#include "core/version.h"
#include "harness/pictures/picture_file.h"
#include "harness/report/page_mesh.h"
#include "harness/report/report_file.h"
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

constexpr const char* kOctomap = "octomap.bt";

}  // namespace

RunFolder::RunFolder(const std::filesystem::path& path) : path_(path) {
  // A recording's truth would be taken away as an earlier run's.
  for (const char* of_others : {"recording.yaml", "scenario.yaml", "dataset.yaml"}) {
    if (std::filesystem::exists(path / of_others))
      throw Error(path,
                  "holds " + std::string(of_others) + ", so it is no run's; expected a new name, an empty folder or an earlier run's");
  }
  make_folder(path);
  for (const char* name : {"score.json", "map.json", "report.html", "baseline.md"}) remove(name);
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

void write_map(RunFolder& folder, const MappingResult& mapping, MapScene scene, const OutputConfig& output,
               const std::vector<float>& surface_errors_m) {
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
    folder.remove("surface_error.ply");
    if (!surface_errors_m.empty()) write_surface_errors(folder.path(), mesh_R.vertices, surface_errors_m);
  }
  folder.remove("upright.json");  // of an earlier map, which would turn this one
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
  folder.write_png("topdown.png", draw_from_above(scene, ceiling));
  folder.write_png("mesh.png", draw_oblique(scene, ceiling));
  folder.clear("frames");
  for (const FramePicture& picture : mapping.pictures) folder.write_png("frames/" + picture.name + ".png", picture.image);
  write_frame_log(folder.path(), mapping.kept_frames);
}

void write_closed_loop(RunFolder& folder, const ClosedLoopResult& result, const OutputConfig& output) {
  const RunScore& score = result.score;
  MapScene scene;
  scene.mapped = result.mapped;
  scene.truth = result.truth;
  scene.trajectory = result.trajectory;
  scene.true_trajectory = result.true_trajectory;
  static const std::vector<float> kUnknown;
  write_map(folder, result.mapping, std::move(scene), output, score.surface ? score.surface->distances_m : kUnknown);
  folder.write("truth.json", truth_json(result.truth));
  folder.write("trajectory_truth.tum", tum_text(result.true_trajectory));
  for (const char* earlier : {"truth_frames.jsonl", "detections.jsonl", "budget.md"}) folder.remove(earlier);
  if (!result.detections.empty()) folder.write("detections.jsonl", result.detections);
  if (!result.truth_frames.empty()) folder.write("truth_frames.jsonl", result.truth_frames);
  for (const char* part : {"truth_poses", "truth_poses/cameras", "truth_poses/lasers"}) folder.clear(part);
  for (const auto& [name, poses] : result.sensor_poses) folder.write("truth_poses/" + name, tum_text(poses));
  folder.write("table6.md", table6(score.objects, score.scenario + ", profile " + score.profile));
  const std::string json = score_json(score);
  // A page that cannot be made (a viewer that is none) costs no drive its score.
  std::optional<Error> no_page;
  try {
    write_report(folder.path(), ReportKind::kRun, json);
  } catch (const Error& error) {
    no_page = error;
  }
  folder.write("score.json", json);
  if (no_page) throw Error(folder.path(), "is complete but for its report.html: " + std::string(no_page->what()));
}

// What the page of a map says beside the map itself.
std::string map_json(const MappingResult& mapping, const std::string& source, const std::string& profile) {
  const ObjectMap& map = mapping.map;
  nlohmann::ordered_json json = {
      {"schema", 1}, {"version", kVersion}, {"source", source}, {"profile", profile}, {"digest", digest_of(map)}};
  if (mapping.X_BL) {
    json["scans"] = map.trajectory.size();
  } else {
    json["frames"] = {{"seen", map.frames_seen},
                      {"mapped", map.frames.size()},
                      {"dropped", map.frames_dropped_by_rate},
                      {"without_pose", map.frames_without_pose}};
    json["rejected"] = map.rejected;
  }
  // A recording's name may be in any encoding.
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

void write_laser_log(RunFolder& folder, const MappingResult& mapping, const std::string& source, const std::string& profile) {
  for (const char* name : {"cuboids.json", "map.glb", "map.ply", "cloud.ply", "map.waretwin", "occupancy.pgm", "occupancy.yaml",
                           "esdf.nrrd", "timing.csv", "frames.jsonl", "mesh.png", "surface_error.ply", "upright.json", kOctomap})
    folder.remove(name);
  write_trajectory(folder, mapping.map, *mapping.X_BL);
  MapScene scene;
  scene.trajectory = stamped(mapping.map.trajectory);
  folder.write_png("topdown.png", draw_from_above(scene, 0.0));
  folder.write("map.json", map_json(mapping, source, profile));
  write_report(folder.path(), ReportKind::kRun);
}

void write_mapping(RunFolder& folder, const MappingResult& mapping, const std::string& source, const std::string& profile,
                   const OutputConfig& output) {
  // Of a run that had the folder before: the page would show them as this map's.
  for (const char* of_truth : {"truth.json", "trajectory_truth.tum", "table6.md", "budget.md", "truth_frames.jsonl", "detections.jsonl"})
    folder.remove(of_truth);
  if (mapping.X_BL) {
    write_laser_log(folder, mapping, source, profile);
    return;
  }
  MapScene scene;
  scene.mapped = listed(mapping.map.objects);
  scene.trajectory = stamped(mapping.map.trajectory);
  write_map(folder, mapping, std::move(scene), output);
  folder.write("map.json", map_json(mapping, source, profile));
  write_report(folder.path(), ReportKind::kRun);
}

}  // namespace waretwin

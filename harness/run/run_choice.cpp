#include "harness/run/run_choice.h"

#include "core/error.h"
#include "mapper/detect/boxes_file.h"
#include "mapper/detect/shipped_models.h"

namespace waretwin {

namespace {

bool holds_model(const std::filesystem::path& folder) {
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string extension = entry.path().extension().string();
    if (extension == ".cfg" || extension == ".onnx") return true;
  }
  return false;
}

}  // namespace

MapperConfig chosen_mapper(const std::string& profile, const std::optional<std::string>& detector, std::optional<double> rate_hz) {
  MapperConfig config = MapperConfig::make(profile);
  if (rate_hz) config.rate_hz = *rate_hz;
  if (!detector || *detector == "truth") return config;
  const std::filesystem::path path = *detector;
  if (*detector == "yolo" || *detector == "none") {
    config.detector = *detector;
  } else if (is_boxes(path)) {
    config.detector = "boxes";
    config.boxes = *detector;
  } else if (std::filesystem::is_directory(path) && !holds_model(path)) {
    throw Error(
        "--detector " + *detector +
        ": holds neither a model (one .cfg with .weights, or .onnx) nor boxes (text files called by their stamps); expected one of them");
  } else if (std::filesystem::exists(path) || is_shipped_model(path)) {
    config.detector = "yolo";
    config.model = *detector;
  } else {
    throw Error("--detector " + *detector +
                ": no such file; expected yolo, truth, none, boxes (a JSON file, or a folder of text files), or a model (folder, file or "
                "shipped name)");
  }
  return config;
}

std::optional<std::string> detector_beside(const std::optional<std::string>& named, const std::filesystem::path& folder) {
  if (!named || *named == "truth" || *named == "none" || *named == "yolo" || is_shipped_model(*named)) return named;
  const std::filesystem::path file = folder / *named;
  return std::filesystem::exists(file) ? file.string() : *named;
}

void RunChoice::visit(Fields& f) {
  f("profile", profile, "of the mapper", {.choices = {"best", "paper", "voxbloxpp"}});
  std::string named = detector.value_or("");
  f("detector", named, "as for run --detector; empty: the shipped model");
  detector = named.empty() ? std::nullopt : std::optional(named);
  f("poses", poses, "laser, odometry or truth; empty: as the profile has it", {.choices = {"", "laser", "odometry", "truth"}});
  f("depth", depth, "sensor or truth", {.choices = {"sensor", "truth"}});
  f("association", association, "map or truth", {.choices = {"map", "truth"}});
  f("rate_hz", rate_hz, "frames mapped a second; 0: every frame; null: as the profile has it", {.min = 0, .max = 1000});
  f("frames", frames, "stops after this many camera frames; 0: all", {.min = 0, .max = 1e9});
  f.group("external_mapper", external_mapper, "another mapper in place of ours (docs/mappers.md)");
}

RunConfig chosen_run(const RunChoice& choice) {
  RunConfig config;
  const std::string usual = config.mapper.detector;
  config.mapper = chosen_mapper(choice.profile, choice.detector, choice.rate_hz);
  if (!choice.detector) config.mapper.detector = usual;
  config.truth_stages.detector = choice.detector == "truth";
  config.truth_stages.poses = choice.poses == "truth";
  if (!choice.poses.empty() && choice.poses != "truth") config.mapper.poses = choice.poses;
  config.truth_stages.association = choice.association == "truth";
  config.simulation.truth_depth = choice.depth == "truth";
  config.simulation.max_frames = choice.frames;
  config.resume = choice.resume;
  config.extrinsics = choice.extrinsics;
  config.external_mapper = choice.external_mapper;
  return config;
}

void expect_none_of_ours(const RunChoice& choice) {
  const RunChoice usual;
  const std::string with = ": with another mapper (external_mapper.command) expected ";
  if (choice.profile != usual.profile) throw Error("--profile " + choice.profile + with + "none");
  if (choice.detector && *choice.detector != "truth" && *choice.detector != "none")
    throw Error("--detector " + *choice.detector + with + "truth ({boxes} are then the true ones) or none");
  if (!choice.poses.empty() && choice.poses != "truth")
    throw Error("--poses " + choice.poses + with + "truth (the recording then holds the camera's poses) or none");
  if (choice.association != usual.association) throw Error("--association " + choice.association + with + "none");
}

}  // namespace waretwin

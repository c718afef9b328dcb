#include "harness/run/run_choice.h"

#include "core/error.h"
#include "mapper/detect/shipped_models.h"

namespace waretwin {

MapperConfig chosen_mapper(const std::string& profile, const std::optional<std::string>& detector, std::optional<double> rate_hz) {
  MapperConfig config = MapperConfig::make(profile);
  if (rate_hz) config.rate_hz = *rate_hz;
  if (!detector || *detector == "truth") return config;
  const std::filesystem::path path = *detector;
  if (*detector == "yolo" || *detector == "none") {
    config.detector = *detector;
  } else if (path.extension() == ".json") {
    config.detector = "boxes";
    config.boxes = *detector;
  } else if (std::filesystem::exists(path) || is_shipped_model(path)) {
    config.detector = "yolo";
    config.model = *detector;
  } else {
    throw Error("--detector " + *detector +
                ": no such file; expected yolo, truth, none, a JSON file with boxes, or a model (folder, file or shipped name)");
  }
  return config;
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
  return config;
}

}  // namespace waretwin

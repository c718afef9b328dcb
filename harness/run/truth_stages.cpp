#include "harness/run/truth_stages.h"

#include "harness/truth/truth_associator.h"
#include "harness/truth/truth_localiser.h"

namespace waretwin {

Stages stages_with_truth(const RunConfig& config, const SimulatedStream& stream, const StreamInfo& told) {
  MapperConfig mapper = config.mapper;
  if (config.truth_stages.detector) mapper.detector = "none";
  StreamInfo info = told;
  if (config.truth_stages.poses) {
    // The localiser made here is replaced below: the stream need not have what it would read.
    info.has_odometry = true;
    mapper.poses = "odometry";
  }
  Stages stages = make_stages(mapper, info);
  if (config.truth_stages.detector) stages.detector = std::make_unique<TruthDetector>(stream, config.truth_detector);
  if (config.truth_stages.poses) stages.localiser = std::make_unique<TruthLocaliser>(stream);
  if (config.truth_stages.association) stages.associator = std::make_unique<TruthAssociator>(stream, config.mapper);
  return stages;
}

std::map<std::string, std::string> stage_names(const RunConfig& config, const StreamInfo& info) {
  return {{"detector", config.truth_stages.detector ? "truth" : config.mapper.detector},
          {"poses", config.truth_stages.poses ? "truth" : chosen_poses(config.mapper, info)},
          {"association", config.truth_stages.association ? "truth" : "map"},
          {"depth", config.simulation.truth_depth ? "truth" : "sensor"}};
}

}  // namespace waretwin

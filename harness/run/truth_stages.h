// The mapper's stages for a simulated stream, with the truth in place of those that the configuration names.
#pragma once

#include <map>
#include <string>

#include "harness/run/run_config.h"
#include "mapper/stages.h"
#include "sim/simulated_stream.h"

namespace waretwin {

// `told`: what the mapper is told of the stream, which must outlive the stages. Throws Error as make_stages does.
Stages stages_with_truth(const RunConfig& config, const SimulatedStream& stream, const StreamInfo& told);

// Who makes what: detector, poses, association, depth.
std::map<std::string, std::string> stage_names(const RunConfig& config, const StreamInfo& info);

}  // namespace waretwin

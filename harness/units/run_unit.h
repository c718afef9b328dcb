// What a run's result depends on, by contents.
#pragma once

#include "core/digest.h"
#include "harness/run/run_config.h"

namespace waretwin {

// Adds configuration, scene (digest_of), the detector's files and the map that is gone on from. Their bytes count, not where they lie.
void add_run(const RunConfig& config, const std::string& scene, Digest& digest);

}  // namespace waretwin

// What a run's result depends on, by contents.
#pragma once

#include "core/digest.h"
#include "harness/run/run_config.h"

namespace waretwin {

// Adds configuration, scene (digest_of), the detector's files and the map that is gone on from; of another mapper its command line, and the
// files that external_mapper.depends names. Their bytes count, not where they lie. With our own mapper nothing of external_mapper counts.
// Throws Error for a file that cannot be read.
void add_run(const RunConfig& config, const std::string& scene, Digest& digest);

}  // namespace waretwin

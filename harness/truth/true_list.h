// The true objects of a hall as the scorer compares them: truth.json.
#pragma once

#include <vector>

#include "harness/score/cuboid_file.h"
#include "scenes/scene.h"
#include "sim/visibility.h"

namespace waretwin {

// With the share that `coverage` saw of each; nullptr (a vehicle without cameras): none.
std::vector<ListedObject> true_list(const Scene& scene, const SurfaceCoverage* coverage);

}  // namespace waretwin

// From an object's evidence to its cuboid.
#pragma once

#include <optional>

#include "core/cuboid.h"
#include "mapper/associate/box_views.h"
#include "mapper/associate/evidence_grid.h"

namespace waretwin {

// The upright box of smallest area around the footprint of the filled cells that are the object's: one connected part of them
// above `support_z` (metres; what the object stands on), which `views` tell apart from clutter (evidence_parts.h). A face stands where
// edge_support_m2 of the outline, seen against it, reach it, so that single cells do not push it; the top where top_area of the footprint
// reaches. An object whose cells come near to its support ends there. Frame "world", canonical. Nothing where no cell is the object's.
std::optional<Cuboid> evidence_cuboid(const EvidenceGrid& grid, const BoxViews& views, double support_z, const EvidenceConfig& config);

}  // namespace waretwin

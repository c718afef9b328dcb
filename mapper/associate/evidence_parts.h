// Which of the filled cells of an object's grid are one object.
#pragma once

#include <cstdint>
#include <vector>

#include "mapper/associate/box_views.h"
#include "mapper/associate/evidence_grid.h"

namespace waretwin {

// What a cell is taken for. `other` is filled, too, but not the object's; what lies no higher than the support is `none`.
enum class CellOwner : std::uint8_t { none, object, other };

// Of the object's cells; 0 for none. `owners`: one a cell of the grid, x fastest, then y, then z.
int median_hits(const EvidenceGrid& grid, const std::vector<CellOwner>& owners);

// The object's cells that are connected over gaps of join_m are a part. Makes `none` of those of all parts but the ones that are the object
// (part_choice.h).
void keep_one_object(const EvidenceGrid& grid, std::vector<CellOwner>& owners, const BoxViews& views, const EvidenceConfig& config);

}  // namespace waretwin

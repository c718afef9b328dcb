// Which of the filled cells of an object's grid are one object.
#pragma once

#include <vector>

#include "mapper/associate/evidence_grid.h"

namespace waretwin {

// `mine`: one flag a cell of the grid (x fastest, then y, then z), set where the cell is filled and the object's. Unsets all but the part
// with the most hits, connected over gaps of join_m, and the parts that belong to it across a gap from which rays bring no depth: two rails
// with a dark belt between them.
void keep_one_object(const EvidenceGrid& grid, std::vector<char>& mine, const EvidenceConfig& config);

}  // namespace waretwin

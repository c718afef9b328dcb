// Finding a scan in the local map without a good guess: correlative matching over a window of poses.
#pragma once

#include <optional>
#include <vector>

#include "mapper/localise/local_map.h"

namespace waretwin {

struct SearchWindow {
  PlanarMotion centre;    // X_SB
  double half_m = 0.0;    // x and y within this of the centre
  double half_deg = 0.0;  // heading within this of the centre's
};

struct SearchResult {
  PlanarMotion X_SB;   // to within a cell
  double score = 0.0;  // mean value of the points in [0, 1]
};

// The pose of the window at which the scan's points lie nearest to the map's: highest mean of 1 / (1 + (distance / blur)^2), exact on the
// grid of the search by branch and bound (Olson, "Real-time correlative scan matching", ICRA 2009; Hess et al., ICRA 2016, section V).
// Nothing where the best is below min_score. `bias` is taken off each range. Deterministic, single-threaded.
std::optional<SearchResult> search_map(const LocalMap& map, const std::vector<ScanPoint>& points_B, const SearchWindow& window, double bias,
                                       const MapSearchConfig& config);

// The score of one pose, as search_map counts it but over all points and without the grid. For choosing between guesses.
double pose_score(const LocalMap& map, const std::vector<ScanPoint>& points_B, const PlanarMotion& X_SB, double bias,
                  const MapSearchConfig& config);

}  // namespace waretwin

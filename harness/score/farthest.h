// How far an object in a list may lie and reach. Volumes and distances of larger numbers are no longer finite: readers of lists refuse
// them.
#pragma once

namespace waretwin {

inline constexpr double kFarthest_m = 1e9;

}  // namespace waretwin

// The 256 cases of marching cubes, made from one rule instead of being listed.
//
// Corner i of a cube lies at (i & 1, i >> 1 & 1, i >> 2 & 1); bit i of a case says that corner i is inside (distance < 0). Edge e runs
// along axis e / 4 from corner kEdgeStart[e].
//
// On each face the crossed edges are joined in pairs, around inside corners; where two inside corners lie across from each other, each is
// cut off on its own. Both cubes at a face find the same pairs, so that surfaces close. Joined over the six faces the pairs form loops,
// and a loop is cut into triangles by diagonals that do not lie in a face, where the next cube might draw the same one.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace waretwin {

inline constexpr std::array<int, 12> kEdgeStart = {0, 2, 4, 6, 0, 1, 4, 5, 0, 1, 2, 3};
inline constexpr int edge_axis(int edge) { return edge / 4; }
inline constexpr int edge_end(int edge) { return kEdgeStart[static_cast<std::size_t>(edge)] | 1 << edge_axis(edge); }

// Triangles of a case as three edges each, counter-clockwise seen from outside (distance > 0).
using CubeTriangles = std::vector<std::array<std::uint8_t, 3>>;
const std::array<CubeTriangles, 256>& marching_cubes_table();

}  // namespace waretwin

#include "mapper/integrate/marching_cubes_table.h"

#include <optional>

#include "core/error.h"

namespace waretwin {

namespace {

int edge_between(int a, int b) {
  for (int e = 0; e < 12; ++e) {
    const int start = kEdgeStart[static_cast<std::size_t>(e)], end = edge_end(e);
    if ((start == a && end == b) || (start == b && end == a)) return e;
  }
  WARETWIN_CHECK(false, "corners without a common edge");
  return -1;
}

// Corners of a face (side 0 or 1 of an axis), counter-clockwise seen from outside the cube.
std::array<int, 4> face_corners(int axis, int side) {
  const int a = 1 << (axis + 1) % 3, b = 1 << (axis + 2) % 3, base = side << axis;
  if (side == 1) return {base, base | a, base | a | b, base | b};
  return {base, base | b, base | a | b, base | a};
}

bool share_face(int e, int f) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {0, 1}) {
      const auto on_face = [&](int edge) {
        return (kEdgeStart[static_cast<std::size_t>(edge)] >> axis & 1) == side && (edge_end(edge) >> axis & 1) == side;
      };
      if (on_face(e) && on_face(f)) return true;
    }
  }
  return false;
}

// Cuts the part first..last of a loop, closed by the diagonal between the two, into triangles without a diagonal in a face.
std::optional<CubeTriangles> cut(const std::vector<int>& loop, std::size_t first, std::size_t last) {
  if (last - first < 2) return CubeTriangles{};
  const auto allowed = [&](std::size_t a, std::size_t b) { return b - a < 2 || !share_face(loop[a], loop[b]); };
  for (std::size_t tip = first + 1; tip < last; ++tip) {
    if (!allowed(first, tip) || !allowed(tip, last)) continue;
    auto left = cut(loop, first, tip), right = cut(loop, tip, last);
    if (!left || !right) continue;
    left->push_back({static_cast<std::uint8_t>(loop[first]), static_cast<std::uint8_t>(loop[tip]), static_cast<std::uint8_t>(loop[last])});
    left->insert(left->end(), right->begin(), right->end());
    return left;
  }
  return std::nullopt;
}

CubeTriangles make_case(int inside) {
  const auto is_inside = [&](int corner) { return (inside >> corner & 1) != 0; };
  // next[e]: the edge that follows e on its loop, with the outside to the surface's upper side.
  std::array<int, 12> next;
  next.fill(-1);
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {0, 1}) {
      const std::array<int, 4> corners = face_corners(axis, side);
      for (std::size_t i = 0; i < 4; ++i) {
        // A run of inside corners that begins here: the pair goes from the edge where it is left to the edge where it was entered.
        const int before = corners[(i + 3) % 4];
        if (!is_inside(corners[i]) || is_inside(before)) continue;
        std::size_t last = i;
        while (is_inside(corners[(last + 1) % 4])) ++last;
        next[static_cast<std::size_t>(edge_between(before, corners[i]))] = edge_between(corners[last % 4], corners[(last + 1) % 4]);
      }
    }
  }
  CubeTriangles triangles;
  for (int start = 0; start < 12; ++start) {
    std::vector<int> loop;
    for (int e = start; next[static_cast<std::size_t>(e)] >= 0;) {
      loop.push_back(e);
      const int following = next[static_cast<std::size_t>(e)];
      next[static_cast<std::size_t>(e)] = -1;
      e = following;
    }
    if (loop.empty()) continue;
    const auto cut_loop = cut(loop, 0, loop.size() - 1);
    WARETWIN_CHECK(cut_loop.has_value(), "a loop that cannot be cut");
    triangles.insert(triangles.end(), cut_loop->begin(), cut_loop->end());
  }
  return triangles;
}

}  // namespace

const std::array<CubeTriangles, 256>& marching_cubes_table() {
  static const std::array<CubeTriangles, 256> table = [] {
    std::array<CubeTriangles, 256> cases;
    for (int inside = 0; inside < 256; ++inside) cases[static_cast<std::size_t>(inside)] = make_case(inside);
    return cases;
  }();
  return table;
}

}  // namespace waretwin

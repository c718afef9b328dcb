#include "mapper/integrate/mesher.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <set>

#include "core/error.h"
#include "core/parallel.h"
#include "mapper/integrate/marching_cubes_table.h"

namespace waretwin {

namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

// Distances of a block and of one layer around it (two on the upper sides, for the normals there); NaN where there is no surface.
class Neighbourhood {
 public:
  static constexpr int kLow = -1, kHigh = 9, kSpan = kHigh - kLow + 1;

  Neighbourhood(const TsdfVolume& volume, const TsdfBlock& centre) {
    for (int i = 0; i < 27; ++i) {
      const Eigen::Vector3i step(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
      blocks_[static_cast<std::size_t>(i)] = i == 13 ? &centre : volume.find_block(centre.index + step);
    }
    std::size_t at = 0;
    for (int z = kLow; z <= kHigh; ++z) {
      for (int y = kLow; y <= kHigh; ++y) {
        for (int x = kLow; x <= kHigh; ++x, ++at) {
          const TsdfBlock* block = block_at(x, y, z);
          const int offset = TsdfVolume::offset(x & 7, y & 7, z & 7);
          const bool has = block && volume.has_surface(*block, offset);
          distances_[at] = has ? block->surface->voxels[static_cast<std::size_t>(offset)].distance : kNone;
        }
      }
    }
  }
  float at(int x, int y, int z) const {
    return distances_[static_cast<std::size_t>((x - kLow) + kSpan * ((y - kLow) + kSpan * (z - kLow)))];
  }
  float at(const Eigen::Vector3i& p) const { return at(p.x(), p.y(), p.z()); }
  const TsdfBlock* block_at(int x, int y, int z) const {
    return blocks_[static_cast<std::size_t>(((x >> 3) + 1) + 3 * (((y >> 3) + 1) + 3 * ((z >> 3) + 1)))];
  }

  // Per voxel; over two voxels where both neighbours are known, over one where one is.
  Eigen::Vector3f gradient(const Eigen::Vector3i& p) const {
    Eigen::Vector3f g = Eigen::Vector3f::Zero();
    const float here = at(p);
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3i step = Eigen::Vector3i::Unit(k);
      const float low = at(p - step), high = at(p + step);
      if (!std::isnan(low) && !std::isnan(high)) {
        g[k] = 0.5f * (high - low);
      } else if (!std::isnan(high)) {
        g[k] = high - here;
      } else if (!std::isnan(low)) {
        g[k] = here - low;
      }
    }
    return g;
  }

 private:
  std::array<const TsdfBlock*, 27> blocks_;
  std::array<float, static_cast<std::size_t>(kSpan* kSpan* kSpan)> distances_;
};

// Which edges of a block's voxels carry a vertex: bit axis * 512 + offset of the edge's lower voxel; and how many come before.
struct CrossedEdges {
  std::array<std::uint64_t, 24> bits{};
  std::array<std::uint16_t, 24> before{};
  int count = 0;

  void set(int axis, int offset) { bits[word(axis, offset)] |= std::uint64_t{1} << (offset & 63); }
  void close() {
    count = 0;
    for (std::size_t i = 0; i < bits.size(); ++i) {
      before[i] = static_cast<std::uint16_t>(count);
      count += std::popcount(bits[i]);
    }
  }
  std::uint32_t rank(int axis, int offset) const {
    const std::size_t i = word(axis, offset);
    return before[i] + static_cast<std::uint32_t>(std::popcount(bits[i] & ((std::uint64_t{1} << (offset & 63)) - 1)));
  }

 private:
  static std::size_t word(int axis, int offset) { return static_cast<std::size_t>(axis * 8 + offset / 64); }
};

// A cube with a surface in it: its lowest voxel and its case. 0 where it makes no triangle.
int cube_case(const Neighbourhood& near, int x, int y, int z, float largest_step) {
  std::array<float, 8> d;
  int inside = 0;
  for (int c = 0; c < 8; ++c) {
    const float distance = near.at(x + (c & 1), y + (c >> 1 & 1), z + (c >> 2 & 1));
    if (std::isnan(distance)) return 0;
    d[static_cast<std::size_t>(c)] = distance;
    inside |= (distance < 0.0f) << c;
  }
  if (inside == 0 || inside == 255) return 0;
  for (int e = 0; e < 12; ++e) {
    const float a = d[static_cast<std::size_t>(kEdgeStart[static_cast<std::size_t>(e)])], b = d[static_cast<std::size_t>(edge_end(e))];
    if ((a < 0.0f) != (b < 0.0f) && std::abs(a - b) > largest_step) return 0;
  }
  return inside;
}

class Meshing {
 public:
  explicit Meshing(const TsdfVolume& volume) : volume_(volume), largest_step_(static_cast<float>(volume.truncation_m())) {
    for (const std::size_t b : volume.sorted_positions()) {
      if (volume.block(b).surface) order_.push_back(b);
    }
    rank_of_block_.assign(volume.size(), kNoRank);
    for (std::size_t i = 0; i < order_.size(); ++i) rank_of_block_[order_[i]] = i;
    for (std::size_t b = 0; b < volume.size(); ++b) position_of_[&volume.block(b)] = b;
  }

  SurfaceMesh run() {
    std::vector<std::vector<Cube>> cubes(order_.size());
    std::vector<CrossedEdges> edges(order_.size());
    // A cube's upper edges belong to the neighbours' voxels, so that vertices are counted once all cubes are known.
    for_each_block([&](std::size_t i, const TsdfBlock& block) { cubes[i] = find_cubes(block); });
    mark_edges(cubes, edges);
    std::vector<std::uint32_t> first_vertex(order_.size() + 1, 0), first_triangle(order_.size() + 1, 0);
    for (std::size_t i = 0; i < order_.size(); ++i) {
      edges[i].close();
      first_vertex[i + 1] = first_vertex[i] + static_cast<std::uint32_t>(edges[i].count);
      std::size_t triangles = 0;
      for (const Cube& cube : cubes[i]) triangles += marching_cubes_table()[cube.inside].size();
      first_triangle[i + 1] = first_triangle[i] + static_cast<std::uint32_t>(triangles);
    }
    SurfaceMesh mesh;
    mesh.vertices.resize(first_vertex.back());
    mesh.normals.resize(first_vertex.back());
    mesh.colours.resize(first_vertex.back());
    mesh.labels.resize(first_vertex.back());
    mesh.triangles.resize(first_triangle.back());
    for_each_block([&](std::size_t i, const TsdfBlock& block) {
      if (edges[i].count > 0) place_vertices(block, edges[i], first_vertex[i], mesh);
      std::size_t at = first_triangle[i];
      const std::array<Owner, 8> owners = owners_around(block);
      for (const Cube& cube : cubes[i]) {
        for (const auto& triangle : marching_cubes_table()[cube.inside]) {
          auto& out = mesh.triangles[at++];
          for (std::size_t k = 0; k < 3; ++k) {
            const auto [owner, axis, offset] = edge_place(cube.offset, triangle[k]);
            const std::size_t rank = owners[static_cast<std::size_t>(owner)].rank;
            out[k] = first_vertex[rank] + edges[rank].rank(axis, offset);
          }
        }
      }
    });
    return mesh;
  }

 private:
  static constexpr std::size_t kNoRank = std::numeric_limits<std::size_t>::max();
  struct Cube {
    std::uint16_t offset;  // of its lowest voxel
    std::uint8_t inside;   // case
  };
  struct Owner {
    std::size_t rank = kNoRank;  // in order_
  };
  struct EdgePlace {
    int owner;  // bit k: the neighbour one up on axis k
    int axis, offset;
  };

  template <class Body>
  void for_each_block(Body&& body) const {
    parallel_for(order_.size(), 16, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) body(i, volume_.block(order_[i]));
    });
  }

  static EdgePlace edge_place(int cube_offset, int edge) {
    const int start = kEdgeStart[static_cast<std::size_t>(edge)];
    const int x = (cube_offset & 7) + (start & 1), y = (cube_offset >> 3 & 7) + (start >> 1 & 1), z = (cube_offset >> 6) + (start >> 2 & 1);
    return {x >> 3 | (y >> 3) << 1 | (z >> 3) << 2, edge_axis(edge), TsdfVolume::offset(x & 7, y & 7, z & 7)};
  }

  std::array<Owner, 8> owners_around(const TsdfBlock& block) const {
    std::array<Owner, 8> owners;
    for (int i = 0; i < 8; ++i) {
      const TsdfBlock* owner = volume_.find_block(block.index + Eigen::Vector3i(i & 1, i >> 1 & 1, i >> 2));
      if (owner) owners[static_cast<std::size_t>(i)].rank = rank_of_block_[position_of_.at(owner)];
    }
    return owners;
  }

  std::vector<Cube> find_cubes(const TsdfBlock& block) const {
    std::vector<Cube> cubes;
    const Neighbourhood near(volume_, block);
    for (int offset = 0; offset < TsdfVolume::kVoxels; ++offset) {
      const int inside = cube_case(near, offset & 7, offset >> 3 & 7, offset >> 6, largest_step_);
      if (inside != 0) cubes.push_back({static_cast<std::uint16_t>(offset), static_cast<std::uint8_t>(inside)});
    }
    return cubes;
  }

  void mark_edges(const std::vector<std::vector<Cube>>& cubes, std::vector<CrossedEdges>& edges) const {
    for (std::size_t i = 0; i < order_.size(); ++i) {
      if (cubes[i].empty()) continue;
      const std::array<Owner, 8> owners = owners_around(volume_.block(order_[i]));
      for (const Cube& cube : cubes[i]) {
        for (int e = 0; e < 12; ++e) {
          const int start = kEdgeStart[static_cast<std::size_t>(e)];
          if ((cube.inside >> start & 1) == (cube.inside >> edge_end(e) & 1)) continue;
          const auto [owner, axis, offset] = edge_place(cube.offset, e);
          edges[owners[static_cast<std::size_t>(owner)].rank].set(axis, offset);
        }
      }
    }
  }

  void place_vertices(const TsdfBlock& block, const CrossedEdges& edges, std::uint32_t first, SurfaceMesh& mesh) const {
    const Neighbourhood near(volume_, block);
    const auto voxel_m = static_cast<float>(volume_.voxel_m());
    std::size_t at = first;
    for (std::size_t w = 0; w < edges.bits.size(); ++w) {
      for (std::uint64_t bits = edges.bits[w]; bits != 0; bits &= bits - 1, ++at) {
        const int axis = static_cast<int>(w) / 8, offset = static_cast<int>(w % 8) * 64 + std::countr_zero(bits);
        const Eigen::Vector3i a(offset & 7, offset >> 3 & 7, offset >> 6), b = a + Eigen::Vector3i::Unit(axis);
        const float da = near.at(a), db = near.at(b);
        const float t = da / (da - db);
        Eigen::Vector3d p = (8 * block.index + a).cast<double>().array() + 0.5;
        p[axis] += static_cast<double>(t);
        mesh.vertices[at] = (p * volume_.voxel_m()).cast<float>();

        Eigen::Vector3f normal = (1.0f - t) * near.gradient(a) + t * near.gradient(b);
        if (!(normal.norm() > 1e-6f * voxel_m)) normal = Eigen::Vector3f::Unit(axis) * (da < db ? 1.0f : -1.0f);
        mesh.normals[at] = normal.normalized();

        const TsdfVoxel& va = voxel(near, a);
        const TsdfVoxel& vb = voxel(near, b);
        for (std::size_t k = 0; k < 3; ++k) {
          const float ca = va.colour[k], cb = vb.colour[k];
          mesh.colours[at][k] = static_cast<std::uint8_t>(ca + t * (cb - ca) + 0.5f);
        }
        const Eigen::Vector3i& nearest = t <= 0.5f ? a : b;
        const TsdfBlock* owner = near.block_at(nearest.x(), nearest.y(), nearest.z());
        mesh.labels[at] = owner->surface->labels.best(TsdfVolume::offset_of(nearest));
      }
    }
  }

  static const TsdfVoxel& voxel(const Neighbourhood& near, const Eigen::Vector3i& p) {
    return near.block_at(p.x(), p.y(), p.z())->surface->voxels[static_cast<std::size_t>(TsdfVolume::offset_of(p))];
  }

  const TsdfVolume& volume_;
  float largest_step_;
  std::vector<std::size_t> order_;          // positions of blocks with a surface, sorted
  std::vector<std::size_t> rank_of_block_;  // by position
  std::unordered_map<const TsdfBlock*, std::size_t> position_of_;
};

}  // namespace

SurfaceMesh extract_mesh(const TsdfVolume& volume) { return Meshing(volume).run(); }

std::int32_t triangle_label(const SurfaceMesh& mesh, std::size_t triangle) {
  const auto& t = mesh.triangles[triangle];
  const std::int32_t a = mesh.labels[t[0]], b = mesh.labels[t[1]], c = mesh.labels[t[2]];
  if (a == b || a == c) return a;
  return b == c ? b : std::min({a, b, c});
}

std::vector<std::pair<std::int32_t, SurfaceMesh>> split_by_label(const SurfaceMesh& mesh) {
  std::vector<std::int32_t> label_of(mesh.triangles.size());
  std::set<std::int32_t> labels;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    label_of[i] = triangle_label(mesh, i);
    labels.insert(label_of[i]);
  }
  std::vector<std::pair<std::int32_t, SurfaceMesh>> parts;
  for (const std::int32_t label : labels) parts.emplace_back(label, SurfaceMesh());
  constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
  // A vertex on the border of two parts goes into both; `newest` holds its number in the part that used it last.
  std::vector<std::pair<std::int32_t, std::uint32_t>> newest(mesh.vertices.size(), {0, kUnused});
  for (auto& [label, part] : parts) {
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      if (label_of[i] != label) continue;
      auto& out = part.triangles.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t v = mesh.triangles[i][k];
        if (newest[v].second == kUnused || newest[v].first != label) {
          newest[v] = {label, static_cast<std::uint32_t>(part.vertices.size())};
          part.vertices.push_back(mesh.vertices[v]);
          part.normals.push_back(mesh.normals[v]);
          part.colours.push_back(mesh.colours[v]);
          part.labels.push_back(mesh.labels[v]);
        }
        out[k] = newest[v].second;
      }
    }
  }
  return parts;
}

SurfaceMesh object_mesh(const SurfaceMesh& mesh, std::int32_t label) {
  for (auto& [part_label, part] : split_by_label(mesh)) {
    if (part_label == label) return std::move(part);
  }
  return {};
}

}  // namespace waretwin

#include "harness/report/page_mesh.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <unordered_map>

#include "core/error.h"

namespace waretwin {

namespace {

static_assert(std::endian::native == std::endian::little, "packed meshes are as the memory holds them");

struct Cell {
  std::array<std::int32_t, 3> place;
  std::int32_t label;
  bool operator==(const Cell&) const = default;
};

struct CellHash {
  std::size_t operator()(const Cell& cell) const {
    std::uint64_t h = 0x9e3779b97f4a7c15ull;
    for (const std::int32_t v : {cell.place[0], cell.place[1], cell.place[2], cell.label}) {
      h = (h ^ static_cast<std::uint32_t>(v)) * 0xbf58476d1ce4e5b9ull;
      h ^= h >> 31;
    }
    return static_cast<std::size_t>(h);
  }
};

struct TriangleHash {
  std::size_t operator()(const std::array<std::uint32_t, 3>& t) const {
    std::uint64_t h = 0x9e3779b97f4a7c15ull;
    for (const std::uint32_t v : t) {
      h = (h ^ v) * 0xbf58476d1ce4e5b9ull;
      h ^= h >> 29;
    }
    return static_cast<std::size_t>(h);
  }
};

PageMesh clustered(const PageMesh& mesh, float cell_m) {
  struct Sum {
    Eigen::Vector3d p = Eigen::Vector3d::Zero();
    std::array<std::uint64_t, 3> colour{};
    double error = 0.0;
    std::uint64_t count = 0;
  };
  std::unordered_map<Cell, std::uint32_t, CellHash> cells;
  std::vector<Sum> sums;
  std::vector<std::uint32_t> cluster(mesh.vertices.size());
  PageMesh result;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3f& p = mesh.vertices[i];
    Cell cell{{}, mesh.labels[i]};
    for (int k = 0; k < 3; ++k) cell.place[static_cast<std::size_t>(k)] = static_cast<std::int32_t>(std::floor(p[k] / cell_m));
    const auto [entry, is_new] = cells.try_emplace(cell, static_cast<std::uint32_t>(sums.size()));
    if (is_new) {
      sums.emplace_back();
      result.labels.push_back(mesh.labels[i]);
    }
    cluster[i] = entry->second;
    Sum& sum = sums[entry->second];
    sum.p += p.cast<double>();
    for (std::size_t c = 0; c < 3; ++c) sum.colour[c] += mesh.colours[i][c];
    if (!mesh.errors.empty()) sum.error += static_cast<double>(mesh.errors[i]);
    ++sum.count;
  }
  for (const Sum& sum : sums) {
    result.vertices.push_back((sum.p / static_cast<double>(sum.count)).cast<float>());
    std::array<std::uint8_t, 3> colour{};
    for (std::size_t c = 0; c < 3; ++c) colour[c] = static_cast<std::uint8_t>((sum.colour[c] + sum.count / 2) / sum.count);
    result.colours.push_back(colour);
    if (!mesh.errors.empty()) result.errors.push_back(static_cast<float>(sum.error / static_cast<double>(sum.count)));
  }
  std::unordered_map<std::array<std::uint32_t, 3>, bool, TriangleHash> known;
  for (const auto& triangle : mesh.triangles) {
    std::array<std::uint32_t, 3> t = {cluster[triangle[0]], cluster[triangle[1]], cluster[triangle[2]]};
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    std::array<std::uint32_t, 3> key = t;
    std::sort(key.begin(), key.end());
    if (known.try_emplace(key, true).second) result.triangles.push_back(t);
  }
  return result;
}

template <class T>
void append(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace

PageMesh thinned(const PageMesh& mesh, std::size_t max_triangles) {
  if (mesh.triangles.size() <= max_triangles) return mesh;
  Eigen::Vector3f low = mesh.vertices.front(), high = low;
  for (const Eigen::Vector3f& p : mesh.vertices) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  double area = 0.0;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3f a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
    area += 0.5 * static_cast<double>((b - a).cross(c - a).norm());
  }
  // A surface crosses cells of side s about once per s^2, with two triangles each: a first guess, then as much coarser as it takes.
  float cell = static_cast<float>(std::sqrt(2.0 * area / static_cast<double>(std::max<std::size_t>(max_triangles, 1))));
  cell = std::max(cell, 1e-4f * std::max(1e-3f, (high - low).maxCoeff()));
  while (true) {
    PageMesh result = clustered(mesh, cell);
    if (result.triangles.size() <= max_triangles) return result;
    const double excess = static_cast<double>(result.triangles.size()) / static_cast<double>(std::max<std::size_t>(max_triangles, 1));
    cell *= std::max(1.05f, static_cast<float>(std::sqrt(excess)) * 1.01f);
  }
}

PackedMesh packed(const PageMesh& mesh) {
  PackedMesh result;
  if (mesh.vertices.empty()) return result;
  Eigen::Vector3f low = mesh.vertices.front(), high = low;
  for (const Eigen::Vector3f& p : mesh.vertices) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  result.low = low;
  result.step = std::max((high - low).maxCoeff() / 65535.0f, 1e-6f);
  result.label_ids = mesh.labels;
  std::sort(result.label_ids.begin(), result.label_ids.end());
  result.label_ids.erase(std::unique(result.label_ids.begin(), result.label_ids.end()), result.label_ids.end());
  if (result.label_ids.size() > 65536)
    throw Error("the map has " + std::to_string(result.label_ids.size()) + " labels; a page holds 65536");
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const float number = std::round((mesh.vertices[i][k] - low[k]) / result.step);
      append(result.positions, static_cast<std::uint16_t>(std::clamp(number, 0.0f, 65535.0f)));
    }
    append(result.colours, mesh.colours[i]);
    const auto label = std::lower_bound(result.label_ids.begin(), result.label_ids.end(), mesh.labels[i]);
    append(result.labels, static_cast<std::uint16_t>(label - result.label_ids.begin()));
    if (!mesh.errors.empty())
      append(result.errors, static_cast<std::uint8_t>(std::clamp(std::round(mesh.errors[i] / kErrorStep), 0.0f, 255.0f)));
  }
  const bool small = mesh.vertices.size() <= 65536;
  for (const auto& t : mesh.triangles) {
    for (const std::uint32_t v : t) small ? append(result.indices, static_cast<std::uint16_t>(v)) : append(result.indices, v);
  }
  return result;
}

std::vector<std::uint8_t> first_seen(const PageMesh& mesh, const std::vector<SeeingCamera>& cameras) {
  constexpr int kAcross = 64;       // cells of the coarse image
  constexpr float kBehind = 0.15f;  // metres: what is this much behind the nearest in its cell may still be the same surface
  constexpr float kSlope = 0.10f;   // and this share of the distance
  WARETWIN_CHECK(cameras.size() <= 255, "a byte counts the cameras");
  std::vector<std::uint8_t> seen(mesh.vertices.size(), 255);
  std::vector<float> nearest;
  std::vector<std::pair<std::int32_t, float>> cells(mesh.vertices.size());
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    const SeeingCamera& camera = cameras[c];
    if (camera.width <= 0 || camera.height <= 0) continue;
    const Eigen::Isometry3f X_CW = camera.X_WC.inverse().cast<float>();
    const int down = std::max(1, kAcross * camera.height / camera.width);
    nearest.assign(static_cast<std::size_t>(kAcross * down), std::numeric_limits<float>::infinity());
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
      cells[i].first = -1;
      const Eigen::Vector3f p = X_CW * mesh.vertices[i];
      if (p.z() < 0.1f || p.z() > static_cast<float>(camera.range_m)) continue;
      const double u = camera.fx * p.x() / p.z() + camera.cx, v = camera.fy * p.y() / p.z() + camera.cy;
      if (u < 0.0 || v < 0.0 || u >= camera.width || v >= camera.height) continue;
      const int x = std::min(kAcross - 1, static_cast<int>(u * kAcross / camera.width));
      const int y = std::min(down - 1, static_cast<int>(v * down / camera.height));
      cells[i] = {y * kAcross + x, p.z()};
      float& z = nearest[static_cast<std::size_t>(cells[i].first)];
      z = std::min(z, p.z());
    }
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
      if (cells[i].first < 0 || seen[i] != 255) continue;
      const float z = nearest[static_cast<std::size_t>(cells[i].first)];
      if (cells[i].second <= z * (1.0f + kSlope) + kBehind) seen[i] = static_cast<std::uint8_t>(c);
    }
  }
  // What no kept frame shows (one in between saw it, or an earlier drive) is there at the end.
  if (!cameras.empty()) std::replace(seen.begin(), seen.end(), std::uint8_t{255}, static_cast<std::uint8_t>(cameras.size() - 1));
  return seen;
}

}  // namespace waretwin

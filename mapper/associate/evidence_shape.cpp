#include "mapper/associate/evidence_shape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "mapper/associate/evidence_parts.h"

namespace waretwin {

namespace {

// A ray that ends in the object ends in its box, whatever the view; one that ends in something else may, if that stands near the
// object: being seen outside says more.
bool is_object(const EvidenceCell& cell, const EvidenceConfig& config) {
  return cell.object > 0 && cell.object > config.outside_weight * cell.other && cell.hits() >= cell.passed;
}

std::vector<CellOwner> owners_of(const EvidenceGrid& grid, double support_z, const EvidenceConfig& config) {
  const Eigen::Vector3i n = grid.size();
  const double lowest = support_z + config.foot_clearance_m;
  std::vector<CellOwner> owners(static_cast<std::size_t>(n.x()) * static_cast<std::size_t>(n.y()) * static_cast<std::size_t>(n.z()),
                                CellOwner::none);
  std::size_t i = 0;
  for (int z = 0; z < n.z(); ++z) {
    const double bottom = grid.origin().z() + z * grid.cell_size().z();
    for (int y = 0; y < n.y(); ++y) {
      for (int x = 0; x < n.x(); ++x, ++i) {
        const EvidenceCell& cell = grid.cell(x, y, z);
        if (is_object(cell, config)) {
          if (bottom + cell.z_sum / cell.object > lowest) owners[i] = CellOwner::object;
        } else if (cell.hits() >= std::max<int>(config.min_hits, cell.passed) && bottom > lowest) {
          owners[i] = CellOwner::other;
        }
      }
    }
  }
  const int middle = median_hits(grid, owners);
  const int fewest = std::max(std::min(config.min_hits, middle), static_cast<int>(config.min_hits_share * middle));
  i = 0;
  for (int z = 0; z < n.z(); ++z) {
    for (int y = 0; y < n.y(); ++y) {
      for (int x = 0; x < n.x(); ++x, ++i) {
        if (owners[i] == CellOwner::object && grid.cell(x, y, z).hits() < fewest) owners[i] = CellOwner::none;
      }
    }
  }
  return owners;
}

constexpr double kSkirt = 0.05;  // metres

struct OutlineCell {
  Eigen::Vector2d centre;
  int z;  // slice
};

struct Outline {
  std::vector<OutlineCell> border;  // cells of each slice with an empty neighbour in it
  std::vector<double> tops;         // height of each column, metres
  double lowest = std::numeric_limits<double>::infinity();
};

Outline outline_of(const EvidenceGrid& grid, const std::vector<CellOwner>& owners, const EvidenceConfig& config) {
  const Eigen::Vector3i n = grid.size();
  const auto plane = static_cast<std::size_t>(n.x()) * static_cast<std::size_t>(n.y());
  const auto is_mine = [&](int x, int y, int z) {
    return x >= 0 && y >= 0 && x < n.x() && y < n.y() &&
           owners[static_cast<std::size_t>(z) * plane + static_cast<std::size_t>(y) * static_cast<std::size_t>(n.x()) +
                  static_cast<std::size_t>(x)] == CellOwner::object;
  };
  Outline outline;
  const double slice = grid.cell_size().z();
  for (int y = 0; y < n.y(); ++y) {
    for (int x = 0; x < n.x(); ++x) {
      int top = -1;
      for (int z = n.z() - 1; z >= 0; --z) {
        if (!is_mine(x, y, z)) continue;
        top = std::max(top, z);
        outline.lowest = std::min(outline.lowest, grid.origin().z() + z * slice);
        if (is_mine(x - 1, y, z) && is_mine(x + 1, y, z) && is_mine(x, y - 1, z) && is_mine(x, y + 1, z)) continue;
        outline.border.push_back(
            {{grid.origin().x() + (x + 0.5) * grid.cell_size().x(), grid.origin().y() + (y + 0.5) * grid.cell_size().y()}, z});
      }
      if (top < 0) continue;
      // Noise spreads a surface over slices: all that it reaches make its height, but not what lies below it.
      constexpr double kOneSurface = 0.01;
      const EvidenceCell& highest = grid.cell(x, y, top);
      const double height = grid.origin().z() + top * slice + highest.z_sum / highest.object;
      double sum = 0.0;
      int count = 0;
      for (int z = std::max(0, top - 1); z <= std::min(n.z() - 1, top + 1); ++z) {
        const EvidenceCell& cell = grid.cell(x, y, z);
        if (!is_object(cell, config)) continue;
        const double bottom = grid.origin().z() + z * slice;
        if (std::abs(bottom + cell.z_sum / cell.object - height) > kOneSurface) continue;
        sum += cell.z_sum + bottom * cell.object;
        count += cell.object;
      }
      outline.tops.push_back(sum / count);
    }
  }
  return outline;
}

// Extent of the outline along `along`: the outermost place that lanes of a cross section of `support` reach, on either side.
struct Extent {
  double low = 0.0, high = 0.0;
  double length() const { return high - low; }
};

Extent extent_along(const std::vector<OutlineCell>& border, const Eigen::Vector2d& along, double lane, double slice, int slices,
                    double support) {
  const Eigen::Vector2d across(-along.y(), along.x());
  double first = std::numeric_limits<double>::infinity(), last = -first;
  for (const OutlineCell& c : border) {
    const double y = c.centre.dot(across);
    first = std::min(first, y);
    last = std::max(last, y);
  }
  const auto columns = static_cast<std::size_t>((last - first) / lane) + 1;
  const auto lanes = columns * static_cast<std::size_t>(slices);
  std::vector<double> low(lanes, std::numeric_limits<double>::infinity()), high(lanes, -std::numeric_limits<double>::infinity());
  for (const OutlineCell& c : border) {
    const std::size_t i =
        static_cast<std::size_t>(c.z) * columns + std::min(columns - 1, static_cast<std::size_t>((c.centre.dot(across) - first) / lane));
    const double x = c.centre.dot(along);
    low[i] = std::min(low[i], x);
    high[i] = std::max(high[i], x);
  }
  const auto empty = [](double value) { return !std::isfinite(value); };
  std::erase_if(low, empty);
  std::erase_if(high, empty);
  const std::size_t nth = std::min((low.size() - 1) / 2, static_cast<std::size_t>(support / (lane * slice)));
  std::nth_element(low.begin(), low.begin() + static_cast<std::ptrdiff_t>(nth), low.end());
  std::nth_element(high.begin(), high.begin() + static_cast<std::ptrdiff_t>(nth), high.end(), std::greater<>());
  return {low[nth], high[nth]};
}

struct Rectangle {
  double yaw = 0.0, area = std::numeric_limits<double>::infinity();
  Extent x, y;
};

Rectangle smallest_rectangle(const std::vector<OutlineCell>& border, double cell, double slice, int slices, const EvidenceConfig& config) {
  const double lane = std::max(0.01, cell);
  Rectangle best;
  const auto try_heading = [&](double yaw) {
    const Eigen::Vector2d along(std::cos(yaw), std::sin(yaw)), across(-along.y(), along.x());
    Rectangle r{yaw, 0.0, extent_along(border, along, lane, slice, slices, config.edge_support_m2),
                extent_along(border, across, lane, slice, slices, config.edge_support_m2)};
    for (Extent* e : {&r.x, &r.y}) {
      e->low -= 0.5 * cell;
      e->high += 0.5 * cell;
    }
    r.area = r.x.length() * r.y.length();
    if (r.area < best.area) best = r;
  };
  constexpr double kCoarse = std::numbers::pi / 90.0;
  for (int i = 0; i < 45; ++i) try_heading(i * kCoarse);
  const double fine = config.heading_step_deg * std::numbers::pi / 180.0;
  const double around = best.yaw;
  const int steps = static_cast<int>(std::ceil(kCoarse / fine));
  for (int i = -steps; i <= steps; ++i) try_heading(around + i * fine);
  return best;
}

// True where something of the object reaches down to its support inside the rectangle: legs are too thin, and seen too seldom, to be among
// its cells.
bool has_feet(const EvidenceGrid& grid, const Rectangle& r, double support_z, const EvidenceConfig& config) {
  const Eigen::Vector3d cell = grid.cell_size();
  const Eigen::Vector2d along(std::cos(r.yaw), std::sin(r.yaw)), across(-along.y(), along.x());
  int found = 0;
  for (int z = 0; z < grid.size().z(); ++z) {
    const double bottom = grid.origin().z() + z * cell.z();
    if (bottom < support_z + config.foot_clearance_m || bottom > support_z + config.foot_gap_m) continue;
    for (int y = 0; y < grid.size().y(); ++y) {
      for (int x = 0; x < grid.size().x(); ++x) {
        const EvidenceCell& c = grid.cell(x, y, z);
        if (!is_object(c, config)) continue;
        const Eigen::Vector2d p(grid.origin().x() + (x + 0.5) * cell.x(), grid.origin().y() + (y + 0.5) * cell.y());
        const double u = p.dot(along), v = p.dot(across);
        if (u >= r.x.low && u <= r.x.high && v >= r.y.low && v <= r.y.high) ++found;
      }
    }
  }
  return found >= config.min_hits;
}

}  // namespace

std::optional<Cuboid> evidence_cuboid(const EvidenceGrid& grid, const BoxViews& views, double support_z, const EvidenceConfig& config) {
  if (grid.empty()) return std::nullopt;
  std::vector<CellOwner> owners = owners_of(grid, support_z, config);
  keep_one_object(grid, owners, views, config);
  Outline outline = outline_of(grid, owners, config);
  if (outline.tops.empty()) return std::nullopt;

  const double cell = grid.cell_size().x();
  // The lowest layer of an object that is higher takes no part: what noise lifts off the floor inside the box looks like it.
  const double skirt = support_z + std::min(kSkirt, 0.25 * (*std::max_element(outline.tops.begin(), outline.tops.end()) - support_z));
  const auto in_skirt = [&](const OutlineCell& c) { return grid.origin().z() + c.z * grid.cell_size().z() < skirt; };
  if (!std::all_of(outline.border.begin(), outline.border.end(), in_skirt)) std::erase_if(outline.border, in_skirt);
  const Rectangle r = smallest_rectangle(outline.border, cell, grid.cell_size().z(), grid.size().z(), config);
  const double area = std::max(config.top_area_m2, config.top_area_share * cell * cell * static_cast<double>(outline.tops.size()));
  const std::size_t nth = std::min((outline.tops.size() - 1) / 2, static_cast<std::size_t>(area / (cell * cell)));
  std::nth_element(outline.tops.begin(), outline.tops.begin() + static_cast<std::ptrdiff_t>(nth), outline.tops.end(), std::greater<>());
  const double top = outline.tops[nth];
  const bool stands = outline.lowest - support_z < config.foot_gap_m || has_feet(grid, r, support_z, config);
  const double bottom = stands ? support_z : outline.lowest;

  Cuboid cuboid;
  const Eigen::Vector2d along(std::cos(r.yaw), std::sin(r.yaw)), across(-along.y(), along.x());
  const Eigen::Vector2d centre = 0.5 * (r.x.low + r.x.high) * along + 0.5 * (r.y.low + r.y.high) * across;
  cuboid.centre = {centre.x(), centre.y(), 0.5 * (top + bottom)};
  cuboid.size = {std::max(0.0, r.x.length()), std::max(0.0, r.y.length()), std::max(1e-3, top - bottom)};
  cuboid.yaw = r.yaw;
  return canonical(cuboid);
}

}  // namespace waretwin

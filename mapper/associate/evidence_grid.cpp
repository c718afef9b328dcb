#include "mapper/associate/evidence_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace waretwin {

namespace {

constexpr unsigned kMost = std::numeric_limits<std::uint16_t>::max();

// The counts of both cells. Where one is full all are halved: what matters is their shares. `shift`: metres from the bottom of `to` up to
// that of `from`.
void pour_cell(const EvidenceCell& from, float shift, EvidenceCell& to) {
  unsigned sums[] = {unsigned{to.object} + from.object, unsigned{to.other} + from.other, unsigned{to.unknown} + from.unknown,
                     unsigned{to.passed} + from.passed};
  to.z_sum += from.z_sum + shift * from.object;
  const unsigned objects = sums[0];
  while (*std::max_element(std::begin(sums), std::end(sums)) > kMost) {
    for (unsigned& sum : sums) sum /= 2;
  }
  if (sums[0] != objects) to.z_sum *= static_cast<float>(sums[0]) / static_cast<float>(objects);
  to.object = static_cast<std::uint16_t>(sums[0]);
  to.other = static_cast<std::uint16_t>(sums[1]);
  to.unknown = static_cast<std::uint16_t>(sums[2]);
  to.passed = static_cast<std::uint16_t>(sums[3]);
}

void count(EvidenceCell& cell, std::uint16_t EvidenceCell::*counter) {
  if (cell.*counter < kMost) {
    ++(cell.*counter);
    return;
  }
  EvidenceCell one;
  one.*counter = 1;
  pour_cell(one, 0.0f, cell);
}

// Whole multiples of a step that hold [low, high].
double floor_to(double value, double step) { return std::floor(value / step) * step; }

}  // namespace

void EvidenceGrid::add(const Eigen::Vector3d& from_W, const std::vector<EvidenceRay>& rays, const Eigen::AlignedBox3d& candidates_W) {
  if (!candidates_W.isEmpty()) cover(candidates_W);
  if (cells_.empty()) return;
  const Eigen::Vector3f origin = origin_.cast<float>(), from = from_W.cast<float>() - origin;
  const float per_cell = static_cast<float>(1.0 / cell_), per_slice = static_cast<float>(1.0 / slice_), slice = static_cast<float>(slice_);
  const float width = static_cast<float>(size_.x()), depth = static_cast<float>(size_.y()), height = static_cast<float>(size_.z());
  const float near_first = static_cast<float>(config_.end_slack_m), near_step = static_cast<float>(cell_);
  const int near_steps = std::max(1, static_cast<int>(std::ceil(config_.end_path_m / cell_)));
  const float near_reach = near_first + static_cast<float>(near_steps) * near_step;
  for (const EvidenceRay& ray : rays) {
    const Eigen::Vector3f hit = ray.hit_W - origin;
    const float x = hit.x() * per_cell, y = hit.y() * per_cell, z = hit.z() * per_slice;
    if (x >= 0.0f && y >= 0.0f && z >= 0.0f && x < width && y < depth && z < height) {
      EvidenceCell& cell = cells_[index(static_cast<int>(x), static_cast<int>(y), static_cast<int>(z))];
      switch (ray.kind) {
        case RayKind::object:
          count(cell, &EvidenceCell::object);
          cell.z_sum += hit.z() - std::floor(z) * slice;
          break;
        case RayKind::other:
          count(cell, &EvidenceCell::other);
          break;
        case RayKind::unknown:
          count(cell, &EvidenceCell::unknown);
          break;
      }
    }
    // Close before its end on a side a ray would cross few middle planes; it is followed step by step instead. Above a level surface
    // it passes no slice but those that lie above as a whole.
    const Eigen::Vector3f back = (from - hit).normalized();
    for (int i = 0; !ray.level && i < near_steps; ++i) {
      const Eigen::Vector3f p = hit + back * (near_first + static_cast<float>(i) * near_step);
      const float px = p.x() * per_cell, py = p.y() * per_cell, pz = p.z() * per_slice;
      if (!(px >= 0.0f && py >= 0.0f && pz >= 0.0f && px < width && py < depth && pz < height)) break;
      count(cells_[index(static_cast<int>(px), static_cast<int>(py), static_cast<int>(pz))], &EvidenceCell::passed);
    }
    // Slices that the ray crosses as a whole before that.
    const float rise = hit.z() - from.z();
    if (std::abs(rise) < 1e-4f) continue;
    const float reach = ray.level ? 0.7f : std::abs(back.z()) * near_reach * per_slice;
    const float low = rise < 0.0f ? z + reach : from.z() * per_slice, high = rise < 0.0f ? from.z() * per_slice : z - reach;
    const int first = std::max(0, static_cast<int>(std::ceil(low - 0.5f)));
    const int last = std::min(size_.z() - 1, static_cast<int>(std::floor(high - 0.5f)));
    const float dx = (hit.x() - from.x()) / rise, dy = (hit.y() - from.y()) / rise;
    for (int k = first; k <= last; ++k) {
      const float run = (static_cast<float>(k) + 0.5f) * slice - from.z();
      const float cx = (from.x() + run * dx) * per_cell, cy = (from.y() + run * dy) * per_cell;
      if (!(cx >= 0.0f && cy >= 0.0f && cx < width && cy < depth)) continue;
      EvidenceCell& cell = cells_[index(static_cast<int>(cx), static_cast<int>(cy), k)];
      count(cell, &EvidenceCell::passed);
    }
  }
}

void EvidenceGrid::add(const EvidenceGrid& other) {
  if (other.cells_.empty()) return;
  const Eigen::AlignedBox3d reach(other.origin_, other.origin_ + other.size_.cast<double>().cwiseProduct(other.cell_size()));
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(config_.margin_m);
  // Counts of a large cell cannot be shared out among small ones.
  cover({reach.min() + margin, reach.max() - margin}, other.cell_);
  if (cells_.empty()) return;
  pour(other.cells_, other.origin_, other.size_, other.cell_size());
}

void EvidenceGrid::cover(const Eigen::AlignedBox3d& box_W, double least_cell) {
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(config_.margin_m);
  Eigen::AlignedBox3d wanted(box_W.min() - margin, box_W.max() + margin);
  if (cells_.empty()) {
    cell_ = config_.cell_m;
    slice_ = config_.slice_m;
  }
  const Eigen::AlignedBox3d now(origin_, origin_ + size_.cast<double>().cwiseProduct(cell_size()));
  // What would be larger than an object may be is cut to the part around the grid's present middle.
  const Eigen::Vector3d middle = cells_.empty() ? wanted.center() : now.center();
  const Eigen::Vector3d half = Eigen::Vector3d::Constant(0.5 * config_.max_extent_m);
  wanted = wanted.intersection(Eigen::AlignedBox3d(middle - half, middle + half));
  if (wanted.isEmpty()) return;
  if (!cells_.empty()) {
    if (now.contains(wanted) && cell_ >= least_cell) return;
    wanted.extend(now);
  }
  const auto cells_of = [&](double cell, double slice) {
    const Eigen::Vector3d extent = wanted.sizes();
    return (extent.x() / cell + 1) * (extent.y() / cell + 1) * (extent.z() / slice + 1);
  };
  int coarser = 1;
  while (cells_of(cell_ * coarser, slice_ * coarser) > config_.max_cells || cell_ * coarser < least_cell) coarser *= 2;
  const double cell = cell_ * coarser, slice = slice_ * coarser;
  const Eigen::Vector3d origin(floor_to(wanted.min().x(), cell), floor_to(wanted.min().y(), cell), floor_to(wanted.min().z(), slice));
  const Eigen::Vector3d extent = wanted.max() - origin;
  const Eigen::Vector3i size(static_cast<int>(std::ceil(extent.x() / cell)), static_cast<int>(std::ceil(extent.y() / cell)),
                             static_cast<int>(std::ceil(extent.z() / slice)));
  const std::vector<EvidenceCell> old = std::move(cells_);
  const Eigen::Vector3i old_size = size_;
  const Eigen::Vector3d old_origin = origin_, old_cell = cell_size();
  cell_ = cell;
  slice_ = slice;
  origin_ = origin;
  size_ = size;
  cells_.assign(static_cast<std::size_t>(size.x()) * static_cast<std::size_t>(size.y()) * static_cast<std::size_t>(size.z()), {});
  pour(old, old_origin, old_size, old_cell);
}

void EvidenceGrid::pour(const std::vector<EvidenceCell>& cells, const Eigen::Vector3d& origin, const Eigen::Vector3i& size,
                        const Eigen::Vector3d& cell) {
  std::size_t at = 0;
  for (int z = 0; z < size.z(); ++z) {
    const double height = origin.z() + (z + 0.5) * cell.z() - origin_.z();
    const int to_z = static_cast<int>(std::floor(height / slice_));
    for (int y = 0; y < size.y(); ++y) {
      const int to_y = static_cast<int>(std::floor((origin.y() + (y + 0.5) * cell.y() - origin_.y()) / cell_));
      for (int x = 0; x < size.x(); ++x, ++at) {
        const EvidenceCell& from = cells[at];
        if (from.hits() + from.passed == 0) continue;
        const int to_x = static_cast<int>(std::floor((origin.x() + (x + 0.5) * cell.x() - origin_.x()) / cell_));
        if (to_x < 0 || to_y < 0 || to_z < 0 || to_x >= size_.x() || to_y >= size_.y() || to_z >= size_.z()) continue;
        const double shift = origin.z() + z * cell.z() - (origin_.z() + to_z * slice_);
        pour_cell(from, static_cast<float>(shift), cells_[index(to_x, to_y, to_z)]);
      }
    }
  }
}

}  // namespace waretwin

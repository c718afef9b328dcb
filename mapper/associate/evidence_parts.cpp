#include "mapper/associate/evidence_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace waretwin {

namespace {

// The cells of a grid, several at a time: as large as the gaps that are bridged.
struct CoarseCell {
  double object = 0.0, other = 0.0;  // hits, of the object's cells
  int cells = 0, blind = 0;          // of the grid in it; those that rays without depth met, and no others
  int part = 0;                      // 0: no cell of the object
  bool is_blind() const { return 2 * blind > cells; }
};

// Of the object's cells; 0 for none.
double median_hits(const EvidenceGrid& grid, const std::vector<char>& mine) {
  std::vector<int> hits;
  std::size_t i = 0;
  for (int z = 0; z < grid.size().z(); ++z) {
    for (int y = 0; y < grid.size().y(); ++y) {
      for (int x = 0; x < grid.size().x(); ++x, ++i) {
        if (mine[i]) hits.push_back(grid.cell(x, y, z).hits());
      }
    }
  }
  if (hits.empty()) return 0.0;
  const auto middle = hits.begin() + static_cast<std::ptrdiff_t>(hits.size() / 2);
  std::nth_element(hits.begin(), middle, hits.end());
  return *middle;
}

class CoarseGrid {
 public:
  CoarseGrid(const EvidenceGrid& grid, const std::vector<char>& mine, double step_m) {
    const int xy = std::max(1, static_cast<int>(std::lround(step_m / grid.cell_size().x())));
    step_ = {xy, xy, std::max(1, static_cast<int>(std::lround(step_m / grid.cell_size().z())))};
    size_ = ((grid.size() + step_ - Eigen::Vector3i::Ones()).array() / step_.array()).matrix();
    // A few rays come back without depth at every edge; across a dark belt hardly one comes back with it.
    constexpr double kDense = 0.3;
    const double dense = kDense * median_hits(grid, mine);
    cells_.resize(static_cast<std::size_t>(size_.x()) * static_cast<std::size_t>(size_.y()) * static_cast<std::size_t>(size_.z()));
    std::size_t i = 0;
    for (int z = 0; z < grid.size().z(); ++z) {
      for (int y = 0; y < grid.size().y(); ++y) {
        for (int x = 0; x < grid.size().x(); ++x, ++i) {
          const EvidenceCell& cell = grid.cell(x, y, z);
          CoarseCell& coarse = at(of(x, y, z));
          ++coarse.cells;
          if (cell.blind > cell.passed + cell.hits() && cell.blind >= dense) ++coarse.blind;
          if (!mine[i]) continue;
          coarse.object += cell.object;
          coarse.other += cell.other;
        }
      }
    }
  }
  const Eigen::Vector3i& size() const { return size_; }
  Eigen::Vector3i of(int x, int y, int z) const { return {x / step_.x(), y / step_.y(), z / step_.z()}; }
  bool contains(const Eigen::Vector3i& c) const { return c.minCoeff() >= 0 && (c.array() < size_.array()).all(); }
  CoarseCell& at(const Eigen::Vector3i& c) {
    return cells_[(static_cast<std::size_t>(c.z()) * static_cast<std::size_t>(size_.y()) + static_cast<std::size_t>(c.y())) *
                      static_cast<std::size_t>(size_.x()) +
                  static_cast<std::size_t>(c.x())];
  }

 private:
  Eigen::Vector3i step_ = Eigen::Vector3i::Ones(), size_ = Eigen::Vector3i::Zero();
  std::vector<CoarseCell> cells_;
};

struct Part {
  double object = 0.0, other = 0.0;
  std::vector<Eigen::Vector3i> cells;
};

std::vector<Part> connected_parts(CoarseGrid& coarse) {
  std::vector<Part> parts;
  for (int z = 0; z < coarse.size().z(); ++z) {
    for (int y = 0; y < coarse.size().y(); ++y) {
      for (int x = 0; x < coarse.size().x(); ++x) {
        if (coarse.at({x, y, z}).object <= 0.0 || coarse.at({x, y, z}).part != 0) continue;
        Part& part = parts.emplace_back();
        const int id = static_cast<int>(parts.size());
        coarse.at({x, y, z}).part = id;
        part.cells.emplace_back(x, y, z);
        for (std::size_t next = 0; next < part.cells.size(); ++next) {
          const Eigen::Vector3i c = part.cells[next];
          part.object += coarse.at(c).object;
          part.other += coarse.at(c).other;
          for (int k = 0; k < 27; ++k) {
            const Eigen::Vector3i n = c + Eigen::Vector3i(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
            if (!coarse.contains(n) || coarse.at(n).object <= 0.0 || coarse.at(n).part != 0) continue;
            coarse.at(n).part = id;
            part.cells.push_back(n);
          }
        }
      }
    }
  }
  return parts;
}

// The shortest way between two parts, in coarse cells.
struct Gap {
  Eigen::Vector3i from = Eigen::Vector3i::Zero(), to = Eigen::Vector3i::Zero();
  int squared = std::numeric_limits<int>::max();
};

Gap gap_between(const Part& a, const Part& b) {
  Gap gap;
  for (const Eigen::Vector3i& p : a.cells) {
    for (const Eigen::Vector3i& q : b.cells) {
      const int squared = (p - q).squaredNorm();
      if (squared < gap.squared) gap = {p, q, squared};
    }
  }
  return gap;
}

// True where rays met most of the way and brought nothing back: a belt too dark for the camera. What no ray met (the shadow behind an
// object) does not join anything.
bool blind_between(CoarseGrid& coarse, const Gap& gap) {
  const int steps = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(gap.squared))));
  int blind = 0, between = 0;
  for (int i = 1; i < steps; ++i) {
    const Eigen::Vector3d p = gap.from.cast<double>() + (gap.to - gap.from).cast<double>() * (static_cast<double>(i) / steps);
    ++between;
    if (coarse.at(p.array().round().matrix().cast<int>()).is_blind()) ++blind;
  }
  return 4 * blind >= 3 * between;
}

}  // namespace

void keep_one_object(const EvidenceGrid& grid, std::vector<char>& mine, const EvidenceConfig& config) {
  CoarseGrid coarse(grid, mine, config.join_m);
  const std::vector<Part> parts = connected_parts(coarse);
  if (parts.empty()) return;
  const auto fewer = [](const Part& a, const Part& b) { return a.object < b.object; };
  const auto main = static_cast<std::size_t>(std::max_element(parts.begin(), parts.end(), fewer) - parts.begin());
  std::vector<char> kept(parts.size() + 1, 0);
  kept[main + 1] = 1;
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    // Specks are not worth a bridge.
    const bool speck = static_cast<double>(parts[i].cells.size()) < 0.02 * static_cast<double>(parts[main].cells.size());
    if (i != main && !speck && parts[i].object >= config.bridge_share * (parts[i].object + parts[i].other)) open.push_back(i);
  }
  // From the nearest on: what lies behind a part is judged from there.
  std::vector<Gap> gaps(parts.size());
  for (const std::size_t i : open) gaps[i] = gap_between(parts[main], parts[i]);
  while (!open.empty()) {
    const auto nearest = std::min_element(open.begin(), open.end(), [&](auto a, auto b) { return gaps[a].squared < gaps[b].squared; });
    const std::size_t i = *nearest;
    open.erase(nearest);
    if (std::sqrt(static_cast<double>(gaps[i].squared)) * config.join_m > config.bridge_m || !blind_between(coarse, gaps[i])) continue;
    kept[i + 1] = 1;
    for (const std::size_t k : open) {
      const Gap gap = gap_between(parts[i], parts[k]);
      if (gap.squared < gaps[k].squared) gaps[k] = gap;
    }
  }
  std::size_t i = 0;
  for (int z = 0; z < grid.size().z(); ++z) {
    for (int y = 0; y < grid.size().y(); ++y) {
      for (int x = 0; x < grid.size().x(); ++x, ++i) {
        if (mine[i] && !kept[static_cast<std::size_t>(coarse.at(coarse.of(x, y, z)).part)]) mine[i] = 0;
      }
    }
  }
}

}  // namespace waretwin

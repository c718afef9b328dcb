#include "mapper/associate/evidence_parts.h"

#include <algorithm>
#include <cmath>

#include "mapper/associate/part_choice.h"

namespace waretwin {

namespace {

// Cells of a grid, several at a time: as large as the gaps that do not part an object.
struct CoarseCell {
  double hits = 0.0;     // of the object's cells
  bool foreign = false;  // holds a cell of something else
  int part = 0;          // 0: no cell of the object
  int body = 0;          // 0: nothing is there
  bool is_object() const { return hits > 0.0; }
  bool is_filled() const { return is_object() || foreign; }
};

class CoarseGrid {
 public:
  CoarseGrid(const EvidenceGrid& grid, const std::vector<CellOwner>& owners, double step_m) {
    const int xy = std::max(1, static_cast<int>(std::lround(step_m / grid.cell_size().x())));
    step_ = {xy, xy, std::max(1, static_cast<int>(std::lround(step_m / grid.cell_size().z())))};
    size_ = ((grid.size() + step_ - Eigen::Vector3i::Ones()).array() / step_.array()).matrix();
    cells_.resize(static_cast<std::size_t>(size_.x()) * static_cast<std::size_t>(size_.y()) * static_cast<std::size_t>(size_.z()));
    std::size_t i = 0;
    for (int z = 0; z < grid.size().z(); ++z) {
      for (int y = 0; y < grid.size().y(); ++y) {
        for (int x = 0; x < grid.size().x(); ++x, ++i) {
          if (owners[i] == CellOwner::none) continue;
          CoarseCell& coarse = at(of(x, y, z));
          if (owners[i] == CellOwner::object) {
            coarse.hits += grid.cell(x, y, z).object;
          } else {
            coarse.foreign = true;
          }
        }
      }
    }
  }
  const Eigen::Vector3i& size() const { return size_; }
  const Eigen::Vector3i& step() const { return step_; }  // cells of the grid in one of these
  Eigen::Vector3i of(int x, int y, int z) const { return {x / step_.x(), y / step_.y(), z / step_.z()}; }
  bool contains(const Eigen::Vector3i& c) const { return c.minCoeff() >= 0 && (c.array() < size_.array()).all(); }
  CoarseCell& at(const Eigen::Vector3i& c) { return cells_[index(c)]; }

  template <typename Visit>
  void for_each(const Visit& visit) {
    for (int z = 0; z < size_.z(); ++z) {
      for (int y = 0; y < size_.y(); ++y) {
        for (int x = 0; x < size_.x(); ++x) visit(Eigen::Vector3i(x, y, z));
      }
    }
  }

  // All cells for which `member` holds and that hang together with the first one; `take` makes `member` false of each.
  template <typename Member, typename Take>
  std::vector<Eigen::Vector3i> connected(const Eigen::Vector3i& first, const Member& member, const Take& take) {
    std::vector<Eigen::Vector3i> cells{first};
    take(at(first));
    for (std::size_t next = 0; next < cells.size(); ++next) {
      const Eigen::Vector3i c = cells[next];
      for (int k = 0; k < 27; ++k) {
        const Eigen::Vector3i n = c + Eigen::Vector3i(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
        if (!contains(n) || !member(at(n))) continue;
        take(at(n));
        cells.push_back(n);
      }
    }
    return cells;
  }

 private:
  std::size_t index(const Eigen::Vector3i& c) const {
    return (static_cast<std::size_t>(c.z()) * static_cast<std::size_t>(size_.y()) + static_cast<std::size_t>(c.y())) *
               static_cast<std::size_t>(size_.x()) +
           static_cast<std::size_t>(c.x());
  }

  Eigen::Vector3i step_ = Eigen::Vector3i::Ones(), size_ = Eigen::Vector3i::Zero();
  std::vector<CoarseCell> cells_;
};

std::vector<EvidencePart> connected_parts(CoarseGrid& coarse, const EvidenceGrid& grid, const Eigen::Vector3d& edge) {
  std::vector<double> shares;  // by body
  const auto new_body = [](const CoarseCell& cell) { return cell.is_filled() && cell.body == 0; };
  coarse.for_each([&](const Eigen::Vector3i& c) {
    if (!new_body(coarse.at(c))) return;
    const int id = static_cast<int>(shares.size()) + 1;
    const auto cells = coarse.connected(c, new_body, [id](CoarseCell& cell) { cell.body = id; });
    const auto own = std::count_if(cells.begin(), cells.end(), [&](const auto& n) { return coarse.at(n).is_object(); });
    shares.push_back(static_cast<double>(own) / static_cast<double>(cells.size()));
  });
  std::vector<EvidencePart> parts;
  const auto new_part = [](const CoarseCell& cell) { return cell.is_object() && cell.part == 0; };
  coarse.for_each([&](const Eigen::Vector3i& c) {
    if (!new_part(coarse.at(c))) return;
    EvidencePart part;
    const int id = static_cast<int>(parts.size()) + 1;
    for (const Eigen::Vector3i& n : coarse.connected(c, new_part, [id](CoarseCell& cell) { cell.part = id; })) {
      part.hits += coarse.at(n).hits;
      part.cells_W.push_back((grid.origin() + (n.cast<double>() + Eigen::Vector3d::Constant(0.5)).cwiseProduct(edge)).cast<float>());
    }
    part.share = shares[static_cast<std::size_t>(coarse.at(c).body) - 1];
    parts.push_back(std::move(part));
  });
  return parts;
}

}  // namespace

int median_hits(const EvidenceGrid& grid, const std::vector<CellOwner>& owners) {
  std::vector<int> hits;
  std::size_t i = 0;
  for (int z = 0; z < grid.size().z(); ++z) {
    for (int y = 0; y < grid.size().y(); ++y) {
      for (int x = 0; x < grid.size().x(); ++x, ++i) {
        if (owners[i] == CellOwner::object) hits.push_back(grid.cell(x, y, z).hits());
      }
    }
  }
  if (hits.empty()) return 0;
  const auto middle = hits.begin() + static_cast<std::ptrdiff_t>(hits.size() / 2);
  std::nth_element(hits.begin(), middle, hits.end());
  return *middle;
}

void keep_one_object(const EvidenceGrid& grid, std::vector<CellOwner>& owners, const BoxViews& views, const EvidenceConfig& config) {
  CoarseGrid coarse(grid, owners, config.join_m);
  const Eigen::Vector3d edge = grid.cell_size().cwiseProduct(coarse.step().cast<double>());
  std::vector<EvidencePart> parts = connected_parts(coarse, grid, edge);
  if (parts.empty()) return;
  // Specks are neither the object nor worth a bridge.
  constexpr double kSpeck = 0.02;
  std::size_t largest = 0;
  for (const EvidencePart& part : parts) largest = std::max(largest, part.cells_W.size());
  for (EvidencePart& part : parts) {
    if (views.empty() || static_cast<double>(part.cells_W.size()) < kSpeck * static_cast<double>(largest)) continue;
    part.shown = views.shown(part.cells_W, 0.5 * edge.x());
  }
  std::vector<char> kept(parts.size() + 1, 0);
  for (const std::size_t i : choose_parts(parts, views, config)) kept[i + 1] = 1;
  std::size_t i = 0;
  for (int z = 0; z < grid.size().z(); ++z) {
    for (int y = 0; y < grid.size().y(); ++y) {
      for (int x = 0; x < grid.size().x(); ++x, ++i) {
        if (owners[i] == CellOwner::object && !kept[static_cast<std::size_t>(coarse.at(coarse.of(x, y, z)).part)]) {
          owners[i] = CellOwner::none;
        }
      }
    }
  }
}

}  // namespace waretwin

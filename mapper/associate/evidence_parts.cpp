#include "mapper/associate/evidence_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

namespace waretwin {

namespace {

// The cells of a grid, several at a time: as large as the gaps that are bridged.
struct CoarseCell {
  double object = 0.0, other = 0.0;  // hits, of the object's cells
  int cells = 0, blind = 0;          // of the grid in it; those that rays without depth met, and no others
  int foreign = 0;                   // of the grid in it that are something else's
  int part = 0;                      // 0: no cell of the object
  int body = 0;                      // 0: nothing is there
  bool is_blind() const { return 2 * blind > cells; }
  bool is_object() const { return object > 0.0; }
  bool is_filled() const { return is_object() || foreign > 0; }
};

class CoarseGrid {
 public:
  CoarseGrid(const EvidenceGrid& grid, const std::vector<CellOwner>& owners, double step_m) {
    const int xy = std::max(1, static_cast<int>(std::lround(step_m / grid.cell_size().x())));
    step_ = {xy, xy, std::max(1, static_cast<int>(std::lround(step_m / grid.cell_size().z())))};
    size_ = ((grid.size() + step_ - Eigen::Vector3i::Ones()).array() / step_.array()).matrix();
    // A few rays come back without depth at every edge; across a dark belt hardly one comes back with it.
    constexpr double kDense = 0.3;
    const double dense = kDense * median_hits(grid, owners);
    cells_.resize(static_cast<std::size_t>(size_.x()) * static_cast<std::size_t>(size_.y()) * static_cast<std::size_t>(size_.z()));
    std::size_t i = 0;
    for (int z = 0; z < grid.size().z(); ++z) {
      for (int y = 0; y < grid.size().y(); ++y) {
        for (int x = 0; x < grid.size().x(); ++x, ++i) {
          const EvidenceCell& cell = grid.cell(x, y, z);
          CoarseCell& coarse = at(of(x, y, z));
          ++coarse.cells;
          if (cell.blind > cell.passed + cell.hits() && cell.blind >= dense) ++coarse.blind;
          if (owners[i] == CellOwner::other) ++coarse.foreign;
          if (owners[i] != CellOwner::object) continue;
          coarse.object += cell.object;
          coarse.other += cell.other;
        }
      }
    }
  }
  const Eigen::Vector3i& size() const { return size_; }
  const Eigen::Vector3i& step() const { return step_; }  // cells of the grid in one of these
  Eigen::Vector3i of(int x, int y, int z) const { return {x / step_.x(), y / step_.y(), z / step_.z()}; }
  bool contains(const Eigen::Vector3i& c) const { return c.minCoeff() >= 0 && (c.array() < size_.array()).all(); }
  CoarseCell& at(const Eigen::Vector3i& c) { return cells_[index(c)]; }
  const CoarseCell& at(const Eigen::Vector3i& c) const { return cells_[index(c)]; }

 private:
  std::size_t index(const Eigen::Vector3i& c) const {
    return (static_cast<std::size_t>(c.z()) * static_cast<std::size_t>(size_.y()) + static_cast<std::size_t>(c.y())) *
               static_cast<std::size_t>(size_.x()) +
           static_cast<std::size_t>(c.x());
  }

  Eigen::Vector3i step_ = Eigen::Vector3i::Ones(), size_ = Eigen::Vector3i::Zero();
  std::vector<CoarseCell> cells_;
};

// Parts with a smaller share of the largest one's cells are not worth a bridge.
constexpr double kSpeck = 0.02;

struct Part {
  double object = 0.0, other = 0.0;  // hits
  double share = 1.0;                // of the cells of the body it is a piece of: the object's
  std::vector<Eigen::Vector3i> cells;
};

// All coarse cells for which `member` holds and that hang together with the first one; `take` marks each as visited.
template <typename Member, typename Take>
std::vector<Eigen::Vector3i> connected_cells(CoarseGrid& coarse, const Eigen::Vector3i& first, const Member& member, const Take& take) {
  std::vector<Eigen::Vector3i> cells{first};
  take(coarse.at(first));
  for (std::size_t next = 0; next < cells.size(); ++next) {
    const Eigen::Vector3i c = cells[next];
    for (int k = 0; k < 27; ++k) {
      const Eigen::Vector3i n = c + Eigen::Vector3i(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
      if (!coarse.contains(n) || !member(coarse.at(n))) continue;
      take(coarse.at(n));
      cells.push_back(n);
    }
  }
  return cells;
}

template <typename Visit>
void for_each_cell(const CoarseGrid& coarse, const Visit& visit) {
  for (int z = 0; z < coarse.size().z(); ++z) {
    for (int y = 0; y < coarse.size().y(); ++y) {
      for (int x = 0; x < coarse.size().x(); ++x) visit(Eigen::Vector3i(x, y, z));
    }
  }
}

// The object's cells that hang together, in parts. Each is a piece of a body of which some may have been seen outside the boxes: a wall.
std::vector<Part> connected_parts(CoarseGrid& coarse) {
  std::vector<double> shares;  // by body
  const auto new_body = [](const CoarseCell& cell) { return cell.is_filled() && cell.body == 0; };
  for_each_cell(coarse, [&](const Eigen::Vector3i& c) {
    if (!new_body(coarse.at(c))) return;
    const int id = static_cast<int>(shares.size()) + 1;
    const auto cells = connected_cells(coarse, c, new_body, [id](CoarseCell& cell) { cell.body = id; });
    const auto own = std::count_if(cells.begin(), cells.end(), [&](const auto& n) { return coarse.at(n).is_object(); });
    shares.push_back(static_cast<double>(own) / static_cast<double>(cells.size()));
  });
  std::vector<Part> parts;
  const auto new_part = [](const CoarseCell& cell) { return cell.is_object() && cell.part == 0; };
  for_each_cell(coarse, [&](const Eigen::Vector3i& c) {
    if (!new_part(coarse.at(c))) return;
    Part part;
    const int id = static_cast<int>(parts.size()) + 1;
    part.cells = connected_cells(coarse, c, new_part, [id](CoarseCell& cell) { cell.part = id; });
    for (const Eigen::Vector3i& n : part.cells) {
      part.object += coarse.at(n).object;
      part.other += coarse.at(n).other;
    }
    part.share = shares[static_cast<std::size_t>(coarse.at(c).body) - 1];
    parts.push_back(std::move(part));
  });
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

// Where a part lies, in the world.
std::vector<Eigen::Vector3f> places_of(const Part& part, const EvidenceGrid& grid, const Eigen::Vector3i& step) {
  std::vector<Eigen::Vector3f> places;
  places.reserve(part.cells.size());
  const Eigen::Vector3d edge = grid.cell_size().cwiseProduct(step.cast<double>());
  for (const Eigen::Vector3i& c : part.cells) {
    places.push_back((grid.origin() + (c.cast<double>() + Eigen::Vector3d::Constant(0.5)).cwiseProduct(edge)).cast<float>());
  }
  return places;
}

// The parts of one grid, and which of them together are the object.
class PartChoice {
 public:
  PartChoice(CoarseGrid& coarse, const std::vector<Part>& parts, std::vector<ShownBoxes> shown, const BoxViews& views,
             const EvidenceConfig& config)
      : coarse_(coarse), parts_(parts), shown_(std::move(shown)), views_(views), config_(config) {}

  // Indices of the chosen parts. Without boxes the part with the most hits is the first one and what may be joined is. With boxes, each
  // of those that match them best is tried for the first one.
  std::vector<std::size_t> choose() {
    std::vector<std::size_t> seeds(parts_.size());
    std::iota(seeds.begin(), seeds.end(), std::size_t{0});
    const auto rank = [&](std::size_t i) {
      return std::pair(matches(i) ? parts_[i].share * views_.match(shown_[i]) : 0.0, parts_[i].object);
    };
    std::vector<std::pair<double, double>> ranks;
    for (const std::size_t i : seeds) ranks.push_back(rank(i));
    std::stable_sort(seeds.begin(), seeds.end(), [&](auto a, auto b) { return ranks[a] > ranks[b]; });
    constexpr std::size_t kSeeds = 6;
    seeds.resize(views_.empty() ? 1 : std::min(kSeeds, seeds.size()));
    std::vector<std::size_t> best;
    double best_value = -1.0;
    for (const std::size_t seed : seeds) {
      if (!views_.empty() && !matches(seed)) continue;
      if (std::find(best.begin(), best.end(), seed) != best.end()) continue;  // it would come to the same
      auto [chosen, match] = grown_from(seed);
      double own = 0.0, cells = 0.0;
      for (const std::size_t i : chosen) {
        own += parts_[i].share * static_cast<double>(parts_[i].cells.size());
        cells += static_cast<double>(parts_[i].cells.size());
      }
      const double value = match * own / cells;
      if (value <= best_value) continue;
      best_value = value;
      best = std::move(chosen);
    }
    return best;
  }

 private:
  bool matches(std::size_t i) const { return !shown_[i].empty(); }

  bool may_join(std::size_t i, const Gap& gap) {
    const Part& part = parts_[i];
    if (std::sqrt(static_cast<double>(gap.squared)) * config_.join_m > config_.bridge_m) return false;
    if (part.object < config_.bridge_share * (part.object + part.other)) return false;
    if (views_.empty()) return blind_between(coarse_, gap);
    return matches(i) && part.share >= config_.bridge_share;
  }

  const Gap& gap(std::size_t a, std::size_t b) {
    const auto key = std::minmax(a, b);
    auto found = gaps_.find(key);
    if (found == gaps_.end()) found = gaps_.emplace(key, gap_between(parts_[key.first], parts_[key.second])).first;
    return found->second;
  }

  // A first part, and those that join it: always the one first with which the boxes are matched best; without boxes, the nearest.
  std::pair<std::vector<std::size_t>, double> grown_from(std::size_t seed) {
    std::vector<std::size_t> chosen{seed}, open;
    double largest = 0.0;
    for (const Part& part : parts_) largest = std::max(largest, static_cast<double>(part.cells.size()));
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      if (i != seed && static_cast<double>(parts_[i].cells.size()) >= kSpeck * largest) open.push_back(i);
    }
    ShownBoxes whole = shown_[seed];
    double match = views_.match(whole);
    for (;;) {
      std::size_t next = open.size();
      double best = views_.empty() ? -std::numeric_limits<double>::infinity() : match + config_.bridge_gain;
      for (std::size_t k = 0; k < open.size(); ++k) {
        const double value = views_.empty()     ? -nearest(chosen, open[k])
                             : matches(open[k]) ? views_.match(united(whole, shown_[open[k]]))
                                                : 0.0;
        if (value <= best || !joins_any(chosen, open[k])) continue;
        best = value;
        next = k;
      }
      if (next == open.size()) return {chosen, match};
      const std::size_t i = open[next];
      open.erase(open.begin() + static_cast<std::ptrdiff_t>(next));
      chosen.push_back(i);
      if (views_.empty()) continue;
      whole = united(whole, shown_[i]);
      match = best;
    }
  }

  double nearest(const std::vector<std::size_t>& chosen, std::size_t i) {
    double squared = std::numeric_limits<double>::infinity();
    for (const std::size_t k : chosen) squared = std::min(squared, static_cast<double>(gap(i, k).squared));
    return squared;
  }

  bool joins_any(const std::vector<std::size_t>& chosen, std::size_t i) {
    return std::any_of(chosen.begin(), chosen.end(), [&](std::size_t k) { return may_join(i, gap(i, k)); });
  }

  CoarseGrid& coarse_;
  const std::vector<Part>& parts_;
  std::vector<ShownBoxes> shown_;  // empty for specks
  const BoxViews& views_;
  const EvidenceConfig& config_;
  std::map<std::pair<std::size_t, std::size_t>, Gap> gaps_;
};

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
  const std::vector<Part> parts = connected_parts(coarse);
  if (parts.empty()) return;
  std::size_t largest = 0;
  for (const Part& part : parts) largest = std::max(largest, part.cells.size());
  std::vector<ShownBoxes> shown(parts.size());
  for (std::size_t i = 0; i < parts.size() && !views.empty(); ++i) {
    if (static_cast<double>(parts[i].cells.size()) < kSpeck * static_cast<double>(largest)) continue;
    shown[i] = views.shown(places_of(parts[i], grid, coarse.step()), 0.5 * config.join_m);
  }
  std::vector<char> kept(parts.size() + 1, 0);
  for (const std::size_t i : PartChoice(coarse, parts, std::move(shown), views, config).choose()) kept[i + 1] = 1;
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

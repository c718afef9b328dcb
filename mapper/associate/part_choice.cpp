#include "mapper/associate/part_choice.h"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

namespace waretwin {

namespace {

class PartChoice {
 public:
  PartChoice(const std::vector<EvidencePart>& parts, const BoxViews& views, const EvidenceConfig& config)
      : parts_(parts), views_(views), config_(config) {}

  std::vector<std::size_t> best() {
    std::vector<std::size_t> best;
    double best_value = -1.0;
    for (const std::size_t seed : seeds()) {
      if (std::find(best.begin(), best.end(), seed) != best.end()) continue;  // it would come to the same
      auto [chosen, match] = grown_from(seed);
      const double value = match * mean_share(chosen);
      if (value <= best_value) continue;
      best_value = value;
      best = std::move(chosen);
    }
    return best;
  }

 private:
  std::vector<std::size_t> seeds() const {
    constexpr std::size_t kMost = 6;
    std::vector<std::pair<double, std::size_t>> ranked;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      if (!parts_[i].shown.empty()) ranked.emplace_back(-parts_[i].share * views_.match(parts_[i].shown), i);
    }
    std::sort(ranked.begin(), ranked.end());
    std::vector<std::size_t> seeds;
    for (std::size_t k = 0; k < std::min(kMost, ranked.size()); ++k) seeds.push_back(ranked[k].second);
    return seeds;
  }

  std::pair<std::vector<std::size_t>, double> grown_from(std::size_t seed) {
    std::vector<std::size_t> chosen{seed}, open;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      if (i != seed && !parts_[i].shown.empty() && parts_[i].share >= config_.bridge_share) open.push_back(i);
    }
    ShownBoxes whole = parts_[seed].shown;
    double match = views_.match(whole);
    for (;;) {
      auto next = open.end();
      double best = match + config_.bridge_gain;
      for (auto i = open.begin(); i != open.end(); ++i) {
        const double value = views_.match(united(whole, parts_[*i].shown));
        if (value <= best || !is_near(chosen, *i)) continue;
        best = value;
        next = i;
      }
      if (next == open.end()) break;
      chosen.push_back(*next);
      whole = united(whole, parts_[*next].shown);
      match = best;
      open.erase(next);
    }
    // The others were asked whether they are needed; the first one was not.
    if (chosen.size() > 1) {
      ShownBoxes others = parts_[chosen[1]].shown;
      for (std::size_t k = 2; k < chosen.size(); ++k) others = united(others, parts_[chosen[k]].shown);
      const double without = views_.match(others);
      if (without + config_.bridge_gain >= match) {
        chosen.erase(chosen.begin());
        match = without;
      }
    }
    return {chosen, match};
  }

  double mean_share(const std::vector<std::size_t>& chosen) const {
    double own = 0.0, cells = 0.0;
    for (const std::size_t i : chosen) {
      own += parts_[i].share * static_cast<double>(parts_[i].cells_W.size());
      cells += static_cast<double>(parts_[i].cells_W.size());
    }
    return own / cells;
  }

  bool is_near(const std::vector<std::size_t>& chosen, std::size_t i) {
    return std::any_of(chosen.begin(), chosen.end(),
                       [&](std::size_t k) { return squared_gap(i, k) <= config_.bridge_m * config_.bridge_m; });
  }

  // Between the nearest cells of two parts, square metres.
  double squared_gap(std::size_t a, std::size_t b) {
    const auto [gap, fresh] = gaps_.try_emplace(std::minmax(a, b), std::numeric_limits<double>::infinity());
    if (!fresh) return gap->second;
    for (const Eigen::Vector3f& p : parts_[a].cells_W) {
      for (const Eigen::Vector3f& q : parts_[b].cells_W) gap->second = std::min<double>(gap->second, (p - q).squaredNorm());
    }
    return gap->second;
  }

  const std::vector<EvidencePart>& parts_;
  const BoxViews& views_;
  const EvidenceConfig& config_;
  std::map<std::pair<std::size_t, std::size_t>, double> gaps_;
};

}  // namespace

std::vector<std::size_t> choose_parts(const std::vector<EvidencePart>& parts, const BoxViews& views, const EvidenceConfig& config) {
  if (!views.empty()) return PartChoice(parts, views, config).best();
  const auto fewer = [](const EvidencePart& a, const EvidencePart& b) { return a.hits < b.hits; };
  return {static_cast<std::size_t>(std::max_element(parts.begin(), parts.end(), fewer) - parts.begin())};
}

}  // namespace waretwin

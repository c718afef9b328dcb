#include "mapper/segment/support_plane.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace waretwin {
namespace {

constexpr double kBin = 0.01;          // metres: fine against a conveyor's height, coarse against the noise of a level's mean
constexpr int kHalfWidth = 1;          // bins that a peak reaches to each side
constexpr double kPeakContrast = 3.0;  // a wall's contrast is 1
constexpr double kHighest = 5.0;       // metres above the ground
constexpr double kReach = 0.03;        // metres: points this near to a candidate refine it
constexpr double kLeastAbove = 0.25;   // "a considerable set": share of the box's points off the ground that lie above a support

std::vector<double> ring_peaks(const std::vector<HeightSample>& samples, double lowest, double fewest) {
  const int bins = static_cast<int>(kHighest / kBin);
  std::vector<int> histogram(bins, 0);
  for (const HeightSample& sample : samples) {
    const double bin = (sample.height - lowest) / kBin;
    if (!sample.in_box && bin >= 0.0 && bin < bins) ++histogram[static_cast<int>(bin)];
  }
  const auto sum = [&](int first, int last) {
    return std::accumulate(histogram.begin() + std::clamp(first, 0, bins), histogram.begin() + std::clamp(last + 1, 0, bins), 0);
  };
  std::vector<double> peaks;
  constexpr int kSide = 6;  // bins beyond the peak that show what surrounds it
  for (int i = 0; i < bins; ++i) {
    const int peak = sum(i - kHalfWidth, i + kHalfWidth);
    if (peak < fewest || peak < sum(i - 1 - kHalfWidth, i - 1 + kHalfWidth) || peak <= sum(i + 1 - kHalfWidth, i + 1 + kHalfWidth))
      continue;
    const int beside = sum(i - kHalfWidth - 2 - kSide, i - kHalfWidth - 3) + sum(i + kHalfWidth + 3, i + kHalfWidth + 2 + kSide);
    const double expected = static_cast<double>(beside) * (2 * kHalfWidth + 1) / (2.0 * kSide);
    if (peak > kPeakContrast * expected) peaks.push_back(lowest + (i + 0.5) * kBin);
  }
  return peaks;
}

// Width times height of the middle 96 % of some pixels; reorders them.
double spanned_area(std::vector<float>& us, std::vector<float>& vs) {
  if (us.size() < 10) return 0.0;
  const auto span = [](std::vector<float>& values) {
    const auto at = [&](double order) {
      const auto nth = values.begin() + static_cast<std::ptrdiff_t>(order * static_cast<double>(values.size() - 1));
      std::nth_element(values.begin(), nth, values.end());
      return *nth;
    };
    const float high = at(0.98);
    return high - at(0.02);
  };
  return span(us) * span(vs);
}

// What the samples above `height` span, as a share of what all samples of the box span. Not of the box itself: where the depth field
// cuts through the box, a support must still be found for the part with depth.
double coverage_above(const std::vector<HeightSample>& samples, double height, double& share_above, double ground_height) {
  std::vector<float> us, vs, all_us, all_vs;
  int off_ground = 0;
  for (const HeightSample& sample : samples) {
    if (!sample.in_box) continue;
    all_us.push_back(sample.u);
    all_vs.push_back(sample.v);
    if (sample.height > ground_height) ++off_ground;
    if (sample.height <= height) continue;
    us.push_back(sample.u);
    vs.push_back(sample.v);
  }
  share_above = off_ground > 0 ? static_cast<double>(us.size()) / off_ground : 0.0;
  return spanned_area(us, vs) / std::max(1.0, spanned_area(all_us, all_vs));
}

}  // namespace

SupportPlane refine_level(const std::vector<HeightSample>& samples, double height, double reach, bool ring_only) {
  SupportPlane level{height, 0.0};
  // Twice, so that the window ends up centred on the level.
  for (int pass = 0; pass < 2; ++pass) {
    std::vector<double> near;
    for (const HeightSample& sample : samples) {
      if ((!ring_only || !sample.in_box) && std::abs(sample.height - level.height) <= reach) near.push_back(sample.height);
    }
    if (near.size() < 5) return level;
    const auto middle = near.begin() + static_cast<std::ptrdiff_t>(near.size() / 2);
    std::nth_element(near.begin(), middle, near.end());
    level.height = *middle;
    for (double& value : near) value = std::abs(value - level.height);
    std::nth_element(near.begin(), middle, near.end());
    level.sigma = 1.4826 * *middle;
  }
  return level;
}

std::optional<SupportPlane> find_support(const std::vector<HeightSample>& samples, const std::vector<double>& levels, double ground_height,
                                         const PlaneConfig& config) {
  const auto in_ring = std::count_if(samples.begin(), samples.end(), [](const HeightSample& s) { return !s.in_box; });
  const double fewest = std::max(10.0, config.support_ring_fraction * static_cast<double>(in_ring));
  const double lowest = ground_height + config.ground_tolerance_m;
  std::vector<double> candidates = ring_peaks(samples, lowest, fewest);
  for (const double level : levels) {
    if (level > lowest) candidates.push_back(level);
  }
  std::optional<SupportPlane> best;
  for (const double candidate : candidates) {
    const SupportPlane level = refine_level(samples, candidate, kReach, true);
    const double clearance = std::clamp(3.0 * level.sigma, config.clearance_min_m, config.clearance_max_m);
    const auto count = std::count_if(samples.begin(), samples.end(),
                                     [&](const HeightSample& s) { return !s.in_box && std::abs(s.height - level.height) <= clearance; });
    if (static_cast<double>(count) < fewest || (best && level.height <= best->height)) continue;
    double share_above = 0.0;
    const double coverage = coverage_above(samples, level.height + clearance, share_above, lowest);
    if (coverage < config.support_coverage || share_above < kLeastAbove) continue;
    best = level;
  }
  return best;
}

}  // namespace waretwin

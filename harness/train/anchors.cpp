#include "harness/train/anchors.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/random.h"

namespace waretwin::train {
namespace {

std::size_t nearest(const BoxShape& shape, const std::vector<BoxShape>& anchors) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < anchors.size(); ++i) {
    if (shape_iou(shape, anchors[i]) > shape_iou(shape, anchors[best])) best = i;
  }
  return best;
}

// Each further start is drawn by the square of its distance to those that are there.
std::vector<BoxShape> spread_starts(const std::vector<BoxShape>& shapes, int count, const RandomStream& random) {
  std::vector<BoxShape> starts = {shapes[static_cast<std::size_t>(random.uniform(0) * static_cast<double>(shapes.size()))]};
  while (static_cast<int>(starts.size()) < count) {
    std::vector<double> sums(shapes.size());
    double sum = 0.0;
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      const double distance = 1.0 - shape_iou(shapes[i], starts[nearest(shapes[i], starts)]);
      sums[i] = sum += distance * distance;
    }
    if (sum < 1e-12) break;
    const auto drawn = std::upper_bound(sums.begin(), sums.end(), random.uniform(starts.size()) * sum);
    starts.push_back(shapes[std::min<std::size_t>(drawn - sums.begin(), shapes.size() - 1)]);
  }
  return starts;
}

std::vector<BoxShape> cluster(const std::vector<BoxShape>& shapes, std::vector<BoxShape> anchors) {
  constexpr int kRounds = 100;
  std::vector<std::size_t> owner(shapes.size(), anchors.size());
  for (int round = 0; round < kRounds; ++round) {
    bool changed = false;
    std::vector<BoxShape> sums(anchors.size());
    std::vector<double> counts(anchors.size());
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      const std::size_t mine = nearest(shapes[i], anchors);
      changed = changed || mine != owner[i];
      owner[i] = mine;
      sums[mine].width += shapes[i].width;
      sums[mine].height += shapes[i].height;
      counts[mine] += 1.0;
    }
    if (!changed) break;
    for (std::size_t k = 0; k < anchors.size(); ++k) {
      if (counts[k] > 0.0) anchors[k] = {sums[k].width / counts[k], sums[k].height / counts[k]};
    }
  }
  return anchors;
}

}  // namespace

double shape_iou(const BoxShape& a, const BoxShape& b) {
  const double common = std::min(a.width, b.width) * std::min(a.height, b.height);
  return common / (a.width * a.height + b.width * b.height - common);
}

double mean_best_iou(const std::vector<BoxShape>& shapes, const std::vector<BoxShape>& anchors) {
  double sum = 0.0;
  for (const BoxShape& shape : shapes) sum += shape_iou(shape, anchors[nearest(shape, anchors)]);
  return sum / static_cast<double>(shapes.size());
}

std::vector<BoxShape> find_anchors(const std::vector<BoxShape>& shapes, int count) {
  WARETWIN_CHECK(!shapes.empty() && count > 0, "anchors come from boxes");
  // One start may end in a bad local optimum.
  constexpr int kStarts = 10;
  std::vector<BoxShape> best;
  double best_iou = -1.0;
  for (int i = 0; i < kStarts; ++i) {
    const RandomStream random(0, "anchors", "starts", i);
    std::vector<BoxShape> anchors = cluster(shapes, spread_starts(shapes, count, random));
    const double iou = mean_best_iou(shapes, anchors);
    if (iou > best_iou) {
      best_iou = iou;
      best = std::move(anchors);
    }
  }
  const std::size_t found = best.size();
  for (int i = 0; static_cast<int>(best.size()) < count; ++i) {
    const double factor = std::pow(2.0, (i / 2 + 1) * (i % 2 == 0 ? -0.5 : 0.5));
    best.push_back({factor * best[i % found].width, factor * best[i % found].height});
  }
  std::stable_sort(best.begin(), best.end(), [](const BoxShape& a, const BoxShape& b) { return a.width * a.height < b.width * b.height; });
  return best;
}

}  // namespace waretwin::train

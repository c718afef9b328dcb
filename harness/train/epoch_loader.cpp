#include "harness/train/epoch_loader.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "core/parallel.h"
#include "core/random.h"
#include "harness/train/augment.h"

namespace waretwin::train {
std::vector<std::size_t> epoch_order(std::size_t pictures, const TrainConfig& config, int epoch) {
  const auto batch = static_cast<std::size_t>(config.batch);
  std::size_t wanted = std::max(pictures, static_cast<std::size_t>(config.epoch_pictures));
  wanted = (wanted + batch - 1) / batch * batch;
  const RandomStream random(config.seed, "train", "order", epoch);
  std::vector<std::size_t> order, round(pictures);
  std::iota(round.begin(), round.end(), std::size_t{0});
  for (std::uint32_t r = 0; order.size() < wanted; ++r) {
    for (std::size_t i = pictures - 1; i > 0; --i) {
      std::swap(round[i], round[static_cast<std::size_t>(random.uniform(i, r) * static_cast<double>(i + 1))]);
    }
    order.insert(order.end(), round.begin(), round.begin() + static_cast<std::ptrdiff_t>(std::min(pictures, wanted - order.size())));
  }
  return order;
}

EpochLoader::EpochLoader(PictureCache& cache, const TrainConfig& config, int epoch, const EpochStyle& style)
    : cache_(cache), config_(config), epoch_(epoch), style_(style), order_(epoch_order(cache.count(), config, epoch)) {}

std::optional<std::vector<Sample>> EpochLoader::next() {
  if (given_ == order_.size()) return std::nullopt;
  const RandomStream random(config_.seed, "train", "augment", epoch_);
  std::vector<Sample> batch(static_cast<std::size_t>(config_.batch));
  parallel_for(batch.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Dice dice(random, given_ + i);
      batch[i] = augmented([this](std::size_t index) { return cache_.get(index); }, cache_.count(), order_[given_ + i], style_.size,
                           config_.augment, style_.late, dice);
    }
  });
  given_ += batch.size();
  return batch;
}

}  // namespace waretwin::train

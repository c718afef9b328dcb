#include "harness/train/epoch_loader.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "core/random.h"
#include "harness/train/augment.h"

namespace waretwin::train {
namespace {

constexpr std::size_t kAhead = 4;  // batches

}  // namespace

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
    : cache_(cache), config_(config), epoch_(epoch), style_(style), order_(epoch_order(cache.count(), config, epoch)), worker_([this] {
        work();
      }) {}

EpochLoader::~EpochLoader() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  worker_.join();
}

std::vector<Sample> EpochLoader::make(std::size_t step) {
  const RandomStream random(config_.seed, "train", "augment", epoch_);
  std::vector<Sample> batch;
  for (std::size_t i = step * config_.batch; i < (step + 1) * config_.batch; ++i) {
    Dice dice(random, i);
    batch.push_back(augmented([this](std::size_t index) { return cache_.get(index); }, cache_.count(), order_[i], style_.size,
                              config_.augment, style_.late, dice));
  }
  return batch;
}

void EpochLoader::work() {
  try {
    for (int step = 0; step < steps(); ++step) {
      std::vector<Sample> batch = make(step);
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return stop_ || ready_.size() < kAhead; });
      if (stop_) return;
      ready_.push_back(std::move(batch));
      changed_.notify_all();
    }
  } catch (...) {
    const std::lock_guard lock(mutex_);
    failure_ = std::current_exception();
    changed_.notify_all();
  }
}

std::optional<std::vector<Sample>> EpochLoader::next() {
  std::unique_lock lock(mutex_);
  if (given_ == steps()) return std::nullopt;
  changed_.wait(lock, [this] { return failure_ || !ready_.empty(); });
  if (ready_.empty()) std::rethrow_exception(failure_);
  std::vector<Sample> batch = std::move(ready_.front());
  ready_.pop_front();
  ++given_;
  changed_.notify_all();
  return batch;
}

}  // namespace waretwin::train

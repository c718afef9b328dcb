// The batches of an epoch.
#pragma once

#include <optional>
#include <vector>

#include "harness/train/picture_cache.h"
#include "harness/train/train_config.h"

namespace waretwin::train {

// Which pictures an epoch shows, in order: each one once, a set below epoch_pictures as often as that takes; the last batch is full.
std::vector<std::size_t> epoch_order(std::size_t pictures, const TrainConfig& config, int epoch);

// How an epoch shows its pictures.
struct EpochStyle {
  cv::Size size;
  bool late = false;  // see augmented()
};

class EpochLoader {
 public:
  // What epoch and place in it give is the same whatever came before.
  EpochLoader(PictureCache& cache, const TrainConfig& config, int epoch, const EpochStyle& style);

  // Nothing after the last batch. All threads make it, and libtorch's rest: one that made pictures beside a step would take the processor
  // from threads that wait for each other many times. Throws what reading a picture threw.
  std::optional<std::vector<Sample>> next();

 private:
  PictureCache& cache_;
  const TrainConfig config_;
  const int epoch_;
  const EpochStyle style_;
  const std::vector<std::size_t> order_;
  std::size_t given_ = 0;  // pictures
};

}  // namespace waretwin::train

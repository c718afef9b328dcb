// The batches of an epoch, made beside the training.
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>

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
  // What epoch and place in it give is the same whatever came before. While it lives, nobody else uses the cache.
  EpochLoader(PictureCache& cache, const TrainConfig& config, int epoch, const EpochStyle& style);
  ~EpochLoader();
  EpochLoader(const EpochLoader&) = delete;
  EpochLoader& operator=(const EpochLoader&) = delete;

  int steps() const { return static_cast<int>(order_.size()) / config_.batch; }
  // Nothing after the last batch. Throws what reading a picture threw.
  std::optional<std::vector<Sample>> next();

 private:
  void work();
  std::vector<Sample> make(std::size_t step);

  PictureCache& cache_;
  const TrainConfig config_;
  const int epoch_;
  const EpochStyle style_;
  const std::vector<std::size_t> order_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::vector<Sample>> ready_;
  std::exception_ptr failure_;
  int given_ = 0;
  bool stop_ = false;
  std::thread worker_;  // last: starts when all else is there
};

}  // namespace waretwin::train

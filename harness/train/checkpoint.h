// Where a training stands, so that a killed one goes on from its last epoch.
#pragma once

#include <ATen/ATen.h>

#include <filesystem>
#include <string>
#include <vector>

namespace waretwin::train {

struct Checkpoint {
  std::string config;  // what the training depends on; must be the same to go on
  std::string log;     // log.csv so far
  std::int64_t epochs_done = 0, steps = 0, best_epoch = -1, best_is_late = 0;
  std::int64_t patience_from = 0;                                                        // the epoch that patience is counted from
  double best_fitness = -1.0, best_ap50 = 0.0, seconds = 0.0, validation_seconds = 0.0;  // the last one: of the last epoch
  std::string best_weights;                                                              // bytes of the weights file of the best epoch
  std::vector<at::Tensor> tensors;                                                       // network, average, optimiser
};

// Atomic.
void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint);
// `checkpoint.tensors` holds tensors of the expected shapes, which are written into. Throws Error for a file that is no checkpoint, is
// truncated, or belongs to another network.
void read_checkpoint(const std::filesystem::path& file, Checkpoint& checkpoint);
// What stands before the tensors, and so which network they belong to.
std::string checkpoint_config(const std::filesystem::path& file);

}  // namespace waretwin::train

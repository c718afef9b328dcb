// A detector that a training starts from, instead of from drawn weights.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/train/network.h"

namespace waretwin::train {

struct StartModel {
  std::string given;             // what the user called it
  std::filesystem::path folder;  // that holds its files
  std::vector<std::string> classes;
  Network network;
  std::string digest;  // of the weights file
};

// `model`: what a detector may be called (mapper/detect/model_files.h). Throws Error where it is no detector that `waretwin train` made.
StartModel read_start_model(const std::string& model);

// Gives `network`, whose classes are `classes`, the model's weights; its anchors must be the model's. A class that the model does not know
// keeps its drawn weights. Variances are 1 afterwards (Network::unfold_statistics).
void start_from(const StartModel& model, const std::vector<std::string>& classes, Network& network);

}  // namespace waretwin::train

// Darknet itself (Debian's package), to hold exported networks against.
#pragma once

#include <filesystem>
#include <vector>

#include "harness/train/region_boxes.h"

namespace waretwin::test {

struct DarknetAnswer {
  std::vector<float> raw;               // what the last convolution gives
  std::vector<train::ScoredBox> boxes;  // of at least `score`, before any suppression
};

// `input`: channel by channel, RGB from 0 to 1, of the network's size.
DarknetAnswer ask_darknet(const std::filesystem::path& cfg, const std::filesystem::path& weights, std::vector<float> input, float score);

}  // namespace waretwin::test

// The detector's layers, as a list that the trained network and its Darknet description are both made from.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "harness/train/anchors.h"

namespace waretwin::train {

struct LayerPlan {
  enum class Kind { kConvolution, kUpsample, kRoute, kShortcut };
  Kind kind = Kind::kConvolution;
  int channels = 0;               // that come out
  int size = 3, stride = 1;       // of a convolution, padded by size / 2
  bool normalised = true;         // batch normalisation and leaky slope 0.1; otherwise a bias alone
  std::vector<int> sources = {};  // of a route: layers whose channels are put one after the other; of a shortcut: the one layer it adds
};

struct NetworkPlan {
  int width = 0, height = 0;  // of the input in pixels, multiples of 32; three channels, RGB from 0 to 1
  int classes = 0;
  std::vector<BoxShape> anchors;  // in cells
  std::vector<LayerPlan> layers;  // the last one's channels are, for each anchor, x, y, w, h, objectness and the classes

  static constexpr int kCell = 16;  // pixels
  int columns() const { return width / kCell; }
  int rows() const { return height / kCell; }
  int numbers() const { return 5 + classes; }  // an anchor
};

// About a million weights. Darknet's residual blocks (half the channels by 1 x 1, then 3 x 3, added to what came in) from an eighth of the
// input down to a 32nd, whose wide view is laid over the finer 16th that the boxes are read from. Only convolutions with stride, where
// OpenCV and Darknet agree for every size, and no pooling or reorg, where they need not.
NetworkPlan plan_network(int width, int height, int classes, const std::vector<BoxShape>& anchors);

// Channels that go into a layer.
int input_channels(const NetworkPlan& plan, std::size_t layer);
// Numbers in the weights file.
std::int64_t parameter_count(const NetworkPlan& plan);
// The description that Darknet and OpenCV read.
std::string darknet_cfg(const NetworkPlan& plan);

}  // namespace waretwin::train

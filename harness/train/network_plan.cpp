#include "harness/train/network_plan.h"

#include <cstdio>

#include "core/error.h"

namespace waretwin::train {
namespace {

LayerPlan convolution(int channels, int size, int stride = 1) { return {LayerPlan::Kind::kConvolution, channels, size, stride}; }

void add_residual_blocks(std::vector<LayerPlan>& layers, int count, int inner_channels) {
  for (int i = 0; i < count; ++i) {
    const int from = static_cast<int>(layers.size()) - 1, channels = layers.back().channels;
    layers.push_back(convolution(inner_channels, 1));
    layers.push_back(convolution(channels, 3));
    layers.push_back({.kind = LayerPlan::Kind::kShortcut, .channels = channels, .sources = {from}});
  }
}

std::string convolution_cfg(const LayerPlan& layer) {
  return "[convolutional]\n" + std::string(layer.normalised ? "batch_normalize=1\n" : "") + "filters=" + std::to_string(layer.channels) +
         "\nsize=" + std::to_string(layer.size) + "\nstride=" + std::to_string(layer.stride) +
         "\npad=1\nactivation=" + (layer.normalised ? "leaky" : "linear") + "\n\n";
}

std::string list_of(const std::vector<int>& numbers) {
  std::string text;
  for (const int number : numbers) text += (text.empty() ? "" : ",") + std::to_string(number);
  return text;
}

}  // namespace

NetworkPlan plan_network(int width, int height, int classes, const std::vector<BoxShape>& anchors) {
  WARETWIN_CHECK(width % 32 == 0 && height % 32 == 0, "upsampling must meet the finer layer");
  NetworkPlan plan{width, height, classes, anchors, {}};
  std::vector<LayerPlan>& layers = plan.layers;
  layers = {convolution(16, 3, 2), convolution(32, 3, 2), convolution(64, 3, 2)};
  add_residual_blocks(layers, 1, 32);
  layers.push_back(convolution(128, 3, 2));
  add_residual_blocks(layers, 2, 64);
  const int fine = static_cast<int>(layers.size()) - 1;
  layers.push_back(convolution(128, 3, 2));
  add_residual_blocks(layers, 4, 64);
  layers.push_back(convolution(96, 1));
  layers.push_back({LayerPlan::Kind::kUpsample, 96});
  const int wide = static_cast<int>(layers.size()) - 1;
  layers.push_back({.kind = LayerPlan::Kind::kRoute, .channels = 96 + 128, .sources = {wide, fine}});
  layers.push_back(convolution(96, 1));
  layers.push_back(convolution(128, 3));
  layers.push_back(convolution(static_cast<int>(anchors.size()) * plan.numbers(), 1));
  layers.back().normalised = false;
  return plan;
}

int input_channels(const NetworkPlan& plan, std::size_t layer) { return layer == 0 ? 3 : plan.layers[layer - 1].channels; }

std::int64_t parameter_count(const NetworkPlan& plan) {
  std::int64_t count = 0;
  for (std::size_t i = 0; i < plan.layers.size(); ++i) {
    const LayerPlan& layer = plan.layers[i];
    if (layer.kind != LayerPlan::Kind::kConvolution) continue;
    count += std::int64_t{layer.channels} * (input_channels(plan, i) * layer.size * layer.size + (layer.normalised ? 4 : 1));
  }
  return count;
}

std::string darknet_cfg(const NetworkPlan& plan) {
  std::string text = "[net]\nbatch=1\nsubdivisions=1\nwidth=" + std::to_string(plan.width) + "\nheight=" + std::to_string(plan.height) +
                     "\nchannels=3\nmomentum=0.9\ndecay=0.0005\nlearning_rate=0.001\nmax_batches=1\n\n";
  for (const LayerPlan& layer : plan.layers) {
    switch (layer.kind) {
      case LayerPlan::Kind::kConvolution:
        text += convolution_cfg(layer);
        break;
      case LayerPlan::Kind::kUpsample:
        text += "[upsample]\nstride=2\n\n";
        break;
      case LayerPlan::Kind::kRoute:
        text += "[route]\nlayers=" + list_of(layer.sources) + "\n\n";
        break;
      case LayerPlan::Kind::kShortcut:
        text += "[shortcut]\nfrom=" + list_of(layer.sources) + "\nactivation=linear\n\n";
        break;
    }
  }
  std::string anchors;
  for (const BoxShape& anchor : plan.anchors) {
    char number[64];
    std::snprintf(number, sizeof number, "%s%.6g,%.6g", anchors.empty() ? "" : ", ", anchor.width, anchor.height);
    anchors += number;
  }
  // No `thresh`: Darknet means the IoU of ignored predictions in training by it, OpenCV the least score.
  text += "[region]\nanchors=" + anchors + "\nbias_match=1\nclasses=" + std::to_string(plan.classes) +
          "\ncoords=4\nnum=" + std::to_string(plan.anchors.size()) + "\nsoftmax=1\nrescore=1\nabsolute=1\nrandom=0\n";
  return text;
}

}  // namespace waretwin::train

#include "harness/train/network.h"

#include <cmath>
#include <string>

#include "core/random.h"

namespace waretwin::train {
namespace {

at::Tensor drawn_weights(const LayerPlan& layer, int inputs, std::uint64_t seed, std::size_t number, double spread) {
  const RandomStream random(seed, "layer " + std::to_string(number), "weights");
  at::Tensor weight = at::empty({layer.channels, inputs, layer.size, layer.size});
  float* const values = weight.data_ptr<float>();
  for (std::int64_t i = 0; i < weight.numel(); ++i) values[i] = static_cast<float>(spread * random.normal(i));
  return weight.contiguous(at::MemoryFormat::ChannelsLast);
}

// `x`: what the layer's normalisation takes. Its variance is the unbiased one, as libtorch follows it.
void unfold(const at::Tensor& x, const Network::Parameters& p) {
  const at::Tensor variance = x.var(std::vector<std::int64_t>{0, 2, 3}, true);
  at::Tensor scale = p.scale;
  scale.mul_(((variance + Network::kEpsilon) / (p.variance + Network::kEpsilon)).sqrt());
  at::Tensor kept = p.variance;
  kept.copy_(variance);
}

}  // namespace

Network::Network(const NetworkPlan& plan, std::uint64_t seed) : plan_(plan), layers_(plan.layers.size()) {
  for (std::size_t i = 0; i < plan.layers.size(); ++i) {
    const LayerPlan& layer = plan.layers[i];
    if (layer.kind != LayerPlan::Kind::kConvolution) continue;
    const int inputs = input_channels(plan, i);
    const double spread = layer.normalised ? std::sqrt(2.0 / ((1.0 + kSlope * kSlope) * inputs * layer.size * layer.size)) : 0.01;
    Parameters& parameters = layers_[i];
    parameters.weight = drawn_weights(layer, inputs, seed, i, spread);
    parameters.bias = at::zeros({layer.channels});
    if (layer.normalised) {
      parameters.scale = at::ones({layer.channels});
      parameters.mean = at::zeros({layer.channels});
      parameters.variance = at::ones({layer.channels});
    } else {
      // Nearly every cell is empty: starting from a chance of 0.25 % spares the first steps.
      parameters.bias.view({static_cast<std::int64_t>(plan.anchors.size()), plan.numbers()}).select(1, 4).fill_(-6.0);
    }
  }
  for (const at::Tensor& tensor : learned()) tensor.set_requires_grad(true);
}

void Network::renew_statistics(const at::Tensor& pictures, int index) {
  const at::NoGradGuard no_gradients;
  forward(pictures, {.training = true, .momentum = 1.0 / (index + 1)});
}

void Network::unfold_statistics(const at::Tensor& pictures) {
  const at::NoGradGuard no_gradients;
  forward(pictures, {.unfolding = true});
}

at::Tensor Network::forward(const at::Tensor& pictures, const Pass& pass) {
  std::vector<at::Tensor> outputs;
  at::Tensor x = pictures.to(pass.type);
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    const LayerPlan& layer = plan_.layers[i];
    const Parameters& p = layers_[i];
    switch (layer.kind) {
      case LayerPlan::Kind::kConvolution:
        if (!layer.normalised) {
          x = at::conv2d(x.to(at::kFloat), p.weight, p.bias, layer.stride, layer.size / 2);
        } else {
          x = at::conv2d(x, p.weight.to(pass.type), {}, layer.stride, layer.size / 2);
          if (pass.unfolding) unfold(x, p);
          x = at::batch_norm(x, p.scale, p.bias, p.mean, p.variance, pass.training, pass.momentum, kEpsilon, false);
          at::leaky_relu_(x, kSlope);
        }
        break;
      case LayerPlan::Kind::kUpsample:
        x = at::upsample_nearest2d(x, {2 * x.size(2), 2 * x.size(3)});
        break;
      case LayerPlan::Kind::kRoute: {
        std::vector<at::Tensor> sources;
        for (const int source : layer.sources) sources.push_back(outputs[static_cast<std::size_t>(source)]);
        x = at::cat(sources, 1);
        break;
      }
      case LayerPlan::Kind::kShortcut:
        x = x + outputs[static_cast<std::size_t>(layer.sources.front())];
        break;
    }
    outputs.push_back(x);
  }
  return x;
}

std::vector<at::Tensor> Network::learned() const {
  std::vector<at::Tensor> tensors;
  for (const Parameters& p : layers_) {
    for (const at::Tensor& tensor : {p.weight, p.bias, p.scale}) {
      if (tensor.defined()) tensors.push_back(tensor);
    }
  }
  return tensors;
}

std::vector<at::Tensor> Network::followed() const {
  std::vector<at::Tensor> tensors;
  for (const Parameters& p : layers_) {
    for (const at::Tensor& tensor : {p.mean, p.variance}) {
      if (tensor.defined()) tensors.push_back(tensor);
    }
  }
  return tensors;
}

void follow_average(Network& target, const Network& source, double decay) {
  const at::NoGradGuard no_gradients;
  const auto follow = [&](const std::vector<at::Tensor>& to, const std::vector<at::Tensor>& from) {
    for (std::size_t i = 0; i < to.size(); ++i) to[i].mul_(decay).add_(from[i], 1.0 - decay);
  };
  follow(target.learned(), source.learned());
  follow(target.followed(), source.followed());
}

}  // namespace waretwin::train

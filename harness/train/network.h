// The detector as libtorch computes it.
#pragma once

#include <ATen/ATen.h>

#include <cstdint>
#include <vector>

#include "harness/train/network_plan.h"

namespace waretwin::train {

class Network {
 public:
  // Weights drawn as He et al. (2015) say, from the seed alone.
  Network(const NetworkPlan& plan, std::uint64_t seed);

  // (N, 3, height, width), RGB from 0 to 1, to (N, anchors * (5 + classes), rows, columns), as a detector computes it.
  at::Tensor detect(const at::Tensor& pictures) { return forward(pictures, {}); }

  // The same for learning: batch normalisation takes the batch's own statistics and follows them. What the normalised layers take and give
  // has the given type (float32 or bfloat16), and so have gradients on their way; the weights that are kept and changed, statistics and the
  // last layer are float32 (mixed precision, Micikevicius et al. 2018).
  at::Tensor learn(const at::Tensor& pictures, at::ScalarType type) { return forward(pictures, {true, kStatisticsMomentum, type}); }

  // Finds means and variances anew for the present weights, as the mean over batches: what follows a training is not quite theirs. Call
  // with index 0, 1, 2 ... for each batch.
  void renew_statistics(const at::Tensor& pictures, int index);

  // Finds variances anew and changes the scales against them, so that detect() gives what it gave. Weights files have the variances folded
  // into the scales, where learn(), which divides by a batch's own, would count them twice.
  void unfold_statistics(const at::Tensor& pictures);

  const NetworkPlan& plan() const { return plan_; }

  struct Parameters {                  // of a convolution; those that its kind does not have are undefined
    at::Tensor weight;                 // (out, in, size, size)
    at::Tensor bias;                   // of the last layer, or batch normalisation's shift
    at::Tensor scale, mean, variance;  // batch normalisation
  };
  const std::vector<Parameters>& layers() const { return layers_; }  // one a layer of the plan

  std::vector<at::Tensor> learned() const;   // what gradients change: by layer weight, bias, scale
  std::vector<at::Tensor> followed() const;  // means and variances

  static constexpr double kEpsilon = 1e-5;  // beside the variance
  static constexpr double kSlope = 0.1;     // below zero

 private:
  static constexpr double kStatisticsMomentum = 0.05;
  struct Pass {
    bool training = false;
    double momentum = 0.0;  // of followed statistics
    at::ScalarType type = at::kFloat;
    bool unfolding = false;  // see unfold_statistics
  };
  at::Tensor forward(const at::Tensor& pictures, const Pass& pass);

  NetworkPlan plan_;
  std::vector<Parameters> layers_;
};

// target = decay * target + (1 - decay) * source, for everything that the network holds.
void follow_average(Network& target, const Network& source, double decay);

}  // namespace waretwin::train

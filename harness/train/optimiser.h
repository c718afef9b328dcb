// AdamW (Loshchilov and Hutter 2019).
#pragma once

#include <ATen/ATen.h>

#include <vector>

namespace waretwin::train {

class Optimiser {
 public:
  // Matrices and kernels decay, biases and scales do not.
  Optimiser(std::vector<at::Tensor> parameters, double weight_decay);

  // Takes the gradients, cut to a norm of `largest_gradient` in all, and forgets them.
  void step(double rate, double largest_gradient);

  // First and second moments, to be saved and written back into.
  std::vector<at::Tensor> state() const;
  std::int64_t steps = 0;

 private:
  std::vector<at::Tensor> parameters_, first_, second_;
  double weight_decay_;
};

}  // namespace waretwin::train

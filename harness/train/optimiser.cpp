#include "harness/train/optimiser.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace waretwin::train {

Optimiser::Optimiser(std::vector<at::Tensor> parameters, double weight_decay)
    : parameters_(std::move(parameters)), weight_decay_(weight_decay) {
  for (const at::Tensor& parameter : parameters_) {
    first_.push_back(at::zeros_like(parameter).detach());
    second_.push_back(at::zeros_like(parameter).detach());
  }
}

std::vector<at::Tensor> Optimiser::state() const {
  std::vector<at::Tensor> state = first_;
  state.insert(state.end(), second_.begin(), second_.end());
  return state;
}

void Optimiser::step(double rate, double largest_gradient) {
  const at::NoGradGuard no_gradients;
  constexpr double kFirst = 0.9, kSecond = 0.99, kEpsilon = 1e-8;
  ++steps;
  double square = 0.0;
  for (const at::Tensor& parameter : parameters_) {
    if (parameter.grad().defined()) square += parameter.grad().square().sum().item<double>();
  }
  const double cut = std::min(1.0, largest_gradient / (std::sqrt(square) + 1e-12));
  const auto t = static_cast<double>(steps);
  const double first_bias = 1.0 - std::pow(kFirst, t), second_bias = 1.0 - std::pow(kSecond, t);
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    at::Tensor& parameter = parameters_[i];
    if (!parameter.grad().defined()) continue;
    const at::Tensor gradient = parameter.grad() * cut;
    first_[i].mul_(kFirst).add_(gradient, 1.0 - kFirst);
    second_[i].mul_(kSecond).addcmul_(gradient, gradient, 1.0 - kSecond);
    if (parameter.dim() > 1) parameter.mul_(1.0 - rate * weight_decay_);
    parameter.addcdiv_(first_[i], (second_[i] / second_bias).sqrt_().add_(kEpsilon), -rate / first_bias);
    parameter.mutable_grad().reset();
  }
}

}  // namespace waretwin::train

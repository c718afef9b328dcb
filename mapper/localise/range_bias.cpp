#include "mapper/localise/range_bias.h"

#include <cmath>

namespace waretwin {
namespace {

// Keyframes see much of the same surfaces, and so do not tell something new each.
constexpr double kIndependent = 0.5;

}  // namespace

double RangeBias::standard_deviation() const { return 1.0 / std::sqrt(prior_information_ + information_); }

void RangeBias::take(const MapMatch& match) {
  if (!enabled_ || !match.believable) return;
  information_ += kIndependent * match.bias_information;
  vector_ += kIndependent * match.bias_vector;
}

double RangeBias::change() const { return enabled_ ? (vector_ - prior_information_ * value_) / (prior_information_ + information_) : 0.0; }

void RangeBias::step() {
  value_ += change();
  information_ = vector_ = 0.0;
}

}  // namespace waretwin

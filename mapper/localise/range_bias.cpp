#include "mapper/localise/range_bias.h"

#include <cmath>

namespace waretwin {
namespace {

// Neighbouring beams err together where they meet the same unevenness: each match counts for less than its beams.
constexpr double kIndependent = 0.2;

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

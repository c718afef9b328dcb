// The laser's constant range error as a state: one number, estimated from the matches of keyframes.
#pragma once

#include "mapper/localise/map_matcher.h"

namespace waretwin {

// A wall seen at another angle of incidence than before moves by the difference of the cosines times the error; many walls, and the same
// walls from many places, tell it to a millimetre. Gaussian, with mean 0 and a standard deviation beforehand.
class RangeBias {
 public:
  RangeBias(bool enabled, double sd_m) : enabled_(enabled), prior_information_(1.0 / (sd_m * sd_m)) {}

  // Metres, to be taken off each range. 0 while it is not estimated.
  double value() const { return value_; }
  double standard_deviation() const;

  // Takes what a match at the present value says (MapMatch::bias_information, bias_vector).
  void take(const MapMatch& match);
  // How far the best value is away from the present one.
  double change() const;
  // Goes to the best value and forgets the matches, which were made at the old one.
  void step();

 private:
  bool enabled_;
  double prior_information_;
  double value_ = 0.0;
  double information_ = 0.0, vector_ = 0.0;
};

}  // namespace waretwin

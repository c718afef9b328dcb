// Pictures changed at random, so that few of them teach more.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/random.h"
#include "harness/train/sample.h"
#include "harness/train/train_config.h"

namespace waretwin::train {

// Random numbers of one sample, one after the other.
class Dice {
 public:
  Dice(const RandomStream& stream, std::uint64_t sample) : stream_(stream), sample_(sample) {}
  double between(double least, double most) { return least + (most - least) * stream_.uniform(sample_, draw_++); }
  bool chance(double share) { return between(0.0, 1.0) < share; }
  // From `least` to `most`, both positive, as likely to grow as to shrink.
  double factor(double least, double most) { return std::exp(between(std::log(least), std::log(most))); }
  std::uint64_t number() { return stream_.words(sample_, draw_++)[0]; }

 private:
  const RandomStream& stream_;
  std::uint64_t sample_;
  std::uint32_t draw_ = 0;
};

// A picture of any size, CV_8UC3 in RGB, whose boxes are shares of it.
using PictureSource = std::function<Sample(std::size_t index)>;

// Lays picture `first` (in a mosaic with three more out of `count`) into the network's input of `size`, moved, zoomed and mirrored, and
// changes colours and sharpness. Boxes follow; those of which too little is left are marked as ignored. `late`, towards the end of a
// training, there are no mosaics, and half of the pictures are shown whole.
Sample augmented(const PictureSource& source, std::size_t count, std::size_t first, const cv::Size& size, const AugmentConfig& config,
                 bool late, Dice& dice);

}  // namespace waretwin::train

// A trained network as Darknet's weights file.
#pragma once

#include <string>

#include "harness/train/network.h"

namespace waretwin::train {

// Version 0.2: the count of pictures seen has 64 bits. Of a normalised convolution bias, scale, mean and variance come before the kernels.
// Darknet adds 1e-6 to the deviation, OpenCV 1e-6 to the variance, libtorch 1e-5: all scales are written for a variance of 1, where none of
// that is seen. `object_shift` is added to every objectness before its logistic function: it moves all scores, and none past another.
std::string darknet_weights(const Network& network, std::int64_t pictures_seen, double object_shift = 0.0);

// The other way round. Variances are 1, folded into the scales: before learning, Network::unfold_statistics. Throws Error for bytes that
// are not of this network.
void read_darknet_weights(const std::string& bytes, Network& network);

}  // namespace waretwin::train

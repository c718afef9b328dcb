// Settings of a training: network, loss, learning, augmentation.
#pragma once

#include <cstdint>
#include <opencv2/core/types.hpp>
#include <string>

#include "core/fields.h"

namespace waretwin::train {

struct AugmentConfig {
  double flip = 0.5;  // chance
  double zoom_least = 0.7, zoom_most = 1.7;
  double aspect = 0.2;        // width against height changes by up to this share
  double mosaic = 0.4;        // chance
  double plain_share = 0.15;  // of the training, at its end, without mosaics and with whole pictures
  double hue_deg = 12.0;
  double saturation = 0.5, exposure = 0.5;
  double blur = 0.15, noise = 0.3;  // chances
  double noise_sigma = 8.0;         // of 255
  double cut_out = 0.3;             // chance
  double kept_share = 0.3;          // of a box's area

  void visit(Fields& f);
};

struct TrainConfig {
  int width = 576, height = 320;  // of the network's input
  int anchors = 5;
  int epochs = 0;        // 0: about 54,000 pictures in all
  double minutes = 0.0;  // 0: no limit
  int epoch_pictures = 800;
  int patience = 50;  // epochs
  std::uint64_t seed = 1;
  int batch = 8;
  double learning_rate = 0.003, final_rate = 0.02;
  int warm_up = 200;                             // steps
  double small_share = 0.5, small_scale = 0.67;  // of the training, at its start; of the input's sides
  std::string precision = "auto";                // float32, bfloat16
  double weight_decay = 0.05;
  double average_decay = 0.999;
  double largest_gradient = 10.0;
  double box_weight = 5.0, object_weight = 1.0, class_weight = 1.0;
  double anchor_iou = 0.5, ignore_iou = 0.5;
  double cache_mb = 4000.0, cache_scale = 1.5;
  AugmentConfig augment;

  // The input while pictures are small, multiples of 32.
  cv::Size small_size() const;
  void visit(Fields& f);
};

}  // namespace waretwin::train

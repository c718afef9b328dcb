// The loss of a region layer (Redmon and Farhadi 2017) with boxes by complete IoU (Zheng et al. 2020).
#pragma once

#include <ATen/ATen.h>

#include <vector>

#include "harness/train/network_plan.h"
#include "harness/train/sample.h"
#include "harness/train/train_config.h"

namespace waretwin::train {

struct RegionLoss {
  at::Tensor total;  // weighted, with gradients; a scalar
  double box = 0.0, object = 0.0, classes = 0.0;
};

// `output` as Network::learn gives it; `truth` holds a picture's boxes each. An object is learned by the cell that holds its centre: by
// the anchor of the best shape and by those that reach anchor_iou. Their objectness learns the IoU that the box has, all others 0, except
// where a prediction overlaps an object by ignore_iou or lies half in an ignored box.
RegionLoss region_loss(const at::Tensor& output, const std::vector<std::vector<TruthBox>>& truth, const NetworkPlan& plan,
                       const TrainConfig& config);

}  // namespace waretwin::train

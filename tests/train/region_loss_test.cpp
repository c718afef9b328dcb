#include "harness/train/region_loss.h"

#include <gtest/gtest.h>

#include <cmath>

namespace waretwin::train {
namespace {

NetworkPlan small_plan(int classes) { return plan_network(64, 32, classes, {{1, 1}, {2, 1}}); }

at::Tensor drawn_output(const NetworkPlan& plan, std::int64_t pictures, double spread) {
  const std::int64_t channels = static_cast<std::int64_t>(plan.anchors.size()) * plan.numbers();
  at::Tensor output = at::empty({pictures, channels, plan.rows(), plan.columns()});
  float* const values = output.data_ptr<float>();
  for (std::int64_t i = 0; i < output.numel(); ++i) values[i] = static_cast<float>(spread * std::sin(1.7 * static_cast<double>(i) + 0.3));
  return output;
}

const std::vector<std::vector<TruthBox>> kTruth = {{{0, {0.1f, 0.2f, 0.3f, 0.5f}, false}, {1, {0.55f, 0.1f, 0.4f, 0.8f}, false}}, {}};

TEST(RegionLoss, GradientsAreThoseOfSmallSteps) {
  const NetworkPlan plan = small_plan(2);
  TrainConfig config;
  config.ignore_iou = 1.0;
  // What is learned without gradients through its goal: objectness (its goal moves with the boxes), and the weight of the aspect.
  config.object_weight = 0.0;
  const at::Tensor output = drawn_output(plan, 2, 0.5).set_requires_grad(true);
  region_loss(output, kTruth, plan, config).total.backward();
  const at::Tensor gradient = output.grad();
  EXPECT_GT(gradient.abs().max().item<double>(), 0.01);
  const at::NoGradGuard no_gradients;
  const float step = 1e-2f;
  for (std::int64_t i = 0; i < output.numel(); i += 1) {
    if (std::abs(gradient.view(-1)[i].item<float>()) < 1e-3f) continue;
    const auto at_offset = [&](float offset) {
      at::Tensor moved = output.clone();
      moved.view(-1)[i] += offset;
      return region_loss(moved, kTruth, plan, config).total.item<double>();
    };
    const double slope = (at_offset(step) - at_offset(-step)) / (2.0 * step), claimed = gradient.view(-1)[i].item<double>();
    EXPECT_NEAR(claimed, slope, 0.05 * std::abs(claimed) + 0.01) << i;
  }
}

TEST(RegionLoss, IsSmallWhereAllIsRight) {
  const NetworkPlan plan = small_plan(2);
  const TrainConfig config;
  // Cell (1, 2), anchor 1: a centre in the cell's middle, twice as wide as its anchor.
  const std::vector<std::vector<TruthBox>> truth = {{{1, {(2.5f - 2) / 4, (1.5f - 0.5f) / 2, 4.0f / 4, 1.0f / 2}, false}}};
  at::Tensor output = at::zeros({1, 14, 2, 4});
  at::Tensor objects = output.view({2, 7, 2, 4}).select(1, 4);
  objects.fill_(-12);
  at::Tensor right = output.view({2, 7, 2, 4})[1].select(1, 1).select(1, 2);
  right[2] = std::log(2.0);
  right[4] = 12.0;
  right[6] = 12.0;
  const RegionLoss loss = region_loss(output, truth, plan, config);
  EXPECT_NEAR(loss.box, 0.0, 1e-4);
  EXPECT_NEAR(loss.object, 0.0, 1e-3);
  EXPECT_NEAR(loss.classes, 0.0, 1e-4);
}

TEST(RegionLoss, IgnoredBoxesAreNoMistakes) {
  const NetworkPlan plan = small_plan(1);
  const TrainConfig config;
  at::Tensor output = at::full({1, 12, 2, 4}, 0.0);
  const double without = region_loss(output, {{}}, plan, config).object;
  const double with = region_loss(output, {{{0, {0, 0, 1, 1}, true}}}, plan, config).object;
  EXPECT_NEAR(without, 16 * std::log(2.0), 1e-4);
  EXPECT_EQ(with, 0.0);
}

}  // namespace
}  // namespace waretwin::train

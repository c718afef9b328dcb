// A training that starts from a detector.
#include "harness/train/start_model.h"

#include <gtest/gtest.h>

#include "core/files.h"
#include "core/random.h"
#include "harness/train/darknet_weights.h"
#include "tests/support/expect_error.h"
#include "tests/support/test_data.h"

namespace waretwin::train {
namespace {

namespace fs = std::filesystem;

at::Tensor drawn_pictures() {
  const RandomStream random(5, "start_model_test", "pictures");
  at::Tensor values = at::empty({4, 3, 96, 160});
  for (std::int64_t i = 0; i < values.numel(); ++i) values.data_ptr<float>()[i] = static_cast<float>(random.uniform(i / 5));
  return values;
}

double largest_difference(const at::Tensor& a, const at::Tensor& b) { return (a - b).abs().max().item<double>(); }

class Start : public ::testing::Test {
 protected:
  Start() : plan_(plan_network(160, 96, 2, {{1.5, 1}, {2, 3}, {5, 3}})), taught_(plan_, 3) {
    const at::NoGradGuard no_gradients;
    // Scales, shifts and statistics as after a training.
    for (const Network::Parameters& p : taught_.layers()) {
      if (!p.scale.defined()) continue;
      at::Tensor scale = p.scale, bias = p.bias;
      scale.copy_(at::linspace(0.5, 2.0, scale.numel()));
      bias.copy_(at::linspace(-0.5, 0.5, bias.numel()));
    }
    taught_.renew_statistics(pictures_, 0);
    taught_.renew_statistics(pictures_, 0);
    write_file(folder_.path() / "net.cfg", darknet_cfg(plan_));
    write_file(folder_.path() / "net.weights", darknet_weights(taught_, 1));
    write_file(folder_.path() / "net.names", "box\nbelt\n");
  }

  StartModel model() const { return read_start_model(folder_.path().string()); }

  NetworkPlan plan_;
  Network taught_;
  at::Tensor pictures_ = drawn_pictures();
  test::TemporaryFolder folder_;
};

TEST_F(Start, SeesWhatTheDetectorSaw) {
  const at::NoGradGuard no_gradients;
  Network network(plan_, 4);
  const at::Tensor wanted = taught_.detect(pictures_);
  EXPECT_GT(largest_difference(network.detect(pictures_), wanted), 1.0);
  start_from(model(), {"box", "belt"}, network);
  EXPECT_LT(largest_difference(network.detect(pictures_), wanted), 1e-4);
}

TEST_F(Start, LearnsFromWhereTheDetectorWas) {
  const at::NoGradGuard no_gradients;
  Network network(plan_, 4);
  start_from(model(), {"box", "belt"}, network);
  const at::Tensor wanted = taught_.learn(pictures_, at::kFloat);
  // Scales that hold the variances are divided by the batch's once more: the reason for unfolding.
  const double folded = largest_difference(network.learn(pictures_, at::kFloat), wanted);
  EXPECT_GT(folded, 0.1);
  start_from(model(), {"box", "belt"}, network);
  network.unfold_statistics(pictures_);
  EXPECT_LT(largest_difference(network.detect(pictures_), taught_.detect(pictures_)), 0.1);
  // Not to the last digit: detection divides by the unbiased variance, learning by the other.
  EXPECT_LT(largest_difference(network.learn(pictures_, at::kFloat), wanted), 0.05 * folded);
}

TEST_F(Start, UnfoldingChangesNothingThatIsDetected) {
  const at::NoGradGuard no_gradients;
  Network network(plan_, 4);
  start_from(model(), {"box", "belt"}, network);
  network.unfold_statistics(pictures_.flip(0).narrow(0, 0, 2) * 0.5);
  EXPECT_LT(largest_difference(network.detect(pictures_), taught_.detect(pictures_)), 1e-3);
}

TEST_F(Start, ClassesAreMatchedByName) {
  const at::NoGradGuard no_gradients;
  Network network(plan_network(192, 128, 3, plan_.anchors), 4);
  const at::Tensor drawn = network.layers().back().weight.detach().clone();
  start_from(model(), {"belt", "shelf", "box"}, network);
  const at::Tensor to = network.layers().back().weight.view({3, 8, 128}), from = taught_.layers().back().weight.view({3, 7, 128});
  EXPECT_TRUE(at::equal(to.narrow(1, 0, 5), from.narrow(1, 0, 5)));
  EXPECT_TRUE(at::equal(to.select(1, 5), from.select(1, 6)));
  EXPECT_TRUE(at::equal(to.select(1, 6), drawn.view({3, 8, 128}).select(1, 6)));
  EXPECT_TRUE(at::equal(to.select(1, 7), from.select(1, 5)));
}

TEST_F(Start, OnlyADetectorOfOursWillDo) {
  const fs::path cfg = folder_.path() / "net.cfg", weights = folder_.path() / "net.weights";
  const std::string text = read_file(cfg), bytes = read_file(weights);
  std::string other = text;
  other.replace(other.find("filters=16"), 10, "filters=24");
  write_file(cfg, other);
  EXPECT_ERROR(model(), "net.cfg", "another network", "expected a detector that `waretwin train` made");
  write_file(cfg, text);
  write_file(weights, bytes.substr(0, bytes.size() - 4));
  EXPECT_ERROR(model(), "net.weights", "truncated");
  write_file(weights, "\xff" + bytes.substr(1));
  EXPECT_ERROR(model(), "net.weights", "no Darknet weights of version 0.2");
  write_file(weights, bytes);
  write_file(folder_.path() / "net.names", "box\n");
  EXPECT_ERROR(model(), "net.names", "1 names", "expected 2");
  fs::remove(cfg);
  fs::remove(weights);
  write_file(folder_.path() / "net.onnx", "");
  EXPECT_ERROR(model(), "net.onnx", "ONNX", "expected a detector");
}

}  // namespace
}  // namespace waretwin::train

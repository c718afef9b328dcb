// What a training multiplies in bfloat16.
#include "harness/train/precision.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/random.h"
#include "harness/train/network.h"

namespace waretwin::train {
namespace {

struct Lesson {
  at::Tensor output;
  at::Tensor gradient;  // of all that is learned, in a row
};

// One picture's output, and how the weights would change to make it like a drawn one.
Lesson lesson(at::ScalarType type) {
  Network network(plan_network(160, 96, 1, {{1, 1}, {2, 1}, {4, 2}}), 3);
  const auto drawn = [](std::vector<std::int64_t> shape, const char* what) {
    const RandomStream random(5, "precision_test", what);
    at::Tensor values = at::empty(shape);
    for (std::int64_t i = 0; i < values.numel(); ++i) values.data_ptr<float>()[i] = static_cast<float>(random.uniform(i));
    return values;
  };
  const at::Tensor pictures = drawn({4, 3, 96, 160}, "picture").contiguous(at::MemoryFormat::ChannelsLast);
  const at::Tensor output = network.learn(pictures, type);
  EXPECT_EQ(output.scalar_type(), at::kFloat);
  (output - drawn(output.sizes().vec(), "goal")).square().mean().backward();
  std::vector<at::Tensor> gradients;
  for (const at::Tensor& tensor : network.learned()) {
    EXPECT_EQ(tensor.scalar_type(), at::kFloat);
    EXPECT_EQ(tensor.grad().scalar_type(), at::kFloat);
    gradients.push_back(tensor.grad().flatten());
  }
  return {output.detach(), at::cat(gradients)};
}

TEST(Precision, BFloat16LearnsAboutTheSame) {
  const Lesson fine = lesson(at::kFloat), coarse = lesson(at::kBFloat16);
  // Eight bits of a number are kept.
  EXPECT_LT((fine.output - coarse.output).norm().item<double>(), 0.03 * fine.output.norm().item<double>());
  const double cosine = (fine.gradient.dot(coarse.gradient) / (fine.gradient.norm() * coarse.gradient.norm())).item<double>();
  EXPECT_GT(cosine, 0.99);
  EXPECT_GT((fine.gradient - coarse.gradient).abs().max().item<double>(), 0.0) << "computed alike";
}

TEST(Precision, AutoIsWhatTheProcessorDoesFast) {
  EXPECT_EQ(decided_precision("auto"), has_fast_bfloat16() ? "bfloat16" : "float32");
  EXPECT_EQ(decided_precision("float32"), "float32");
  EXPECT_EQ(decided_precision("bfloat16"), "bfloat16");
  EXPECT_EQ(type_of("float32"), at::kFloat);
  EXPECT_EQ(type_of("bfloat16"), at::kBFloat16);
}

}  // namespace
}  // namespace waretwin::train

#include "harness/train/darknet_weights.h"

#include <cstring>

namespace waretwin::train {
namespace {

template <class T>
void append(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void append(std::string& bytes, const at::Tensor& tensor) {
  // Kernels lie channels last in memory; files have them out, in, row, column.
  const at::Tensor plain = tensor.detach().to(at::kFloat).contiguous(at::MemoryFormat::Contiguous);
  bytes.append(reinterpret_cast<const char*>(plain.data_ptr<float>()), static_cast<std::size_t>(plain.numel()) * sizeof(float));
}

}  // namespace

std::string darknet_weights(const Network& network, std::int64_t pictures_seen, double object_shift) {
  std::string bytes;
  for (const std::int32_t part : {0, 2, 0}) append(bytes, part);
  append(bytes, static_cast<std::uint64_t>(pictures_seen));
  for (const Network::Parameters& p : network.layers()) {
    if (!p.weight.defined()) continue;
    at::Tensor bias = p.bias.detach();
    if (!p.scale.defined()) {
      const NetworkPlan& plan = network.plan();
      bias = bias.clone();
      bias.view({static_cast<std::int64_t>(plan.anchors.size()), plan.numbers()}).select(1, 4).add_(object_shift);
    }
    append(bytes, bias);
    if (p.scale.defined()) {
      append(bytes, p.scale.detach().to(at::kDouble) / (p.variance.to(at::kDouble) + Network::kEpsilon).sqrt());
      append(bytes, p.mean);
      append(bytes, at::ones_like(p.variance));
    }
    append(bytes, p.weight);
  }
  return bytes;
}

}  // namespace waretwin::train

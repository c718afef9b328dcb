#include "harness/train/darknet_weights.h"

#include <cstring>
#include <string_view>

#include "core/error.h"

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

std::string version() {
  std::string bytes;
  for (const std::int32_t part : {0, 2, 0}) append(bytes, part);
  return bytes;
}

// Takes what `append` wrote.
void take(std::string_view& bytes, at::Tensor tensor) {
  const auto size = static_cast<std::size_t>(tensor.numel()) * sizeof(float);
  if (bytes.size() < size) throw Error("Darknet weights end too early; expected those of this network");
  at::Tensor plain = at::empty(tensor.sizes());
  std::memcpy(plain.data_ptr<float>(), bytes.data(), size);
  tensor.copy_(plain);
  bytes.remove_prefix(size);
}

}  // namespace

std::string darknet_weights(const Network& network, std::int64_t pictures_seen, double object_shift) {
  std::string bytes = version();
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

void read_darknet_weights(const std::string& bytes, Network& network) {
  const at::NoGradGuard no_gradients;
  std::string_view rest = bytes;
  if (!rest.starts_with(version())) throw Error("no Darknet weights of version 0.2");
  rest.remove_prefix(std::min(rest.size(), version().size() + sizeof(std::uint64_t)));
  for (const Network::Parameters& p : network.layers()) {
    if (!p.weight.defined()) continue;
    take(rest, p.bias);
    if (p.scale.defined()) {
      take(rest, p.scale);
      take(rest, p.mean);
      take(rest, p.variance);
    }
    take(rest, p.weight);
  }
  if (!rest.empty()) throw Error("Darknet weights go on for too long; expected those of this network");
}

}  // namespace waretwin::train

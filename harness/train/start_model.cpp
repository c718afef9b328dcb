#include "harness/train/start_model.h"

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "core/digest.h"
#include "core/error.h"
#include "core/files.h"
#include "harness/train/darknet_weights.h"
#include "mapper/detect/darknet_cfg.h"
#include "mapper/detect/model_files.h"

namespace waretwin::train {
namespace {

namespace fs = std::filesystem;

constexpr const char* kExpected = "expected a detector that `waretwin train` made";

// The numbers of the line "anchors=w,h, w,h ..".
std::vector<BoxShape> anchors_in(const std::string& cfg) {
  constexpr const char* kKey = "\nanchors=";
  const auto at = cfg.find(kKey);
  if (at == std::string::npos) return {};
  std::string numbers = cfg.substr(at + std::string(kKey).size());
  numbers = numbers.substr(0, numbers.find('\n'));
  std::replace(numbers.begin(), numbers.end(), ',', ' ');
  std::istringstream in(numbers);
  std::vector<BoxShape> anchors;
  for (BoxShape shape; in >> shape.width >> shape.height;) anchors.push_back(shape);
  return anchors;
}

// The plan whose description the text is.
NetworkPlan plan_of(const std::filesystem::path& file) {
  const DarknetSummary summary = read_darknet_cfg(file);
  const std::string text = read_file(file);
  const std::vector<BoxShape> anchors = anchors_in(text);
  const bool whole_cells = summary.width % 32 == 0 && summary.height % 32 == 0;
  if (!anchors.empty() && whole_cells) {
    NetworkPlan plan = plan_network(summary.width, summary.height, summary.classes, anchors);
    if (darknet_cfg(plan) == text) return plan;
  }
  throw Error(file, std::string("describes another network; ") + kExpected);
}

void copy_into(const at::Tensor& from, at::Tensor to) { to.copy_(from); }

// Numbers of the last layer's channels, an anchor after the other: box and objectness, then classes.
at::Tensor rows_of(const at::Tensor& tensor, const NetworkPlan& plan) {
  std::vector<std::int64_t> shape = tensor.sizes().vec();
  shape[0] = plan.numbers();
  shape.insert(shape.begin(), static_cast<std::int64_t>(plan.anchors.size()));
  return tensor.view(shape);
}

}  // namespace

StartModel read_start_model(const std::string& model) {
  const ModelFiles files = find_model_files(model, {});
  if (!files.darknet()) throw Error(files.onnx, std::string("is an ONNX model; ") + kExpected);
  const NetworkPlan plan = plan_of(files.cfg);
  check_darknet_weights(files.weights, read_darknet_cfg(files.cfg));
  const std::string bytes = read_file(files.weights);
  Digest digest;
  digest.add(bytes);
  const fs::path folder = files.weights.has_parent_path() ? files.weights.parent_path() : fs::path(".");
  StartModel start{model, folder, read_class_names(files.names), Network(plan, 0), digest.hex()};
  const int classes = start.network.plan().classes;
  if (static_cast<int>(start.classes.size()) != classes) {
    throw Error(files.names, std::to_string(start.classes.size()) + " names; expected " + std::to_string(classes) +
                                 ", as many as the network has classes");
  }
  try {
    read_darknet_weights(bytes, start.network);
  } catch (const Error& error) {
    throw Error(files.weights, error.what());
  }
  return start;
}

void start_from(const StartModel& model, const std::vector<std::string>& classes, Network& network) {
  const Network& known = model.network;
  WARETWIN_CHECK(network.plan().anchors.size() == known.plan().anchors.size(), "anchors are the model's");
  const at::NoGradGuard no_gradients;
  for (std::size_t i = 0; i + 1 < network.layers().size(); ++i) {
    const Network::Parameters &to = network.layers()[i], &from = known.layers()[i];
    if (!to.weight.defined()) continue;
    for (const auto part : {&Network::Parameters::weight, &Network::Parameters::bias, &Network::Parameters::scale,
                            &Network::Parameters::mean, &Network::Parameters::variance})
      copy_into(from.*part, to.*part);
  }
  for (const auto part : {&Network::Parameters::weight, &Network::Parameters::bias}) {
    const at::Tensor to = rows_of(network.layers().back().*part, network.plan()), from = rows_of(known.layers().back().*part, known.plan());
    copy_into(from.narrow(1, 0, 5), to.narrow(1, 0, 5));
    for (std::size_t c = 0; c < classes.size(); ++c) {
      const auto found = std::find(model.classes.begin(), model.classes.end(), classes[c]);
      if (found == model.classes.end()) continue;
      copy_into(from.select(1, 5 + (found - model.classes.begin())), to.select(1, 5 + static_cast<std::int64_t>(c)));
    }
  }
}

}  // namespace waretwin::train

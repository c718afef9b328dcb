#include "tests/train/darknet_peer.h"

#include <darknet.h>

#include <cstdlib>

namespace waretwin::test {

DarknetAnswer ask_darknet(const std::filesystem::path& cfg, const std::filesystem::path& weights, std::vector<float> input, float score) {
  std::string cfg_name = cfg.string(), weights_name = weights.string();
  network* const net = load_network(cfg_name.data(), weights_name.data(), 0);
  set_batch_network(net, 1);
  network_predict(net, input.data());
  DarknetAnswer answer;
  const layer& last = net->layers[net->n - 2];
  answer.raw.assign(last.output, last.output + last.outputs);
  // A region layer leaves the boxes' own number of classes unset.
  const int classes = net->layers[net->n - 1].classes;
  int count = 0;
  // Boxes as shares of a picture that has the input's proportions, so that Darknet's grey bars are none.
  detection* const found = get_network_boxes(net, net->w, net->h, score, 0.5f, nullptr, 1, &count);
  for (int i = 0; i < count; ++i) {
    const box b = found[i].bbox;
    for (int c = 0; c < classes; ++c) {
      if (found[i].prob[c] >= score) answer.boxes.push_back({c, {b.x - 0.5f * b.w, b.y - 0.5f * b.h, b.w, b.h}, found[i].prob[c]});
    }
  }
  free_detections(found, count);
  free_network(net);
  return answer;
}

}  // namespace waretwin::test

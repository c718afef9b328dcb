// An exported network gives the same numbers in libtorch, OpenCV and Darknet.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/dnn.hpp>
#include <opencv2/imgcodecs.hpp>

#include "core/files.h"
#include "core/random.h"
#include "harness/train/darknet_weights.h"
#include "harness/train/network.h"
#include "harness/train/region_boxes.h"
#include "harness/train/sample.h"
#include "mapper/detect/darknet_cfg.h"
#include "mapper/detect/resized_picture.h"
#include "mapper/detect/yolo_detector.h"
#include "tests/end_to_end/program.h"
#include "tests/support/test_data.h"
#include "tests/train/darknet_peer.h"

namespace waretwin::train {
namespace {

namespace fs = std::filesystem;

// A network whose batch normalisation is far from its start, as after a training.
Network drawn_network(const NetworkPlan& plan) {
  Network network(plan, 11);
  const at::NoGradGuard no_gradients;
  for (std::size_t i = 0; i < network.layers().size(); ++i) {
    const Network::Parameters& p = network.layers()[i];
    if (!p.scale.defined()) continue;
    const RandomStream random(12, "layer " + std::to_string(i), "statistics");
    for (std::int64_t k = 0; k < p.scale.numel(); ++k) {
      p.scale[k] = random.uniform(k, 0) + 0.5;
      p.bias[k] = random.normal(k, 1) * 0.3;
      p.mean[k] = random.normal(k, 2) * 0.2;
      // Down to where the 1e-5 beside it matters.
      p.variance[k] = std::pow(10.0, -4.0 + 4.5 * random.uniform(k, 3));
    }
  }
  return network;
}

class Export : public ::testing::TestWithParam<int> {
 protected:
  Export()
      : plan_(plan_network(160, 96, GetParam(), {{1.5, 1}, {2, 3}, {5, 3}})),
        network_(drawn_network(plan_)),
        cfg_(folder_.path() / "net.cfg"),
        weights_(folder_.path() / "net.weights") {
    const RandomStream random(13, "export_test", "picture");
    picture_ = cv::Mat(96, 160, CV_8UC3);
    for (std::size_t i = 0; i < picture_.total() * 3; ++i) picture_.data[i] = static_cast<uchar>(255 * random.uniform(i / 7));
    write_file(cfg_, darknet_cfg(plan_));
    // Scaled to a few units, where scores are neither all 0 nor all 1.
    const at::NoGradGuard no_gradients;
    network_.layers().back().weight.mul_(1.5 / raw().std(std::vector<std::int64_t>{2, 3}, false).mean().item<double>());
    network_.layers().back().bias.fill_(0.5);
    write_file(weights_, darknet_weights(network_, 123));
  }

  // Channel by channel, RGB from 0 to 1.
  cv::Mat blob() const { return cv::dnn::blobFromImage(picture_, 1.0 / 255.0, picture_.size(), cv::Scalar(), true, false); }
  at::Tensor raw() {
    const at::NoGradGuard no_gradients;
    cv::Mat input = blob();
    return network_.detect(at::from_blob(input.data, {1, 3, 96, 160}).clone()).contiguous(at::MemoryFormat::Contiguous);
  }

  NetworkPlan plan_;
  Network network_;
  test::TemporaryFolder folder_;
  fs::path cfg_, weights_;
  cv::Mat picture_;
};

double largest_difference(const float* a, const float* b, std::int64_t count) {
  double largest = 0.0;
  for (std::int64_t i = 0; i < count; ++i) largest = std::max(largest, static_cast<double>(std::abs(a[i] - b[i])));
  return largest;
}

bool holds(const std::vector<ScoredBox>& boxes, const ScoredBox& wanted) {
  return std::any_of(boxes.begin(), boxes.end(), [&](const ScoredBox& box) {
    const cv::Point2f a = box.share.tl() - wanted.share.tl(), b = box.share.br() - wanted.share.br();
    const float farthest = std::max({std::abs(a.x), std::abs(a.y), std::abs(b.x), std::abs(b.y)});
    return box.class_index == wanted.class_index && std::abs(box.score - wanted.score) < 1e-4f && farthest < 1e-4f;
  });
}

TEST_P(Export, WeightsHaveTheSizeThatTheDescriptionNeeds) {
  const DarknetSummary summary = read_darknet_cfg(cfg_);
  EXPECT_EQ(summary.parameters, parameter_count(plan_));
  check_darknet_weights(weights_, summary);
}

TEST_P(Export, OpenCvGivesTheSameNumbers) {
  cv::dnn::Net net = cv::dnn::readNetFromDarknet(cfg_.string(), weights_.string());
  net.setInput(blob());
  const std::string last = "conv_" + std::to_string(plan_.layers.size() - 1);
  const cv::Mat theirs = net.forward(last);
  const at::Tensor ours = raw();
  ASSERT_EQ(static_cast<std::int64_t>(theirs.total()), ours.numel());
  EXPECT_GT(ours.std().item<double>(), 0.5);
  EXPECT_LT(largest_difference(theirs.ptr<float>(), ours.data_ptr<float>(), ours.numel()), 1e-4);
}

TEST_P(Export, TheDetectorFindsTheSameBoxes) {
  std::string names;
  for (int i = 0; i < GetParam(); ++i) names += "class" + std::to_string(i) + "\n";
  write_file(folder_.path() / "net.names", names);
  YoloDetector detector(folder_.path(), {.confidence = 0.3, .nms_iou = 1.0});
  const std::vector<Detection> theirs = detector.detect(picture_);
  const std::vector<ScoredBox> ours = region_boxes(raw().data_ptr<float>(), plan_, 0.3f, 1.0f);
  ASSERT_GT(ours.size(), 3u);
  // OpenCV's region layer has dropped a few covered ones by itself, before they are cut off at the edges.
  EXPECT_GE(theirs.size(), ours.size() * 9 / 10);
  for (const Detection& detection : theirs) {
    const cv::Rect2f share(detection.box.x / 160, detection.box.y / 96, detection.box.width / 160, detection.box.height / 96);
    EXPECT_TRUE(holds(ours, {std::stoi(detection.class_name.substr(5)), share, detection.score})) << share << ", score " << detection.score;
  }
}

TEST_P(Export, DarknetGivesTheSameNumbersAndBoxes) {
#ifndef WARETWIN_DARKNET
  GTEST_SKIP() << "needs the package darknet when it is built";
#else
  const cv::Mat input = blob();
  const test::DarknetAnswer theirs = test::ask_darknet(cfg_, weights_, {input.ptr<float>(), input.ptr<float>() + input.total()}, 0.3f);
  const at::Tensor ours = raw();
  ASSERT_EQ(static_cast<std::int64_t>(theirs.raw.size()), ours.numel());
  EXPECT_LT(largest_difference(theirs.raw.data(), ours.data_ptr<float>(), ours.numel()), 2e-4);
  // Ours are cut off at the picture's edges, theirs not.
  std::vector<ScoredBox> inside = theirs.boxes;
  for (ScoredBox& box : inside) box.share &= cv::Rect2f(0, 0, 1, 1);
  const std::vector<ScoredBox> boxes = region_boxes(ours.data_ptr<float>(), plan_, 0.3f, 1.0f);
  ASSERT_GT(boxes.size(), 3u);
  for (const ScoredBox& box : boxes)
    EXPECT_TRUE(holds(inside, box)) << box.share << ", class " << box.class_index << ", score " << box.score;
#endif
}

// Not a drawn network, but the one that everybody uses, where a conveyor is to be seen.
TEST(ShippedModel, DarknetSeesTheSameConveyors) {
#ifndef WARETWIN_DARKNET
  GTEST_SKIP() << "needs the package darknet when it is built";
#else
  const fs::path model = test::repository() / "mapper/detect/models/conveyor", cfg = model / "conveyor.cfg",
                 weights = model / "conveyor.weights";
  EXPECT_LE(fs::file_size(weights), 4'000'000u);
  const DarknetSummary summary = read_darknet_cfg(cfg);
  const test::TemporaryFolder folder;
  const fs::path view = folder.path() / "view.png";
  ASSERT_EQ(test::waretwin("render " + test::agiprobot() + " --quiet --pose=-3.0,-0.6,1.4,-45,25 --out " + test::in_quotes(view)).exit_code, 0);
  const cv::Mat picture = cv::imread(view.string());
  ASSERT_FALSE(picture.empty());
  cv::Mat small(summary.height, summary.width, CV_8UC3);
  resize_picture(picture, small);
  const cv::Mat input = cv::dnn::blobFromImage(small, 1.0 / 255.0, small.size(), cv::Scalar(), true, false);
  const test::DarknetAnswer theirs = test::ask_darknet(cfg, weights, {input.ptr<float>(), input.ptr<float>() + input.total()}, 0.25f);
  const std::vector<Detection> ours = YoloDetector(model, {.confidence = 0.5}).detect(picture);
  ASSERT_FALSE(ours.empty());
  for (const Detection& one : ours) {
    const auto columns = static_cast<float>(picture.cols), rows = static_cast<float>(picture.rows);
    const cv::Rect2f share(one.box.x / columns, one.box.y / rows, one.box.width / columns, one.box.height / rows);
    EXPECT_TRUE(std::any_of(theirs.boxes.begin(), theirs.boxes.end(),
                            [&](const ScoredBox& box) {
                              return std::abs(box.score - one.score) < 1e-3f && box_iou(box.share & cv::Rect2f(0, 0, 1, 1), share) > 0.99f;
                            }))
        << one.box << ", score " << one.score;
  }
#endif
}

INSTANTIATE_TEST_SUITE_P(Classes, Export, ::testing::Values(1, 3));

}  // namespace
}  // namespace waretwin::train

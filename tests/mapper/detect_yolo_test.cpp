#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "core/error.h"
#include "core/files.h"
#include "mapper/detect/darknet_cfg.h"
#include "mapper/detect/model_files.h"
#include "mapper/detect/yolo_decode.h"
#include "mapper/detect/yolo_detector.h"
#include "tests/support/test_data.h"

namespace waretwin {
namespace {

namespace fs = std::filesystem;

template <class F>
std::string error_of(F&& call) {
  try {
    call();
  } catch (const Error& problem) {
    return problem.what();
  }
  return "no error";
}

double overlap(const cv::Rect2f& a, const cv::Rect2f& b) { return (a & b).area() / (a.area() + b.area() - (a & b).area()); }

const Detection* best_of(const std::vector<Detection>& detections, const std::vector<std::string>& names) {
  for (const Detection& detection : detections) {
    if (std::find(names.begin(), names.end(), detection.class_name) != names.end()) return &detection;
  }
  return nullptr;
}

TEST(YoloDetector, FindsDogBicycleAndTruckInTheirPhotograph) {
  WARETWIN_NEED_DATA("yolo_fastest");
  const fs::path folder = test::shared_data("yolo_fastest");
  const cv::Mat photograph = cv::imread((folder / "dog.jpg").string());
  ASSERT_FALSE(photograph.empty());
  ASSERT_EQ(photograph.size(), cv::Size(768, 576));
  for (const fs::path& model : {folder, folder / "yolo-fastest-1.1.cfg", folder / "yolo-fastest-1.1.weights"}) {
    YoloDetector detector(model, {.confidence = 0.3});
    const std::vector<Detection> found = detector.detect(photograph);
    const Detection* dog = best_of(found, {"dog"});
    const Detection* bicycle = best_of(found, {"bicycle"});
    const Detection* truck = best_of(found, {"truck", "car"});
    ASSERT_NE(dog, nullptr);
    ASSERT_NE(bicycle, nullptr);
    ASSERT_NE(truck, nullptr);
    // Where a person draws them.
    EXPECT_GT(overlap(dog->box, {130, 220, 180, 320}), 0.6);
    EXPECT_GT(overlap(bicycle->box, {120, 125, 445, 300}), 0.5);
    EXPECT_GT(overlap(truck->box, {470, 75, 220, 95}), 0.6);
    EXPECT_LE(found.size(), 8u);
  }
}

TEST(YoloDetector, GivesWeakDetectionsWhereTheyAreAskedFor) {
  WARETWIN_NEED_DATA("yolo_fastest");
  const fs::path folder = test::shared_data("yolo_fastest");
  const cv::Mat photograph = cv::imread((folder / "dog.jpg").string());
  std::vector<Detection> all = YoloDetector(folder, {.confidence = 0.001}).detect(photograph);
  const auto count_between = [&](float low, float high) {
    return std::count_if(all.begin(), all.end(), [&](const Detection& d) { return d.score >= low && d.score < high; });
  };
  // OpenCV's own limit for YOLO heads, 0.2, is out of the way.
  EXPECT_GE(count_between(0.05f, 0.2f), 3);
  EXPECT_GE(count_between(0.001f, 0.01f), 3);
  // The strong ones are those of a high threshold, to the bit.
  std::erase_if(all, [](const Detection& d) { return d.score < 0.3f; });
  const std::vector<Detection> strong = YoloDetector(folder, {.confidence = 0.3}).detect(photograph);
  ASSERT_EQ(all.size(), strong.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(all[i].class_name, strong[i].class_name);
    EXPECT_EQ(all[i].box, strong[i].box);
    EXPECT_EQ(all[i].score, strong[i].score);
  }
  // What the description says of it does not matter.
  const test::TemporaryFolder scratch;
  std::string cfg = read_file(folder / "yolo-fastest-1.1.cfg");
  for (std::size_t at = cfg.find("[yolo]"); at != std::string::npos; at = cfg.find("[yolo]", at + 1)) cfg.insert(at + 6, "\nthresh = .8");
  write_file(scratch.path() / "m.cfg", cfg);
  fs::copy_file(folder / "yolo-fastest-1.1.weights", scratch.path() / "m.weights");
  fs::copy_file(folder / "coco.names", scratch.path() / "m.names");
  EXPECT_EQ(YoloDetector(scratch.path(), {.confidence = 0.3}).detect(photograph).size(), strong.size());
}

TEST(YoloDetector, LetterboxPutsBoxesInTheSamePlaces) {
  WARETWIN_NEED_DATA("yolo_fastest");
  const fs::path folder = test::shared_data("yolo_fastest");
  const cv::Mat photograph = cv::imread((folder / "dog.jpg").string());
  YoloDetector stretched(folder, {.confidence = 0.3, .letterbox = "off"});
  YoloDetector boxed(folder, {.confidence = 0.3, .letterbox = "on"});
  const std::vector<Detection> a = stretched.detect(photograph), b = boxed.detect(photograph);
  ASSERT_NE(best_of(a, {"dog"}), nullptr);
  ASSERT_NE(best_of(b, {"dog"}), nullptr);
  EXPECT_GT(overlap(best_of(a, {"dog"})->box, best_of(b, {"dog"})->box), 0.7);
}

TEST(YoloDetector, KeepsAndRenamesClasses) {
  WARETWIN_NEED_DATA("yolo_fastest");
  const fs::path folder = test::shared_data("yolo_fastest");
  YoloDetector detector(folder, {.confidence = 0.3, .classes = {"hound"}, .rename = {"dog=hound"}});
  EXPECT_EQ(detector.class_names(), std::vector<std::string>{"hound"});
  EXPECT_EQ(detected_classes(folder, {.classes = {"hound"}, .rename = {"dog=hound"}}), detector.class_names());
  const std::vector<Detection> found = detector.detect(cv::imread((folder / "dog.jpg").string()));
  ASSERT_FALSE(found.empty());
  for (const Detection& detection : found) EXPECT_EQ(detection.class_name, "hound");
  EXPECT_NE(error_of([&] { YoloDetector(folder, {.classes = {"unicorn"}}); }).find("unicorn"), std::string::npos);
  EXPECT_NE(error_of([&] { YoloDetector(folder, {.rename = {"unicorn=horse"}}); }).find("unicorn"), std::string::npos);
  EXPECT_NE(error_of([&] { YoloDetector(folder, {.rename = {"dog"}}); }).find("from=to"), std::string::npos);
}

TEST(YoloDetector, DamagedModelsEndInOneLine) {
  WARETWIN_NEED_DATA("yolo_fastest");
  const fs::path folder = test::shared_data("yolo_fastest");
  const std::string cfg = read_file(folder / "yolo-fastest-1.1.cfg"), weights = read_file(folder / "yolo-fastest-1.1.weights"),
                    names = read_file(folder / "coco.names");
  const test::TemporaryFolder scratch;
  const auto attempt = [&](const std::string& c, const std::string& w, const std::string& n) {
    write_file(scratch.path() / "m.cfg", c);
    write_file(scratch.path() / "m.weights", w);
    write_file(scratch.path() / "m.names", n);
    const std::string message = error_of([&] { YoloDetector(scratch.path(), {}); });
    EXPECT_EQ(message.find('\n'), std::string::npos);
    return message;
  };
  EXPECT_EQ(attempt(cfg, weights, names), "no error");
  EXPECT_NE(attempt(cfg, weights.substr(0, weights.size() - 4), names).find("truncated"), std::string::npos);
  EXPECT_NE(attempt(cfg, weights + "1234", names).find("another cfg"), std::string::npos);
  EXPECT_NE(attempt(cfg, "", names).find("too short"), std::string::npos);
  EXPECT_NE(attempt(cfg, weights, "dog\ncat\n").find("2 class names"), std::string::npos);
  EXPECT_NE(attempt(cfg, weights, "").find("no class names"), std::string::npos);
  EXPECT_NE(attempt("hello", weights, names).find("m.cfg:1"), std::string::npos);
  EXPECT_NE(attempt("", weights, names).find("[net]"), std::string::npos);
  std::string wide = cfg;
  wide.replace(wide.find("filters=8"), 9, "filters=-8");
  EXPECT_NE(attempt(wide, weights, names).find("filters = '-8'"), std::string::npos);
}

TEST(ModelFiles, SaysWhatIsMissing) {
  const test::TemporaryFolder scratch;
  EXPECT_NE(error_of([&] { find_model_files(scratch.path() / "none", {}); }).find("no such model"), std::string::npos);
  EXPECT_NE(error_of([&] { find_model_files(scratch.path(), {}); }).find("0 models"), std::string::npos);
  write_file(scratch.path() / "a.cfg", "x");
  EXPECT_NE(error_of([&] { find_model_files(scratch.path(), {}); }).find("weights"), std::string::npos);
  write_file(scratch.path() / "b.weights", "x");
  EXPECT_NE(error_of([&] { find_model_files(scratch.path(), {}); }).find("class names"), std::string::npos);
  write_file(scratch.path() / "c.names", "x");
  EXPECT_EQ(find_model_files(scratch.path(), {}).weights, scratch.path() / "b.weights");
  EXPECT_EQ(find_model_files(scratch.path() / "b.weights", {}).cfg, scratch.path() / "a.cfg");
  EXPECT_EQ(find_model_files(scratch.path() / "a.cfg", "other.names").names, fs::path("other.names"));
  write_file(scratch.path() / "d.onnx", "x");
  EXPECT_NE(error_of([&] { find_model_files(scratch.path(), {}); }).find("2 models"), std::string::npos);
  EXPECT_NE(error_of([&] { find_model_files(scratch.path() / "c.names", {}); }).find("not a model"), std::string::npos);
}

TEST(DarknetCfg, CountsTheParametersOfARegionNetwork) {
  const test::TemporaryFolder scratch;
  const fs::path cfg = scratch.path() / "tiny.cfg";
  // YOLOv2 in the small: a pass-through by reorg, a route, a region head.
  write_file(cfg,
             "[net]\nwidth=64\nheight=32\nchannels=3\n"
             "[convolutional]\nbatch_normalize=1\nfilters=4\nsize=3\nstride=1\npad=1\nactivation=leaky\n"  // 4*4 + 4*3*9 = 124
             "[maxpool]\nsize=2\nstride=2\n"
             "[convolutional]\nfilters=8\nsize=1\n"   // 8 + 8*4 = 40
             "[route]\nlayers=-3\n"                   // 4 channels
             "[reorg]\nstride=2\n"                    // 16 channels
             "[route]\nlayers=-1,-3\n"                // 16 + 8 = 24 channels
             "[convolutional]\nfilters=14\nsize=1\n"  // 14 + 14*24 = 350
             "[region]\nanchors=1,1,2,2\nclasses=2\nnum=2\n");
  const DarknetSummary summary = read_darknet_cfg(cfg);
  EXPECT_EQ(summary.width, 64);
  EXPECT_EQ(summary.height, 32);
  EXPECT_EQ(summary.classes, 2);
  ASSERT_TRUE(summary.parameters.has_value());
  EXPECT_EQ(*summary.parameters, 124 + 40 + 350);
}

TEST(YoloDecode, PlacesBoxesOfAllLayouts) {
  const std::vector<std::string> names = {"a", "b"};
  const cv::Size input(100, 50), picture(400, 100);
  const InputPlacement placement{0.25, 0.25, 0.0, 12.5};  // letterboxed: 400 x 100 in the middle of 100 x 50
  // A box of 40 x 20 around (200, 50) of the picture: (50, 25), 10 x 5 in the input.
  const cv::Rect2f expected(180, 40, 40, 20);
  struct Case {
    YoloRows layout;
    std::vector<float> row;
    float score;
  };
  for (const Case& c :
       {Case{YoloRows::kDarknet, {0.5f, 0.5f, 0.1f, 0.1f, 0.9f, 0.1f, 0.8f}, 0.8f},
        Case{YoloRows::kObjectness, {50, 25, 10, 5, 0.5f, 0.1f, 0.8f}, 0.4f}, Case{YoloRows::kPlain, {50, 25, 10, 5, 0.1f, 0.8f}, 0.8f}}) {
    const cv::Mat rows(1, static_cast<int>(c.row.size()), CV_32F, const_cast<float*>(c.row.data()));
    std::vector<Detection> found;
    decode_rows(rows, c.layout, input, placement, picture, 0.3, names, found);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].class_name, "b");
    EXPECT_NEAR(found[0].score, c.score, 1e-6);
    EXPECT_GT(overlap(found[0].box, expected), 0.999);
    found.clear();
    decode_rows(rows, c.layout, input, placement, picture, c.score + 0.01, names, found);
    EXPECT_TRUE(found.empty());
  }
}

TEST(YoloDecode, SuppressesWithinAClassOnly) {
  const std::vector<Detection> kept = suppress_overlaps({{"a", {0, 0, 10, 10}, 0.5f},
                                                         {"a", {1, 0, 10, 10}, 0.9f},   // IoU 90/110 with the first
                                                         {"b", {1, 0, 10, 10}, 0.4f},   // another class
                                                         {"a", {8, 0, 10, 10}, 0.3f}},  // IoU 3/17 with the best
                                                        0.45);
  ASSERT_EQ(kept.size(), 3u);
  EXPECT_FLOAT_EQ(kept[0].score, 0.9f);
  EXPECT_FLOAT_EQ(kept[1].score, 0.4f);
  EXPECT_FLOAT_EQ(kept[2].score, 0.3f);
}

// Just enough protobuf to write an ONNX file whose output is what the test says: a convolution over the whole picture with weights 0, the
// bias being the answer, and a reshape.
namespace onnx {
std::string varint(std::uint64_t value) {
  std::string bytes;
  for (; value >= 128; value >>= 7) bytes += static_cast<char>(value | 128);
  return bytes + static_cast<char>(value);
}
std::string number(int field, std::uint64_t value) { return varint(static_cast<std::uint64_t>(field) << 3) + varint(value); }
std::string bytes(int field, const std::string& content) {
  return varint(static_cast<std::uint64_t>(field) << 3 | 2) + varint(content.size()) + content;
}
template <class T>
std::string tensor(const std::string& name, const std::vector<std::int64_t>& dims, int type, const std::vector<T>& values) {
  std::string out;
  for (const std::int64_t dim : dims) out += number(1, static_cast<std::uint64_t>(dim));
  return out + number(2, type) + bytes(8, name) +
         bytes(9, std::string(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)));
}
std::string value_info(const std::string& name, const std::vector<std::int64_t>& dims) {
  std::string shape;
  for (const std::int64_t dim : dims) shape += bytes(1, number(1, static_cast<std::uint64_t>(dim)));
  return bytes(1, name) + bytes(2, bytes(1, number(1, 1) + bytes(2, shape)));
}
std::string constant_network(int side, const std::vector<std::int64_t>& shape, const std::vector<float>& answer) {
  const auto count = static_cast<std::int64_t>(answer.size());
  const std::string conv = bytes(1, "images") + bytes(1, "weights") + bytes(1, "bias") + bytes(2, "flat") + bytes(3, "conv") +
                           bytes(4, "Conv") + bytes(5, bytes(1, "kernel_shape") + number(8, side) + number(8, side) + number(20, 7));
  const std::string reshape = bytes(1, "flat") + bytes(1, "shape") + bytes(2, "output0") + bytes(3, "reshape") + bytes(4, "Reshape");
  const std::string graph =
      bytes(1, conv) + bytes(1, reshape) + bytes(2, "g") +
      bytes(5, tensor<float>("weights", {count, 3, side, side}, 1, std::vector<float>(count * 3 * side * side, 0.0f))) +
      bytes(5, tensor<float>("bias", {count}, 1, answer)) +
      bytes(5, tensor<std::int64_t>("shape", {static_cast<std::int64_t>(shape.size())}, 7, shape)) +
      bytes(11, value_info("images", {1, 3, side, side})) + bytes(12, value_info("output0", shape));
  return number(1, 7) + bytes(7, graph) + bytes(8, bytes(1, "") + number(2, 12));
}
}  // namespace onnx

TEST(YoloDetector, ReadsBothOnnxHeadsEndToEnd) {
  const test::TemporaryFolder scratch;
  write_file(scratch.path() / "m.names", "table\nchair\n");
  const cv::Mat picture(50, 100, CV_8UC3, cv::Scalar(10, 20, 30));
  // Input 16 x 16: the picture lies letterboxed in rows 4 to 12, scale 0.16. Chair at (8, 8), 8 x 4 in the input: (25, 12.5), 50 x 25 in
  // the picture.
  const std::vector<float> v5 = {8, 8, 8, 4, 0.9f, 0.1f, 0.9f, 2, 2, 1, 1, 0.1f, 0.5f, 0.5f, 8, 8, 8, 4.2f, 0.8f, 0.1f, 0.9f};
  // Columns are candidates: cx, cy, w, h, table, chair.
  const std::vector<float> v8 = {8, 2, 8, 8, 2, 8, 8, 1, 8, 4, 1, 4.2f, 0.1f, 0.1f, 0.1f, 0.81f, 0.05f, 0.7f};
  for (const auto& [shape, answer] :
       {std::pair{std::vector<std::int64_t>{1, 3, 7}, v5}, std::pair{std::vector<std::int64_t>{1, 6, 3}, v8}}) {
    write_file(scratch.path() / "m.onnx", onnx::constant_network(16, shape, answer));
    YoloDetector detector(scratch.path() / "m.onnx", {.confidence = 0.3, .input_width = 16, .input_height = 16});
    const std::vector<Detection> found = detector.detect(picture);
    ASSERT_EQ(found.size(), 1u);  // the third is suppressed, the second too weak
    EXPECT_EQ(found[0].class_name, "chair");
    EXPECT_NEAR(found[0].score, 0.81, 1e-5);
    EXPECT_GT(overlap(found[0].box, {25, 12.5, 50, 25}), 0.99);
  }
  // Placing and class map are configuration: stretched, the same answer is a box of half the width and a quarter of the height.
  YoloDetector stretched(
      scratch.path() / "m.onnx",
      {.confidence = 0.3, .input_width = 16, .input_height = 16, .letterbox = "off", .classes = {"stool"}, .rename = {"chair=stool"}});
  const std::vector<Detection> seen = stretched.detect(picture);
  ASSERT_EQ(seen.size(), 1u);
  EXPECT_EQ(seen[0].class_name, "stool");
  EXPECT_GT(overlap(seen[0].box, {25, 18.75, 50, 12.5}), 0.99);
  // Names that fit neither head.
  write_file(scratch.path() / "m.names", "one\ntwo\nthree\nfour\n");
  YoloDetector wrong(scratch.path(), {.input_width = 16, .input_height = 16});
  EXPECT_NE(error_of([&] { wrong.detect(picture); }).find("1 x 6 x 3"), std::string::npos);
  write_file(scratch.path() / "m.onnx", "not a network");
  EXPECT_NE(error_of([&] { YoloDetector(scratch.path(), {}); }).find("m.onnx"), std::string::npos);
}

}  // namespace
}  // namespace waretwin

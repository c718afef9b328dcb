// Whole trainings on pictures that are learned in seconds.
#include <ATen/Parallel.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/config.h"
#include "core/files.h"
#include "harness/train/trainer.h"
#include "mapper/detect/yolo_detector.h"
#include "tests/support/expect_error.h"
#include "tests/support/test_data.h"
#include "tests/train/rectangles_set.h"

namespace waretwin::train {
namespace {

namespace fs = std::filesystem;

class Training : public ::testing::Test {
 protected:
  Training() {
    at::set_num_threads(1);
    set_ = folder_.path() / "set";
    test::write_rectangles(set_, 24, 16);
  }

  TrainingRequest request(const std::string& out) const {
    TrainingRequest request{set_, folder_.path() / out, "shapes", false, "", {}};
    request.config.width = 160;
    request.config.height = 96;
    request.config.anchors = 3;
    request.config.warm_up = 10;
    request.config.average_decay = 0.95;
    request.config.augment.mosaic = 0.2;
    return request;
  }

  static std::string weights(const TrainingRequest& request) { return read_file(request.out / (request.name + ".weights")); }

  test::TemporaryFolder folder_;
  fs::path set_;
};

TEST_F(Training, LearnsRectanglesAndTheDetectorFindsThem) {
  TrainingRequest wanted = request("out");
  wanted.config.epochs = 5;
  wanted.config.epoch_pictures = 240;
  const TrainingSummary summary = train_detector(wanted, {});
  EXPECT_GT(summary.best_ap50, 0.9);
  YoloDetector detector(wanted.out, {.confidence = 0.3});
  EXPECT_EQ(detector.class_names(), (std::vector<std::string>{"orange", "blue"}));
  // Scored by hand at one place: both rectangles of a picture that was not trained on.
  const std::vector<Detection> found = detector.detect(cv::imread((set_ / "images/p1030.png").string()));
  EXPECT_GE(found.size(), 2u);
  EXPECT_LE(fs::file_size(summary.weights), 4'000'000u);

  const std::string log = read_file(wanted.out / "log.csv");
  EXPECT_TRUE(log.starts_with("epoch,box_loss,object_loss,class_loss,ap,ap50,ap75,side_error_px,learning_rate,seconds\n1,"));
  EXPECT_EQ(std::count(log.begin(), log.end(), '\n'), 1 + summary.epochs);
  TrainConfig written;
  read_config(wanted.out / "train.yaml", [&](Fields& f) { f.group("train", written, ""); });
  EXPECT_EQ(written.width, 160);
  EXPECT_EQ(written.epochs, 5);
}

struct Stopped {};

TEST_F(Training, AResumedOneEndsLikeAnUninterruptedOne) {
  TrainingRequest whole = request("whole"), parts = request("parts");
  for (TrainingRequest* one : {&whole, &parts}) {
    one->config.epochs = 3;
    one->config.epoch_pictures = 24;
  }
  train_detector(whole, {});
  // Stopped in the middle of the second epoch, then once more right after it.
  int steps = 0;
  TrainingHooks stopping;
  stopping.progress = [&](const TrainingProgress& now) {
    if (now.epoch == 2 && ++steps == 2) throw Stopped();
  };
  EXPECT_THROW(train_detector(parts, stopping), Stopped);
  EXPECT_FALSE(fs::exists(parts.out / "shapes.weights"));
  parts.resume = true;
  int from = -1;
  train_detector(parts, {.check = {}, .started = [&](const TrainingSet& set) { from = set.epochs_done; }, .progress = {}, .epoch = {}});
  EXPECT_EQ(from, 1);
  EXPECT_TRUE(weights(whole) == weights(parts));

  // A finished one is finished.
  const TrainingSummary again = train_detector(parts, {});
  EXPECT_EQ(again.epochs, 3);
  EXPECT_TRUE(weights(whole) == weights(parts));

  parts.name = "others";
  EXPECT_ERROR(train_detector(parts, {}), "holds the model 'shapes'");
  parts.name = "shapes";
  parts.config.batch = 4;
  EXPECT_ERROR(train_detector(parts, {}), "checkpoint", "batch: 8", "batch: 4");
  write_file(parts.out / "checkpoint", read_file(parts.out / "checkpoint").substr(0, 100000));
  parts.config.batch = 8;
  EXPECT_ERROR(train_detector(parts, {}), "checkpoint", "ends within");
}

TEST_F(Training, OneThatEndedByTheClockHasEnded) {
  TrainingRequest wanted = request("out");
  wanted.config.epochs = 2;
  wanted.config.epoch_pictures = 24;
  const TrainingSummary summary = train_detector(wanted, {});
  const std::string first = weights(wanted);
  // As if the clock had ended it: less is left than another validation takes.
  wanted.config.epochs = 0;
  wanted.config.minutes = (summary.seconds + 1e-4) / 60.0;
  wanted.resume = true;
  EXPECT_EQ(train_detector(wanted, {}).epochs, 2);
  EXPECT_TRUE(weights(wanted) == first);
}

TEST_F(Training, ACheckpointIsOfOneModel) {
  TrainingRequest wanted = request("out");
  wanted.config.epoch_pictures = 24;
  wanted.config.epochs = 1;
  train_detector(wanted, {});
  for (const char* name : {"shapes.weights", "shapes.cfg"}) fs::remove(wanted.out / name);
  wanted.name = "others";
  wanted.resume = true;
  EXPECT_ERROR(train_detector(wanted, {}), "name: shapes", "name: others");
}

TEST_F(Training, AFinishedModelWithoutACheckpointIsNotLostByResuming) {
  TrainingRequest wanted = request("out");
  wanted.config.epoch_pictures = 24;
  wanted.config.epochs = 1;
  train_detector(wanted, {});
  const std::string before = weights(wanted);
  fs::remove(wanted.out / "checkpoint");
  wanted.resume = true;
  EXPECT_ERROR(train_detector(wanted, {}), "checkpoint", "a finished detector is", "no --resume");
  EXPECT_TRUE(weights(wanted) == before);
}

TEST_F(Training, StartsFromADetector) {
  TrainingRequest first = request("first"), second = request("second");
  first.config.epoch_pictures = 240;
  first.config.epochs = 4;
  const double ap50 = train_detector(first, {}).best_ap50;
  ASSERT_GT(ap50, 0.8);
  second.start = first.out.string();
  second.config.width = 192;
  second.config.height = 128;
  second.config.epochs = 1;
  second.config.epoch_pictures = 24;
  second.config.learning_rate = 0.0;
  int known = 0;
  TrainingHooks hooks;
  hooks.started = [&](const TrainingSet& set) { known = set.known_classes; };
  // What it knew it still knows, where pictures are larger.
  EXPECT_GT(train_detector(second, hooks).best_ap50, ap50 - 0.15);
  EXPECT_EQ(known, 2);
  EXPECT_TRUE(read_file(second.out / "train.yaml").starts_with("# waretwin"));
  EXPECT_NE(read_file(second.out / "train.yaml").find("from " + first.out.string()), std::string::npos);

  second.start.clear();
  second.resume = true;
  EXPECT_ERROR(train_detector(second, {}), "checkpoint", "from: ", "drawn weights");
  second.resume = false;
  second.start = second.out.string();
  EXPECT_ERROR(train_detector(second, {}), "holds the detector to start from", "another --out");
}

TEST_F(Training, WhatIsNotItsOwnStays) {
  TrainingRequest wanted = request("out");
  wanted.config.epochs = 1;
  wanted.config.epoch_pictures = 24;
  make_folder(wanted.out);
  write_file(wanted.out / "other.cfg", "[net]");
  EXPECT_ERROR(train_detector(wanted, {}), "holds the model 'other'", "another --out");
  fs::remove(wanted.out / "other.cfg");
  write_file(wanted.out / ".other.partial-7.weights", "half");  // of a killed program
  write_file(wanted.out / "shapes.names", "mine");
  TrainingHooks hooks;
  hooks.started = [&](const TrainingSet&) { EXPECT_EQ(read_file(wanted.out / "shapes.names"), "mine"); };
  train_detector(wanted, hooks);
  EXPECT_EQ(read_file(wanted.out / "shapes.names"), "orange\nblue\n");
}

TEST_F(Training, TheSeedAloneDecides) {
  TrainingRequest one = request("one"), two = request("two"), other = request("other");
  for (TrainingRequest* wanted : {&one, &two, &other}) {
    wanted->config.epochs = 1;
    wanted->config.epoch_pictures = 24;
  }
  two.config.cache_mb = 0.0;  // what is decoded again is the same
  other.config.seed = 2;
  for (const TrainingRequest& wanted : {one, two, other}) train_detector(wanted, {});
  EXPECT_TRUE(weights(one) == weights(two));
  EXPECT_FALSE(weights(one) == weights(other));
}

TEST_F(Training, WhatSmallPicturesTeachHoldsForLargeOnes) {
  TrainingRequest wanted = request("out");
  wanted.config.epochs = 5;
  wanted.config.epoch_pictures = 240;
  wanted.config.small_share = 1.0;
  wanted.config.small_scale = 0.6;
  EXPECT_EQ(wanted.config.small_size(), cv::Size(96, 64));
  EXPECT_EQ(TrainConfig().small_size(), cv::Size(384, 224));
  // Anchors that shrank with the pictures would make boxes of 0.6 of the right size, whose IoU is 0.36.
  EXPECT_GT(train_detector(wanted, {}).best_ap50, 0.8);
}

TEST_F(Training, TimeIsALimit) {
  TrainingRequest wanted = request("out");
  wanted.config.minutes = 0.03;
  wanted.config.epoch_pictures = 100000;
  const TrainingSummary summary = train_detector(wanted, {});
  EXPECT_EQ(summary.epochs, 1);
}

TEST_F(Training, BadSetsAreRefusedInOneLine) {
  const TrainingRequest wanted = request("out");
  write_file(set_ / "images/p1003.png", "no picture");
  EXPECT_ERROR(train_detector(wanted, {}), "p1003.png", "not a picture that can be decoded");
  const std::string data = read_file(set_ / "set.data");
  write_file(set_ / "set.data", "train = train.txt\nnames = set.names\n");
  EXPECT_ERROR(train_detector(wanted, {}), "no split 'valid'");
  write_file(set_ / "set.data", data);
  write_file(set_ / "valid.txt", "");
  EXPECT_ERROR(train_detector(wanted, {}), "valid", "no pictures");
  for (const auto& file : fs::directory_iterator(set_ / "labels")) fs::remove(file.path());
  EXPECT_ERROR(train_detector(wanted, {}), "train", "no box");
}

}  // namespace
}  // namespace waretwin::train

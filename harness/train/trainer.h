// A detector from labelled pictures.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "harness/train/train_config.h"

namespace waretwin::train {

struct TrainingRequest {
  std::filesystem::path dataset, out;  // see harness/labelled/labelled_set.h; splits train and valid
  std::string name = "detector";       // of the files
  bool resume = false;                 // from OUT's checkpoint, if there is one; otherwise whatever training OUT holds is replaced
  std::string start;                   // a detector whose weights and anchors it starts from (start_model.h); empty: drawn ones
  TrainConfig config;
};

struct TrainingSet {
  std::size_t train_pictures = 0, valid_pictures = 0, classes = 0, boxes = 0;
  double cache_mb = 0.0;    // that decoded pictures take
  double anchor_iou = 0.0;  // mean IoU of the training boxes' shapes with the best anchor
  std::int64_t parameters = 0;
  int known_classes = 0;  // by the detector that it starts from
  int epochs_done = 0;    // by an earlier run
};

struct EpochResult {
  int epoch = 0;  // from 1
  double box_loss = 0.0, object_loss = 0.0, class_loss = 0.0;
  // On the valid split, by the averaged weights; `ap` is COCO's, over IoU from 0.5 to 0.95.
  double ap = 0.0, ap50 = 0.0, ap75 = 0.0;
  double side_error_px = 0.0;  // median, at a picture width of 1280
  double rate = 0.0, seconds = 0.0;
  bool best = false;
};

struct TrainingProgress {
  double share = 0.0;  // of the whole training
  int epoch = 0;
  double pictures_per_second = 0.0, seconds_left = 0.0;
};

struct TrainingHooks {
  std::function<void()> check;  // may throw to stop
  std::function<void(const TrainingSet&)> started;
  std::function<void(const TrainingProgress&)> progress;
  std::function<void(const EpochResult&)> epoch;
};

struct TrainingSummary {
  int epochs = 0, best_epoch = 0;
  double best_ap50 = 0.0, seconds = 0.0;
  std::filesystem::path weights;
};

// Writes OUT/NAME.cfg, NAME.names, NAME.weights at the end, train.yaml at the start, log.csv and checkpoint after each epoch. Uses
// libtorch's present number of threads, and as many of parallel_for in turn. Throws Error for datasets without pictures or boxes, for an
// OUT with a model of another name, for a checkpoint of other settings, for a start that is no such detector or lies in OUT, and where the
// loss stops being a number.
TrainingSummary train_detector(const TrainingRequest& request, const TrainingHooks& hooks);

}  // namespace waretwin::train

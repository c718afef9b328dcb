// The pictures of one hall: varied once, looked at from many places.
#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "harness/dataset/dataset_config.h"
#include "harness/dataset/hall_source.h"
#include "harness/dataset/image_record.h"

namespace waretwin {

struct Photograph {
  ImageRecord record;  // without files
  cv::Mat colour;      // CV_8UC3, BGR
  cv::Mat depth;       // CV_32FC1, metres, true; empty unless asked for
  cv::Mat instances;   // CV_16UC1
};

class HallPhotographer {
 public:
  // Varies the hall's light, materials, things and camera by the configuration's seed and `number`. The hall has the configuration's
  // camera.
  HallPhotographer(const Hall& hall, const DatasetConfig& config, const std::vector<std::string>& classes, int number);
  ~HallPhotographer();
  HallPhotographer(const HallPhotographer&) = delete;
  HallPhotographer& operator=(const HallPhotographer&) = delete;

  // The next picture: things move on by a moment from one to the next. `index` is its place in the whole set and draws the view.
  Photograph take(int index);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace waretwin

#include "harness/detect/set_scorer.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace waretwin {

namespace {

std::string joined(const std::vector<std::string>& words) {
  constexpr std::size_t kMost = 8;
  std::string text;
  for (std::size_t i = 0; i < std::min(words.size(), kMost); ++i) text += (i == 0 ? "" : ", ") + words[i];
  return words.size() > kMost ? text + " .." : text;
}

// A millionth of a pixel is beyond any label; rounding to it gives whole pixels back where the label had them.
double rounded(double pixels) { return std::round(pixels * 1e6) / 1e6; }

}  // namespace

SetScorer::SetScorer(const std::vector<std::string>& set_classes, const std::vector<std::string>& model_classes,
                     const std::vector<std::string>& wanted)
    : classes_(set_classes) {
  for (const std::string& name : classes_) {
    numbers_[name] = static_cast<int>(counted_.size());
    counted_.push_back(wanted.empty() || std::find(wanted.begin(), wanted.end(), name) != wanted.end());
  }
  if (std::none_of(model_classes.begin(), model_classes.end(), [this](const std::string& name) { return names(name); })) {
    throw Error("the model's classes (" + joined(model_classes) + ") and those of the set (" + joined(classes_) +
                ") have none in common; expected --set detect.rename=[from=to]");
  }
}

std::vector<TrueBox> SetScorer::truth_of(const LabelledImage& image, const cv::Size& size) const {
  std::vector<TrueBox> truth;
  for (const LabelledBox& label : image.boxes) {
    if (!counted_[static_cast<std::size_t>(label.class_index)]) continue;
    const cv::Rect2d& share = label.share;
    truth.push_back({label.class_index,
                     {rounded(share.x * size.width), rounded(share.y * size.height), rounded(share.width * size.width),
                      rounded(share.height * size.height)},
                     rounded(label.area * size.width * size.height),
                     label.ignored});
  }
  return truth;
}

void SetScorer::add(std::vector<TrueBox> truth, const std::vector<Detection>& detections) {
  ScoredPicture picture{std::move(truth), {}};
  std::map<int, std::size_t> counts;
  for (const Detection& d : detections) {
    const auto number = numbers_.find(d.class_name);
    if (number == numbers_.end() || ++counts[number->second] > kMostDetections) continue;
    picture.detections.push_back({number->second, d.box, static_cast<double>(d.score)});
  }
  pictures_.push_back(std::move(picture));
}

}  // namespace waretwin

#include "harness/detect/detect_run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <set>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/files.h"
#include "core/staged_folder.h"
#include "core/statistics.h"
#include "harness/detect/detection_drawing.h"
#include "mapper/detect/yolo_detector.h"
#include "sensors/recordings/recorded_image.h"

namespace waretwin {

namespace {

namespace fs = std::filesystem;

double rounded(double value, double steps) { return std::round(value * steps) / steps; }

std::string joined(const std::vector<std::string>& words) {
  constexpr std::size_t kMost = 8;
  std::string text;
  for (std::size_t i = 0; i < std::min(words.size(), kMost); ++i) text += (i == 0 ? "" : ", ") + words[i];
  return words.size() > kMost ? text + " .." : text;
}

// Numbers of the set's classes by name. Throws Error where the model knows none of them.
std::map<std::string, int> class_numbers(const LabelledSet& set, const std::vector<std::string>& model) {
  std::map<std::string, int> numbers;
  for (std::size_t k = 0; k < set.classes.size(); ++k) numbers[set.classes[k]] = static_cast<int>(k);
  const bool common = std::any_of(model.begin(), model.end(), [&](const std::string& name) { return numbers.count(name) != 0; });
  if (!set.classes.empty() && !common) {
    throw Error("the model's classes (" + joined(model) + ") and those of the set (" + joined(set.classes) +
                ") have none in common; expected --set detect.rename=[from=to]");
  }
  return numbers;
}

// Shares as pixels. A millionth of a pixel is beyond any label; rounding to it gives whole pixels back where the label had them.
std::vector<TrueBox> truth_of(const LabelledImage& image, const cv::Size& size, const std::vector<bool>& counted) {
  constexpr double kSteps = 1e6;
  std::vector<TrueBox> truth;
  for (const LabelledBox& label : image.boxes) {
    if (!counted[static_cast<std::size_t>(label.class_index)]) continue;
    TrueBox box;
    box.class_index = label.class_index;
    box.box = {rounded(label.share.x * size.width, kSteps), rounded(label.share.y * size.height, kSteps),
               rounded(label.share.width * size.width, kSteps), rounded(label.share.height * size.height, kSteps)};
    box.area = rounded(label.area * size.width * size.height, kSteps);
    box.ignored = label.ignored;
    truth.push_back(box);
  }
  return truth;
}

// Of each class of the set no more than COCO counts, since a low threshold lets hundreds pass. `detections` come best first.
std::vector<ScoredBox> scored_boxes(const std::vector<Detection>& detections, const std::map<std::string, int>& numbers) {
  std::vector<ScoredBox> boxes;
  std::map<int, std::size_t> counts;
  for (const Detection& d : detections) {
    const auto number = numbers.find(d.class_name);
    if (number == numbers.end() || ++counts[number->second] > kMostDetections) continue;
    boxes.push_back({number->second, d.box, static_cast<double>(d.score)});
  }
  return boxes;
}

nlohmann::ordered_json detections_json(const std::vector<Detection>& detections) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Detection& d : detections) {
    const double x = rounded(d.box.x, 1e3), y = rounded(d.box.y, 1e3);
    list.push_back({{"class", d.class_name},
                    {"box", {x, y, rounded(d.box.width, 1e3), rounded(d.box.height, 1e3)}},
                    {"score", rounded(d.score, 1e6)}});
  }
  return list;
}

void write_jpeg(const fs::path& file, const cv::Mat& image) {
  std::vector<unsigned char> bytes;
  if (!cv::imencode(".jpg", image, bytes, {cv::IMWRITE_JPEG_QUALITY, 90})) {
    throw InternalError("a picture could not be encoded: " + file.string());
  }
  write_file(file, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

// Names for drawn pictures: the picture's own stem, numbered where two have the same.
class DrawnNames {
 public:
  std::string next(const fs::path& picture) {
    const std::string stem = picture.stem().string();
    std::string name = stem;
    for (int i = 2; !taken_.insert(name).second; ++i) name = stem + "_" + std::to_string(i);
    return name + ".jpg";
  }

 private:
  std::set<std::string> taken_;
};

// Where drawn pictures of an earlier run may be replaced: nobody's own pictures get lost.
void check_place(const fs::path& out, const LabelledSet& set) {
  const fs::path place = out / "pictures";
  if (!fs::exists(place)) return;
  if (!fs::exists(out / "detections.json")) throw Error(place, "is there already and not from an earlier run; expected another --out");
  std::set<fs::path> folders;
  for (const LabelledImage& image : set.images) folders.insert(fs::absolute(image.file).parent_path());
  for (const fs::path& folder : folders) {
    if (fs::equivalent(folder, place)) {
      throw Error(place, "would be replaced but holds the pictures to look at; expected another --out");
    }
  }
}

}  // namespace

DetectRunResult detect_pictures(const fs::path& model, const LabelledSet& set, const DetectRunConfig& config, const fs::path& out,
                                const DetectProgress& progress) {
  const bool labelled = !set.classes.empty();
  DetectConfig network = config.detect;
  if (labelled) network.confidence = std::min(network.confidence, config.score.ap_confidence);
  YoloDetector detector(model, network);
  const std::map<std::string, int> numbers = class_numbers(set, detector.class_names());
  std::vector<bool> counted(set.classes.size(), true);
  for (std::size_t k = 0; k < counted.size() && !config.detect.classes.empty(); ++k) {
    counted[k] = std::count(config.detect.classes.begin(), config.detect.classes.end(), set.classes[k]) > 0;
  }

  make_folder(out);
  check_place(out, set);
  std::error_code ignored;
  fs::remove(out / "metrics.json", ignored);  // it would speak of other detections
  DetectRunResult result;
  std::vector<ScoredPicture> scored;
  std::vector<double> times_ms;
  DrawnNames drawn_names;
  int found = 0;
  std::optional<StagedFolder> drawn;
  if (config.pictures) drawn.emplace(out / "pictures");
  write_file_by(out / "detections.json", [&](const fs::path& temporary) {
    GrowingFile file(temporary);
    file.append("[");
    for (const LabelledImage& image : set.images) {
      const cv::Mat colour = read_colour_image(image.file);
      const auto start = std::chrono::steady_clock::now();
      std::vector<Detection> detections = detector.detect(colour);
      times_ms.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
      ScoredPicture picture;
      picture.truth = truth_of(image, colour.size(), counted);
      if (labelled) picture.detections = scored_boxes(detections, numbers);
      std::erase_if(detections, [&](const Detection& d) { return static_cast<double>(d.score) < config.detect.confidence; });
      nlohmann::ordered_json entry;
      entry["file"] = image.name;
      entry["size"] = {colour.cols, colour.rows};
      if (drawn) {
        const std::string name = drawn_names.next(image.file);
        write_jpeg(drawn->path() / name, draw_detections(colour, detections, picture.truth, set.classes));
        entry["picture"] = "pictures/" + name;
      }
      entry["detections"] = detections_json(detections);
      file.append((result.pictures == 0 ? "\n" : ",\n") + entry.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
      for (const Detection& d : detections) {
        ++result.detections[d.class_name];
        if (labelled && numbers.count(d.class_name) == 0) ++result.other_detections;
      }
      found += static_cast<int>(detections.size());
      if (labelled) scored.push_back(std::move(picture));
      ++result.pictures;
      progress(static_cast<double>(result.pictures) / static_cast<double>(set.images.size()), result.pictures, found);
    }
    file.append("\n]\n");
    file.close();
  });
  if (drawn)
    drawn->commit();
  else
    fs::remove_all(out / "pictures", ignored);  // check_place knows them to be ours
  result.median_ms = median(times_ms);
  if (labelled) result.score = score_detections(scored, set.classes, {config.detect.confidence, config.score.match_iou});
  return result;
}

}  // namespace waretwin

#include "harness/detect/detect_run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "core/error.h"
#include "core/files.h"
#include "core/staged_folder.h"
#include "core/statistics.h"
#include "harness/detect/detection_drawing.h"
#include "harness/detect/set_scorer.h"
#include "harness/pictures/picture_file.h"
#include "mapper/detect/yolo_detector.h"
#include "sensors/recordings/recorded_image.h"

namespace waretwin {

namespace {

namespace fs = std::filesystem;

constexpr int kDrawnQuality = 90;  // of JPEG

double rounded(double value, double steps) { return std::round(value * steps) / steps; }

// An entry of detections.json, one line.
std::string picture_json(const std::string& name, const cv::Size& size, const std::string& drawn,
                         const std::vector<Detection>& detections) {
  nlohmann::ordered_json entry;
  entry["file"] = name;
  entry["size"] = {size.width, size.height};
  if (!drawn.empty()) entry["picture"] = "pictures/" + drawn;
  entry["detections"] = nlohmann::ordered_json::array();
  for (const Detection& d : detections) {
    const double x = rounded(d.box.x, 1e3), y = rounded(d.box.y, 1e3);
    entry["detections"].push_back({{"class", d.class_name},
                                   {"box", {x, y, rounded(d.box.width, 1e3), rounded(d.box.height, 1e3)}},
                                   {"score", rounded(d.score, 1e6)}});
  }
  // Names of files come in whatever encoding.
  return entry.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
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
  std::optional<SetScorer> scorer;
  if (labelled) scorer.emplace(set.classes, detector.class_names(), config.detect.classes);

  make_folder(out);
  check_place(out, set);
  std::error_code ignored;
  DetectRunResult result;
  std::vector<double> times_ms;
  DrawnNames drawn_names;
  int found = 0, others = 0;
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
      std::vector<TrueBox> truth;
      if (scorer) truth = scorer->truth_of(image, colour.size());
      if (scorer) scorer->add(truth, detections);
      // From here on what is shown.
      std::erase_if(detections, [&](const Detection& d) { return static_cast<double>(d.score) < config.detect.confidence; });
      std::string drawn_name;
      if (drawn) {
        drawn_name = drawn_names.next(image.file);
        write_file(drawn->path() / drawn_name, encoded_jpeg(draw_detections(colour, detections, truth, set.classes), kDrawnQuality));
      }
      file.append((result.pictures == 0 ? "\n" : ",\n") + picture_json(image.name, colour.size(), drawn_name, detections));
      for (const Detection& d : detections) {
        ++result.detections[d.class_name];
        if (scorer && !scorer->names(d.class_name)) ++others;
      }
      found += static_cast<int>(detections.size());
      ++result.pictures;
      progress(static_cast<double>(result.pictures) / static_cast<double>(set.images.size()), result.pictures, found);
    }
    file.append("\n]\n");
    file.close();
  });
  fs::remove(out / "metrics.json", ignored);  // it would speak of other detections
  if (drawn)
    drawn->commit();
  else
    fs::remove_all(out / "pictures", ignored);  // check_place knows them to be ours
  result.median_ms = median(times_ms);
  if (scorer) {
    result.score = scorer->score({config.detect.confidence, config.score.match_iou});
    result.score->other_detections = others;
  }
  return result;
}

}  // namespace waretwin

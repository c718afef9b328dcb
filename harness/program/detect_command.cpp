// waretwin detect: a detector on pictures, and how good it is on labelled ones.
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>

#include "core/error.h"
#include "core/files.h"
#include "harness/detect/detect_run.h"
#include "harness/labelled/labelled_set.h"
#include "harness/program/common_options.h"
#include "harness/program/interrupt.h"
#include "harness/program/progress.h"

namespace waretwin {

namespace {

namespace fs = std::filesystem;

struct DetectOptions {
  CommonOptions common;
  std::string model, out, split;
  std::vector<std::string> inputs;
  bool no_pictures = false;
};

// Pictures without labels: files, and all of a folder.
LabelledSet plain_pictures(const std::vector<std::string>& inputs) {
  LabelledSet set;
  for (const fs::path input : inputs) {
    if (!fs::exists(input)) throw Error(input, "no such file; expected a picture, a folder of pictures or a labelled set");
    if (!fs::is_directory(input)) {
      set.images.push_back({input, input.string(), {}});
      continue;
    }
    const std::vector<fs::path> pictures = pictures_in(input);
    if (pictures.empty()) throw Error(input, "holds no pictures; expected pictures or a labelled set");
    for (const fs::path& picture : pictures) set.images.push_back({picture, picture.string(), {}});
  }
  return set;
}

int detect(DetectOptions options) {
  options.common.apply();
  DetectRunConfig config;
  config.pictures = !options.no_pictures;
  apply_settings(options.common.settings(), [&](Fields& f) { config.visit(f); });

  const bool labelled = options.inputs.size() == 1 && is_labelled_set(options.inputs.front());
  if (!labelled && !options.split.empty()) {
    throw Error("--split " + options.split + ": " + options.inputs.front() + " is no labelled set (one *.data, *.json or folder)");
  }
  if (labelled && options.split.empty()) {
    const std::vector<std::string> splits = splits_of(options.inputs.front());
    options.split = std::find(splits.begin(), splits.end(), "test") != splits.end() ? "test" : "all";
  }
  const LabelledSet set = labelled ? read_labelled_set(options.inputs.front(), options.split) : plain_pictures(options.inputs);
  DetectRunResult result;
  {
    const InterruptWatch watch;
    Progress progress("detect", options.common.quiet);
    result = detect_pictures(options.model, set, config, options.out, [&](double done, int pictures, int found) {
      watch.check("nothing was written");
      progress.update(done, std::to_string(pictures) + " pictures, " + std::to_string(found) + " detections");
    });
  }
  if (result.score) {
    const DetectionRunFacts facts{options.model, options.inputs.front(), options.split,
                                  std::min(config.score.ap_confidence, config.detect.confidence), result.median_ms};
    write_file(fs::path(options.out) / "metrics.json", metrics_json(*result.score, facts));
    std::cout << metrics_table(*result.score, facts);
    if (const int others = result.score->other_detections; others > 0) {
      spdlog::info("{} detections are of classes that the set does not name: in no score", others);
    }
  } else {
    std::cout << result.pictures << (result.pictures == 1 ? " picture" : " pictures");
    for (const auto& [name, count] : result.detections) std::cout << ", " << name << " " << count;
    std::cout << (result.detections.empty() ? ", nothing found\n" : "\n");
  }
  std::cout << "results in " << options.out << " (" << (result.score ? "metrics.json, " : "") << "detections.json"
            << (config.pictures ? ", pictures/" : "") << ")\n";
  return 0;
}

}  // namespace

Command add_detect_command(CLI::App& program) {
  auto options = std::make_shared<DetectOptions>();
  CLI::App* command =
      program.add_subcommand("detect", "a detector on pictures; on labelled ones also how good it is (AP, precision, recall)");
  command
      ->add_option("MODEL", options->model,
                   "folder with a model, .cfg or .weights (Darknet), .onnx (YOLOv5, YOLOv8), or a shipped model's name")
      ->required();
  command
      ->add_option("IMAGE..|DATASET", options->inputs,
                   "pictures or folders of them; or one labelled set: folder, .data file (Darknet) or COCO JSON file")
      ->required();
  command->add_option("--out", options->out, "folder for the results; an earlier run's are replaced at the end")
      ->required()
      ->type_name("DIR");
  command->add_option("--split", options->split, "which part of a labelled set (default: test where there is one, else all)")
      ->check(CLI::IsMember({"train", "valid", "test", "all"}));
  command->add_flag("--no-pictures", options->no_pictures, "no drawn pictures");
  options->common.add_to(*command);
  command->footer(
      "Example:\n  waretwin detect models/yolo-coco photo.jpg --out out/boxes\n"
      "  waretwin detect trained/best.onnx datasets/hall --split valid --out out/score --set detect.confidence=0.4\n\n"
      "detections.json and pictures/ show what reaches detect.confidence (0.5), and precision, recall and the list of what is wrong count\n"
      "that alone. AP and AR need weak detections, too: on a labelled set all from score.ap_confidence (0.001) on go into them.\n"
      "Keys for --set: detect.confidence, detect.nms_iou, detect.input_width, detect.input_height, detect.letterbox, detect.names,\n"
      "detect.classes, detect.rename (detect.rename=[truck=forklift]), score.ap_confidence, score.match_iou.");
  return {command, [options] { return detect(*options); }};
}

}  // namespace waretwin

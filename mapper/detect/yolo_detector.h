// Detection by a YOLO network (Redmon and Farhadi 2017) through OpenCV's dnn module: Darknet and ONNX models.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "mapper/detect/detect_config.h"
#include "mapper/detect/detector.h"

namespace waretwin {

// What a model's detections may be called: its names after renaming and filtering. Reads no network. Throws Error as YoloDetector does.
std::vector<std::string> detected_classes(const std::filesystem::path& model, const DetectConfig& config);

class YoloDetector : public Detector {
 public:
  // `model`: a folder, a .cfg or .weights file, an .onnx file, or a shipped model's name (see find_model_files). Throws Error, one line,
  // where a file is missing, damaged or truncated, where names and network disagree in number, or where a class to keep is no name of the
  // model.
  YoloDetector(const std::filesystem::path& model, const DetectConfig& config);
  ~YoloDetector() override;

  // Best score first. Throws Error where an ONNX network's output has a shape that no YOLO head has.
  std::vector<Detection> detect(const RgbdFrame& frame) override;
  std::vector<Detection> detect(const cv::Mat& colour);  // CV_8UC3, BGR

  // See detected_classes.
  std::vector<std::string> class_names() const;

 private:
  struct Network;

  DetectConfig config_;
  std::vector<std::string> names_;  // after renaming, by the network's class number
  std::unique_ptr<Network> network_;
};

}  // namespace waretwin

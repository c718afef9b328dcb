#include "mapper/detect/yolo_detector.h"

#include <algorithm>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/dnn.hpp>
#include <opencv2/dnn/all_layers.hpp>
#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "core/files.h"
#include "mapper/detect/darknet_cfg.h"
#include "mapper/detect/model_files.h"
#include "mapper/detect/resized_picture.h"
#include "mapper/detect/yolo_decode.h"

namespace waretwin {
namespace {

// OpenCV's importers write to stderr before they throw; the exception says it all.
class QuietOpenCv {
 public:
  QuietOpenCv() : level_(cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT)) {}
  ~QuietOpenCv() { cv::utils::logging::setLogLevel(level_); }
  QuietOpenCv(const QuietOpenCv&) = delete;
  QuietOpenCv& operator=(const QuietOpenCv&) = delete;

 private:
  cv::utils::logging::LogLevel level_;
};

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

// The model's names as the configuration wants them, one for each class of the network.
std::vector<std::string> renamed(std::vector<std::string> names, const std::filesystem::path& file, const DetectConfig& config) {
  const std::vector<std::string> original = names;
  for (const std::string& pair : config.rename) {
    const auto equals = pair.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == pair.size()) {
      throw Error("detector rename '" + pair + "'; expected from=to");
    }
    const std::string from = pair.substr(0, equals);
    if (std::find(original.begin(), original.end(), from) == original.end()) {
      throw Error("detector rename '" + pair + "'; the model has no class '" + from + "'");
    }
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (original[i] == from) names[i] = pair.substr(equals + 1);
    }
  }
  for (const std::string& name : config.classes) {
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      throw Error(file, "class '" + name + "' is to be kept; the model does not have it");
    }
  }
  return names;
}

bool is_kept(const std::string& name, const DetectConfig& config) {
  return config.classes.empty() || std::find(config.classes.begin(), config.classes.end(), name) != config.classes.end();
}

// Each once.
std::vector<std::string> kept_names(const std::vector<std::string>& names, const DetectConfig& config) {
  std::vector<std::string> kept;
  for (const std::string& name : names) {
    if (is_kept(name, config) && std::find(kept.begin(), kept.end(), name) == kept.end()) kept.push_back(name);
  }
  return kept;
}

constexpr int kOnnxInput = 640;         // pixels, where neither the configuration nor the model says
constexpr double kLetterboxGrey = 114;  // the grey that YOLOv5 and YOLOv8 are trained with

}  // namespace

std::vector<std::string> detected_classes(const std::filesystem::path& model, const DetectConfig& config) {
  const std::filesystem::path file = find_model_files(model, config.names).names;
  return kept_names(renamed(read_class_names(file), file, config), config);
}

struct YoloDetector::Network {
  ModelFiles files;
  cv::dnn::Net net;
  std::vector<std::string> outputs;
  cv::Size input;
  bool letterbox = false;

  // The picture as the network wants it, and where in it the picture lies.
  cv::Mat place(const cv::Mat& colour, InputPlacement& placement) const {
    cv::Mat placed;
    if (!letterbox) {
      placement = {static_cast<double>(input.width) / colour.cols, static_cast<double>(input.height) / colour.rows, 0.0, 0.0};
      placed.create(input, CV_8UC3);
      resize_picture(colour, placed);
      return placed;
    }
    const double scale = std::min(static_cast<double>(input.width) / colour.cols, static_cast<double>(input.height) / colour.rows);
    const cv::Size size(std::max(1, static_cast<int>(std::lround(scale * colour.cols))),
                        std::max(1, static_cast<int>(std::lround(scale * colour.rows))));
    const cv::Point corner((input.width - size.width) / 2, (input.height - size.height) / 2);
    placement = {static_cast<double>(size.width) / colour.cols, static_cast<double>(size.height) / colour.rows,
                 static_cast<double>(corner.x), static_cast<double>(corner.y)};
    placed = cv::Mat(input, CV_8UC3, cv::Scalar::all(kLetterboxGrey));
    cv::Mat window = placed(cv::Rect(corner, size));
    resize_picture(colour, window);
    return placed;
  }
};

YoloDetector::YoloDetector(const std::filesystem::path& model, const DetectConfig& config)
    : config_(config), network_(std::make_unique<Network>()) {
  Network& network = *network_;
  network.files = find_model_files(model, config.names);
  const ModelFiles& files = network.files;
  names_ = read_class_names(files.names);
  network.input = {kOnnxInput, kOnnxInput};
  const QuietOpenCv quiet;
  try {
    if (files.darknet()) {
      const DarknetSummary summary = read_darknet_cfg(files.cfg);
      check_darknet_weights(files.weights, summary);
      if (summary.classes != static_cast<int>(names_.size())) {
        throw Error(files.names, std::to_string(names_.size()) + " class names; the network " + files.cfg.string() + " has " +
                                     std::to_string(summary.classes) + " classes");
      }
      network.input = {summary.width, summary.height};
      const std::string cfg = darknet_cfg_with_all_scores(files.cfg), weights = read_file(files.weights);
      network.net = cv::dnn::readNetFromDarknet(cfg.data(), cfg.size(), weights.data(), weights.size());
    } else {
      network.net = cv::dnn::readNetFromONNX(files.onnx.string());
    }
    network.net.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
    network.net.setPreferableTarget(cv::dnn::DNN_TARGET_CPU);
    network.outputs = network.net.getUnconnectedOutLayersNames();
    // Which boxes overlap too much is decided below, for all kinds of networks, and only among those that reach the confidence.
    for (const std::string& name : network.outputs) {
      const auto region = network.net.getLayer(name).dynamicCast<cv::dnn::RegionLayer>();
      if (region) region->nmsThreshold = 0.0f;
    }
  } catch (const cv::Exception& problem) {
    throw Error(files.darknet() ? files.cfg : files.onnx, "not a network that can be loaded: " + one_line(problem.err));
  }
  if (network.outputs.empty()) throw Error(files.darknet() ? files.cfg : files.onnx, "a network without outputs; expected a YOLO detector");
  if (config.input_width > 0) network.input.width = config.input_width;
  if (config.input_height > 0) network.input.height = config.input_height;
  network.letterbox = config.letterbox == "on" || (config.letterbox == "auto" && !files.darknet());

  names_ = renamed(std::move(names_), files.names, config);
}

YoloDetector::~YoloDetector() = default;

std::vector<std::string> YoloDetector::class_names() const { return kept_names(names_, config_); }

std::vector<Detection> YoloDetector::detect(const RgbdFrame& frame) { return detect(frame.colour); }

std::vector<Detection> YoloDetector::detect(const cv::Mat& colour) {
  WARETWIN_CHECK(!colour.empty() && colour.type() == CV_8UC3, "colour pictures are 8-bit BGR");
  Network& network = *network_;
  const std::filesystem::path& file = network.files.darknet() ? network.files.cfg : network.files.onnx;
  InputPlacement placement;
  const cv::Mat placed = network.place(colour, placement);
  std::vector<cv::Mat> outputs;
  const QuietOpenCv quiet;
  try {
    network.net.setInput(cv::dnn::blobFromImage(placed, 1.0 / 255.0, network.input, cv::Scalar(), true, false));
    network.net.forward(outputs, network.outputs);
  } catch (const cv::Exception& problem) {
    throw Error(file, "the network fails on an input of " + std::to_string(network.input.width) + " x " +
                          std::to_string(network.input.height) + " pixels (input_width, input_height): " + one_line(problem.err));
  }
  std::vector<Detection> detections;
  const int classes = static_cast<int>(names_.size());
  if (network.files.darknet()) {
    for (const cv::Mat& output : outputs) {
      // A batch of one may come with its own dimension.
      const int columns = output.size[output.dims - 1];
      if (output.type() != CV_32F || columns != 5 + classes) {
        throw Error(file, "an output with " + std::to_string(columns) + " columns; expected " + std::to_string(5 + classes));
      }
      const cv::Mat rows(static_cast<int>(output.total()) / columns, columns, CV_32F,
                         const_cast<void*>(static_cast<const void*>(output.data)));
      decode_rows(rows, YoloRows::kDarknet, network.input, placement, colour.size(), config_.confidence, names_, detections);
    }
  } else {
    YoloRows layout = YoloRows::kObjectness;
    cv::Mat rows;
    try {
      rows = rows_of_onnx_output(outputs.front(), classes, layout);
    } catch (const Error& problem) {
      throw Error(file, problem.what());
    }
    decode_rows(rows, layout, network.input, placement, colour.size(), config_.confidence, names_, detections);
  }
  detections.erase(
      std::remove_if(detections.begin(), detections.end(), [this](const Detection& d) { return !is_kept(d.class_name, config_); }),
      detections.end());
  return suppress_overlaps(std::move(detections), config_.nms_iou);
}

}  // namespace waretwin

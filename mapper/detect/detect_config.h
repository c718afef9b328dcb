// Constants of detection by a YOLO network.
#pragma once

#include <string>
#include <vector>

#include "core/fields.h"

namespace waretwin {

struct DetectConfig {
  double confidence = 0.5;                // detections below this score are dropped
  double nms_iou = 0.45;                  // of two boxes of one class that overlap more, the better one stays
  int input_width = 0;                    // pixels; 0 = what the model says (Darknet cfg), 640 for ONNX
  int input_height = 0;                   // pixels
  std::string letterbox = "auto";         // "auto": on for ONNX, off for Darknet, which stretches
  std::string names = {};                 // file with one class name a line; empty = beside the model
  std::vector<std::string> classes = {};  // names that are kept; empty = all
  std::vector<std::string> rename = {};   // "from=to" pairs, applied before `classes`

  void visit(Fields& f) {
    f("confidence", confidence, "smallest score of a detection", {.min = 0, .max = 1});
    f("nms_iou", nms_iou, "overlap above which the weaker box of one class is dropped", {.min = 0, .max = 1});
    f("input_width", input_width, "width of the network's input in pixels; 0 = the model's own (ONNX: 640)", {.min = 0, .max = 8192});
    f("input_height", input_height, "height of the network's input in pixels; 0 = the model's own (ONNX: 640)", {.min = 0, .max = 8192});
    f("letterbox", letterbox, "keep the picture's proportions by grey bars (on) or stretch it (off)", {.choices = {"auto", "on", "off"}});
    f("names", names, "file of class names, one a line; empty = the .names file beside the model");
    f("classes", classes, "class names that are kept; empty = all");
    f("rename", rename, "class names to be changed, as from=to");
  }
};

}  // namespace waretwin

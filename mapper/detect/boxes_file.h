// Boxes that somebody else found, for each frame, from files.
#pragma once

#include <filesystem>
#include <map>
#include <vector>

#include "core/stamp.h"
#include "mapper/detect/detect_config.h"
#include "mapper/detect/detector.h"

namespace waretwin {

// By frame; boxes in pixels of the (upright) colour image as in Detection, not yet cut to it.
using FrameBoxes = std::map<Stamp, std::vector<Detection>>;

// Either one JSON file for all frames,
//   {"frames": [{"stamp": NANOSECONDS, "detections": [{"class": "conveyor", "box": [x, y, width, height], "score": 0.9,
//                 "mask": {"size": [height, width], "counts": RUNS}}]}]}
// or a folder with a text file a frame, as the paper's authors keep them: called by the picture's stamp in seconds (1654000000.123456.txt),
// a row a box, "class x y w h score", x and y those of the upper left corner. "score" may be left out (1); an empty file is a frame
// without boxes. A mask, where there is one, is that of COCO: of the whole picture, its runs compressed (a text) or as a list. A class is a
// name, or a number whose name stands in config.names, else in classes.txt or the .names file in the folder. config.rename and
// config.classes change and pick names; nothing else of the configuration counts. Throws Error naming file, frame or line and key for what
// is neither.
FrameBoxes read_boxes(const std::filesystem::path& path, const DetectConfig& config = {});

// Whether a path is taken for boxes, not for a model: a .json file, or a folder with text files called by stamps.
bool is_boxes(const std::filesystem::path& path);

}  // namespace waretwin

// Labelled pictures on disk, in the layouts that detectors are trained from: what `waretwin dataset` writes, and what people label by hand.
#pragma once

#include <filesystem>
#include <opencv2/core/types.hpp>
#include <string>
#include <vector>

namespace waretwin {

struct LabelledBox {
  int class_index = 0;  // into LabelledSet::classes
  cv::Rect2d share;     // left, top, width, height as shares of the picture, so that nobody has to open it: x * width is pixels
  // Not to be found and no mistake if found: COCO's "iscrowd" and "ignore"; ignored/NAME.txt and "left_out" of `waretwin dataset`.
  bool ignored = false;
};

struct LabelledImage {
  std::filesystem::path file;  // as it can be opened
  std::string name;            // as the set names it: "images/000001.jpg"
  std::vector<LabelledBox> boxes;
};

struct LabelledSet {
  std::vector<std::string> classes;
  std::vector<LabelledImage> images;  // in the set's own order, by name where it has none
};

// `dataset` is
//   - a folder with one .data file (Darknet: names, train, valid, test; paths relative to the folder) and labels/NAME.txt for
//   images/NAME.jpg,
//     or NAME.txt beside the picture; or that .data file itself;
//   - a folder with pictures, in it or in images/, such text files and one .names or classes.txt file, all of which are then its only
//   split;
//   - a COCO JSON file, or a folder with annotations/*_SPLIT.json, whose pictures lie beside it, in images/ or one folder up.
// `split`: train, valid, test, or all. A picture without a text file has no objects. Throws Error naming file, line and key for a
// dataset that is none of these, a missing split, a class number without a name, and boxes that are no boxes.
LabelledSet read_labelled_set(const std::filesystem::path& dataset, const std::string& split);

}  // namespace waretwin

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
  // Of the object's own outline as a share of the picture's area, where the set says it (COCO's "area"); 0: that of the box.
  double area = 0.0;
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
// dataset that is none of these, a missing split, a class number without a name, a missing picture, and boxes that are no boxes. Boxes are
// cut off at the picture's edges; COCO annotations without width or height (COCO's own set has some) are left out.
LabelledSet read_labelled_set(const std::filesystem::path& dataset, const std::string& split);

// Whether `dataset` is one of these by the files that are there; nothing but file names is read.
bool is_labelled_set(const std::filesystem::path& dataset);

// Which of train, valid and test the dataset names, in this order; none where it is one piece ("all"). Throws Error as above.
std::vector<std::string> splits_of(const std::filesystem::path& dataset);

// Pictures of a folder by their endings, by name.
std::vector<std::filesystem::path> pictures_in(const std::filesystem::path& folder);

}  // namespace waretwin

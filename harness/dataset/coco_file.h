// COCO instance annotations (cocodataset.org, "Data format"), written picture by picture.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/files.h"
#include "harness/dataset/image_record.h"

namespace waretwin {

// One file. Beside COCO's own keys an image has "hall", "kind", "intrinsics" (fx, fy, cx, cy) and "X_WC" (x, y, z, qx, qy, qz, qw); an
// annotation has "rle" (the mask, compressed), "amodal_bbox" (reaches beyond the picture) and "visible", "occluded", "truncated" (shares,
// docs/truth.md). Beside "annotations" stands "left_out": visible objects without a label, with "image_id", "category_id", "bbox" and
// "why" (hidden, small). Image ids are the picture's index + 1, category ids the class + 1.
class CocoFile {
 public:
  // Writes to a temporary name until finish(). Throws Error where the file cannot be made.
  CocoFile(std::filesystem::path file, const std::vector<std::string>& classes, const std::string& about);
  ~CocoFile();
  CocoFile(const CocoFile&) = delete;
  CocoFile& operator=(const CocoFile&) = delete;

  void add(const ImageRecord& image, const std::string& hall);
  void finish();

 private:
  std::filesystem::path file_, images_file_, annotations_file_, left_out_file_;
  std::string head_;
  GrowingFile images_, annotations_, left_out_;  // put together at the end: COCO lists all images before all annotations
  long annotation_count_ = 0;
  bool any_image_ = false, any_left_out_ = false;
};

}  // namespace waretwin

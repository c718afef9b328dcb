// COCO instance annotations (cocodataset.org, "Data format"), written picture by picture.
#pragma once

#include <filesystem>
#include <iosfwd>
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
  CocoFile(const CocoFile&) = delete;
  CocoFile& operator=(const CocoFile&) = delete;

  void add(const ImageRecord& image, const std::string& hall);
  void finish();

 private:
  // A list in the making, in a file of its own until it is put into the whole one: COCO lists all images before all annotations.
  class List {
   public:
    List(const std::filesystem::path& file, const char* key);
    ~List();
    List(const List&) = delete;
    List& operator=(const List&) = delete;

    void add(const std::string& entry);
    long count() const { return count_; }
    // Nothing may be added after it.
    void put_into(std::ostream& out);

   private:
    std::string key_;
    std::filesystem::path part_;
    GrowingFile entries_;
    long count_ = 0;
  };

  std::filesystem::path file_;
  std::string head_;
  List images_, annotations_, left_out_;
};

}  // namespace waretwin

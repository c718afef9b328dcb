#include "harness/dataset/coco_file.h"

#include <unistd.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "core/error.h"

namespace waretwin {

namespace fs = std::filesystem;

namespace {

using Json = nlohmann::ordered_json;

double rounded(double share) { return std::round(share * 1e4) / 1e4; }
Json box_json(const cv::Rect& box) { return {box.x, box.y, box.width, box.height}; }

// Processes of several machines may finish one set in one folder, and have the same ids.
fs::path part_of(const fs::path& file, const char* part) {
  std::random_device random;
  return file.parent_path() / ("." + file.stem().string() + "." + part + "." + std::to_string(getpid()) + "-" + std::to_string(random()));
}

void append_file(std::ofstream& out, const fs::path& part) {
  std::ifstream in(part, std::ios::binary);
  if (!in) throw Error(part, "is gone before it was put into its file");
  if (in.peek() != std::ifstream::traits_type::eof()) out << in.rdbuf();
}

}  // namespace

CocoFile::CocoFile(fs::path file, const std::vector<std::string>& classes, const std::string& about)
    : file_(std::move(file)),
      images_file_(part_of(file_, "images")),
      annotations_file_(part_of(file_, "annotations")),
      left_out_file_(part_of(file_, "left_out")),
      images_(images_file_),
      annotations_(annotations_file_),
      left_out_(left_out_file_) {
  Json categories = Json::array();
  for (std::size_t i = 0; i < classes.size(); ++i) categories.push_back({{"id", i + 1}, {"name", classes[i]}, {"supercategory", "object"}});
  head_ =
      "{\"info\":" + Json({{"description", about}, {"version", "1.0"}}).dump() + ",\n\"licenses\":[],\n\"categories\":" + categories.dump();
}

CocoFile::~CocoFile() {
  std::error_code ignored;
  fs::remove(images_file_, ignored);
  fs::remove(annotations_file_, ignored);
  fs::remove(left_out_file_, ignored);
}

void CocoFile::add(const ImageRecord& image, const std::string& hall) {
  const Intrinsics& k = image.intrinsics;
  const Eigen::Quaterniond q(image.X_WC.rotation());
  const Eigen::Vector3d& p = image.X_WC.translation();
  Json entry;
  entry["id"] = image.index + 1;
  entry["file_name"] = image.name + ".jpg";
  entry["width"] = k.width;
  entry["height"] = k.height;
  entry["hall"] = hall;
  entry["kind"] = image.kind;
  entry["intrinsics"] = {k.fx, k.fy, k.cx, k.cy};
  entry["X_WC"] = {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()};
  images_.append((any_image_ ? ",\n" : "") + entry.dump());
  any_image_ = true;
  for (const ImageLabel& label : image.labels.labels) {
    Json annotation;
    annotation["id"] = annotation_count_ + 1;
    annotation["image_id"] = image.index + 1;
    annotation["category_id"] = label.class_index + 1;
    annotation["bbox"] = box_json(label.box);
    annotation["area"] = label.area_px;
    annotation["iscrowd"] = 0;
    annotation["segmentation"] = label.polygons;
    annotation["rle"] = {{"size", {k.height, k.width}}, {"counts", label.runs}};
    annotation["amodal_bbox"] = box_json(label.amodal_box);
    annotation["visible"] = rounded(label.visible);
    annotation["occluded"] = rounded(label.occluded);
    annotation["truncated"] = rounded(label.truncated);
    annotation["object"] = label.object_id;
    annotations_.append((annotation_count_ > 0 ? ",\n" : "") + annotation.dump());
    ++annotation_count_;
  }
  for (const LeftOut& object : image.labels.left_out) {
    Json left_out;
    left_out["image_id"] = image.index + 1;
    left_out["category_id"] = object.class_index + 1;
    left_out["bbox"] = box_json(object.box);
    left_out["why"] = to_text(object.why);
    left_out_.append((any_left_out_ ? ",\n" : "") + left_out.dump());
    any_left_out_ = true;
  }
}

void CocoFile::finish() {
  images_.close();
  annotations_.close();
  left_out_.close();
  write_file_by(file_, [&](const fs::path& temporary) {
    std::ofstream out(temporary, std::ios::binary);
    out << head_ << ",\n\"images\":[\n";
    append_file(out, images_file_);
    out << "\n],\n\"annotations\":[\n";
    append_file(out, annotations_file_);
    out << "\n],\n\"left_out\":[\n";
    append_file(out, left_out_file_);
    out << "\n]}\n";
    out.close();
    if (!out) throw Error(file_, "could not be written; is the disk full?");
  });
}

}  // namespace waretwin

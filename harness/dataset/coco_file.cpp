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

}  // namespace

CocoFile::List::List(const fs::path& file, const char* key) : key_(key), part_(part_of(file, key)), entries_(part_) {}

CocoFile::List::~List() {
  std::error_code ignored;
  fs::remove(part_, ignored);
}

void CocoFile::List::add(const std::string& entry) {
  entries_.append((count_ > 0 ? ",\n" : "") + entry);
  ++count_;
}

void CocoFile::List::put_into(std::ostream& out) {
  entries_.close();
  out << ",\n\"" << key_ << "\":[\n";
  std::ifstream in(part_, std::ios::binary);
  if (!in) throw Error(part_, "is gone before it was put into its file");
  if (count_ > 0) out << in.rdbuf();
  out << "\n]";
}

CocoFile::CocoFile(fs::path file, const std::vector<std::string>& classes, const std::string& about)
    : file_(std::move(file)), images_(file_, "images"), annotations_(file_, "annotations"), left_out_(file_, "left_out") {
  Json categories = Json::array();
  for (std::size_t i = 0; i < classes.size(); ++i) categories.push_back({{"id", i + 1}, {"name", classes[i]}, {"supercategory", "object"}});
  head_ =
      "{\"info\":" + Json({{"description", about}, {"version", "1.0"}}).dump() + ",\n\"licenses\":[],\n\"categories\":" + categories.dump();
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
  if (!image.distortion.is_none()) entry["distortion"] = coefficients(image.distortion);
  entry["X_WC"] = {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()};
  images_.add(entry.dump());
  for (const ImageLabel& label : image.labels.labels) {
    Json annotation;
    annotation["id"] = annotations_.count() + 1;
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
    annotation["crosses_camera_plane"] = label.crosses_camera_plane;
    annotation["leaves_margin"] = label.leaves_margin;
    annotation["object"] = label.object_id;
    annotations_.add(annotation.dump());
  }
  for (const LeftOut& object : image.labels.left_out) {
    Json left_out;
    left_out["image_id"] = image.index + 1;
    left_out["category_id"] = object.class_index + 1;
    left_out["bbox"] = box_json(object.box);
    left_out["why"] = to_text(object.why);
    left_out_.add(left_out.dump());
  }
}

void CocoFile::finish() {
  write_file_by(file_, [&](const fs::path& temporary) {
    std::ofstream out(temporary, std::ios::binary);
    out << head_;
    for (List* const list : {&images_, &annotations_, &left_out_}) list->put_into(out);
    out << "}\n";
    out.close();
    if (!out) throw Error(file_, "could not be written; is the disk full?");
  });
}

}  // namespace waretwin

#include "harness/dataset/image_record.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files.h"

namespace waretwin {

namespace {

using Json = nlohmann::ordered_json;

Json box_json(const cv::Rect& box) { return {box.x, box.y, box.width, box.height}; }
cv::Rect box_from(const Json& json) { return {json.at(0), json.at(1), json.at(2), json.at(3)}; }

Json image_json(const ImageRecord& image) {
  const Intrinsics& k = image.intrinsics;
  const Eigen::Quaterniond q(image.X_WC.rotation());
  const Eigen::Vector3d& p = image.X_WC.translation();
  Json json;
  json["index"] = image.index;
  json["name"] = image.name;
  json["kind"] = image.kind;
  json["size"] = {k.width, k.height};
  json["intrinsics"] = {k.fx, k.fy, k.cx, k.cy};
  if (!image.distortion.is_none()) json["distortion"] = coefficients(image.distortion);
  json["X_WC"] = {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()};
  json["left_out"] = Json::array();
  for (const LeftOut& object : image.labels.left_out) {
    json["left_out"].push_back(
        {{"id", object.object_id}, {"class", object.class_index}, {"box", box_json(object.box)}, {"why", to_text(object.why)}});
  }
  json["labels"] = Json::array();
  for (const ImageLabel& label : image.labels.labels) {
    json["labels"].push_back({{"id", label.object_id},
                              {"class", label.class_index},
                              {"box", box_json(label.box)},
                              {"area_px", label.area_px},
                              {"visible", label.visible},
                              {"occluded", label.occluded},
                              {"truncated", label.truncated},
                              {"crosses_camera_plane", label.crosses_camera_plane},
                              {"leaves_margin", label.leaves_margin},
                              {"amodal_box", box_json(label.amodal_box)},
                              {"polygons", label.polygons},
                              {"runs", label.runs}});
  }
  json["files"] = image.files;
  return json;
}

ImageRecord image_from(const Json& json) {
  ImageRecord image;
  image.index = json.at("index");
  image.name = json.at("name");
  image.kind = json.at("kind");
  const Json &size = json.at("size"), &k = json.at("intrinsics"), &x = json.at("X_WC");
  image.intrinsics = {size.at(0), size.at(1), k.at(0), k.at(1), k.at(2), k.at(3)};
  if (json.contains("distortion")) {
    const auto d = json.at("distortion").get<std::array<double, 8>>();
    image.distortion = {.k1 = d[0], .k2 = d[1], .k3 = d[4], .k4 = d[5], .k5 = d[6], .k6 = d[7], .p1 = d[2], .p2 = d[3]};
  }
  image.X_WC.translation() = Eigen::Vector3d(x.at(0), x.at(1), x.at(2));
  image.X_WC.linear() = Eigen::Quaterniond(x.at(6), x.at(3), x.at(4), x.at(5)).normalized().toRotationMatrix();
  for (const Json& entry : json.at("left_out")) {
    const LeftOut::Why why = entry.at("why") == to_text(LeftOut::Why::kSmall) ? LeftOut::Why::kSmall : LeftOut::Why::kHidden;
    image.labels.left_out.push_back({entry.at("id"), entry.at("class"), box_from(entry.at("box")), why});
  }
  for (const Json& entry : json.at("labels")) {
    ImageLabel label;
    label.object_id = entry.at("id");
    label.class_index = entry.at("class");
    label.box = box_from(entry.at("box"));
    label.area_px = entry.at("area_px");
    label.visible = entry.at("visible");
    label.occluded = entry.at("occluded");
    label.truncated = entry.at("truncated");
    label.crosses_camera_plane = entry.at("crosses_camera_plane");
    label.leaves_margin = entry.at("leaves_margin");
    label.amodal_box = box_from(entry.at("amodal_box"));
    label.polygons = entry.at("polygons").get<std::vector<std::vector<double>>>();
    label.runs = entry.at("runs");
    image.labels.labels.push_back(std::move(label));
  }
  image.files = json.at("files").get<std::map<std::string, std::string>>();
  return image;
}

}  // namespace

const char* to_text(LeftOut::Why why) { return why == LeftOut::Why::kSmall ? "small" : "hidden"; }

std::array<double, 8> coefficients(const Distortion& d) { return {d.k1, d.k2, d.p1, d.p2, d.k3, d.k4, d.k5, d.k6}; }

std::filesystem::path record_name(int number) {
  char name[32];
  std::snprintf(name, sizeof name, "%06d.json", number);
  return std::filesystem::path("halls") / name;
}

std::string to_json(const HallRecord& record) {
  Json json;
  json["set"] = record.set;
  json["hall"] = record.hall;
  json["number"] = record.number;
  json["split"] = record.split;
  json["images"] = Json::array();
  for (const ImageRecord& image : record.images) json["images"].push_back(image_json(image));
  return json.dump() + "\n";
}

HallRecord read_hall_record(const std::filesystem::path& file) {
  try {
    const Json json = Json::parse(read_file(file));
    HallRecord record;
    record.set = json.at("set");
    record.hall = json.at("hall");
    record.number = json.at("number");
    record.split = json.at("split");
    for (const Json& image : json.at("images")) record.images.push_back(image_from(image));
    if (record.split != "train" && record.split != "valid" && record.split != "test") {
      throw Error(file, "split '" + record.split + "'; expected train, valid or test");
    }
    return record;
  } catch (const nlohmann::json::exception& problem) {
    throw Error(file, "is no record of a hall's pictures (" + std::string(problem.what()) + "); delete it and make the set again");
  }
}

}  // namespace waretwin

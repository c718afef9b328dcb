#include "harness/report/frame_log.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>
#include <sstream>

#include "core/error.h"
#include "core/files.h"
#include "harness/pictures/picture_file.h"
#include "harness/report/page_json.h"

namespace waretwin {

namespace fs = std::filesystem;

namespace {

constexpr int kWidth = 480, kHeight = 270;  // pixels, at most
constexpr int kColourQuality = 82, kDepthQuality = 80;
constexpr const char* kList = "frames.jsonl";
constexpr const char* kPictures = "frames/small";

cv::Size small_size(const cv::Mat& image) {
  const double scale = std::min({1.0, static_cast<double>(kWidth) / image.cols, static_cast<double>(kHeight) / image.rows});
  return {std::max(1, static_cast<int>(std::lround(scale * image.cols))), std::max(1, static_cast<int>(std::lround(scale * image.rows)))};
}

bool is_black(const cv::Mat& image) {
  double most = 0.0;
  cv::minMaxLoc(image.reshape(1), nullptr, &most);
  return most == 0.0;
}

// Near is red, far is blue, nothing is black; without text, for the page has a legend.
cv::Mat small_depth(const cv::Mat& depth, double near_m, double far_m) {
  cv::Mat few, nearness;
  cv::resize(depth, few, small_size(depth), 0, 0, cv::INTER_NEAREST);
  const double range = std::max(1e-3, far_m - near_m);
  few.convertTo(nearness, CV_8UC1, -255.0 / range, 255.0 * (1.0 + near_m / range));
  cv::Mat image;
  cv::applyColorMap(nearness, image, cv::COLORMAP_TURBO);
  image.setTo(cv::Scalar::all(0), few <= 0.0f);
  return image;
}

std::string picture_name(int number, const char* kind) {
  char name[64];
  std::snprintf(name, sizeof name, "frame-%04d.%s.jpg", number, kind);
  return name;
}

std::string line_of(const LoggedFrame& frame) {
  const Intrinsics& k = frame.intrinsics;
  Json json = {{"frame", frame.number},
               {"stamp_ns", frame.stamp},
               {"sensor", frame.sensor},
               {"size", {k.width, k.height}},
               {"intrinsics", {k.fx, k.fy, k.cx, k.cy}},
               {"range_m", frame.range_m},
               {"X_WC", pose_json(frame.X_WC)},
               {"X_WB", pose_json(frame.X_WB)},
               {"colour", frame.colour.empty() ? Json(nullptr) : Json(picture_name(frame.number, "colour"))},
               {"depth", frame.depth.empty() ? Json(nullptr) : Json(picture_name(frame.number, "depth"))},
               {"detections", Json::array()},
               {"objects", objects_json(frame.objects)}};
  for (const LoggedDetection& d : frame.detections) {
    json["detections"].push_back({{"class", d.class_name},
                                  {"score", rounded(d.score, 4)},
                                  {"box", {rounded(d.box.x, 2), rounded(d.box.y, 2), rounded(d.box.width, 2), rounded(d.box.height, 2)}},
                                  {"map_id", d.map_id}});
  }
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

// The picture's bytes; names of files elsewhere are none of ours.
std::string picture(const fs::path& folder, const Json& name) {
  if (!name.is_string()) return {};
  const fs::path file = name.get<std::string>();
  if (file.empty() || file != file.filename()) throw Error("picture '" + file.string() + "'; expected a plain file name");
  const fs::path whole = folder / kPictures / file;
  std::error_code error;
  return fs::is_regular_file(whole, error) ? read_file(whole) : std::string();
}

LoggedFrame frame_of(const Json& json, const fs::path& folder) {
  LoggedFrame frame;
  frame.number = json.at("frame");
  frame.stamp = json.at("stamp_ns");
  frame.sensor = json.at("sensor");
  const Json &size = json.at("size"), &k = json.at("intrinsics");
  frame.intrinsics = Intrinsics::checked(size.at(0), size.at(1), k.at(0), k.at(1), k.at(2), k.at(3));
  frame.range_m = json.at("range_m");
  frame.X_WC = pose_from(json.at("X_WC"));
  frame.X_WB = pose_from(json.at("X_WB"));
  for (const Json& entry : json.at("detections")) {
    const Json& box = entry.at("box");
    frame.detections.push_back({entry.at("class"), entry.at("score"), {box.at(0), box.at(1), box.at(2), box.at(3)}, entry.at("map_id")});
  }
  frame.objects = objects_from(json.at("objects"));
  frame.colour = picture(folder, json.at("colour"));
  frame.depth = picture(folder, json.at("depth"));
  return frame;
}

}  // namespace

LoggedFrame logged_frame(int number, const Mapper::FrameResult& result, const ObjectList& objects, const StreamInfo::Camera& camera) {
  LoggedFrame frame;
  frame.number = number;
  frame.stamp = result.frame.stamp;
  frame.sensor = result.frame.sensor;
  frame.intrinsics = camera.intrinsics;
  frame.range_m = camera.depth_max_m;
  frame.X_WC = result.X_WC;
  frame.X_WB = result.X_WC * camera.X_BC.inverse();
  for (const Detection& d : result.detections) {
    LoggedDetection logged{d.class_name, static_cast<double>(d.score), d.box, 0};
    for (std::size_t i = 0; i < result.segmentation.objects.size() && i < result.map_ids.size(); ++i) {
      const Detection& of = result.segmentation.objects[i].detection;
      if (of.box == d.box && of.class_name == d.class_name) logged.map_id = result.map_ids[i];
    }
    frame.detections.push_back(std::move(logged));
  }
  for (const MappedObject& object : objects) {
    frame.objects.push_back({object.id, object.class_name, canonical(object.cuboid), static_cast<double>(object.score)});
  }
  std::sort(frame.objects.begin(), frame.objects.end(), [](const ListedObject& a, const ListedObject& b) { return a.id < b.id; });
  if (!result.frame.colour.empty()) {
    cv::Mat few;
    cv::resize(result.frame.colour, few, small_size(result.frame.colour), 0, 0, cv::INTER_AREA);
    if (!is_black(few)) frame.colour = encoded_jpeg(few, kColourQuality);
  }
  if (!result.frame.depth.empty()) {
    frame.depth = encoded_jpeg(small_depth(result.frame.depth, camera.depth_min_m, std::min(camera.depth_max_m, 10.0)), kDepthQuality);
  }
  return frame;
}

std::optional<int> FrameLog::turn_of(const std::string& sensor) {
  const int turn = turns_[sensor]++;
  return turn % step_ == 0 ? std::optional(turn) : std::nullopt;
}

void FrameLog::add(LoggedFrame frame) {
  frames_.push_back(std::move(frame));
  while (frames_.size() > most_) {
    step_ *= 2;
    std::erase_if(frames_, [this](const LoggedFrame& f) { return f.turn % step_ != 0; });
  }
}

void write_frame_log(const fs::path& folder, const std::vector<LoggedFrame>& frames) {
  std::error_code error;
  fs::remove_all(folder / kPictures, error);
  make_folder(folder / kPictures);
  std::string lines;
  for (const LoggedFrame& frame : frames) {
    if (!frame.colour.empty()) write_file(folder / kPictures / picture_name(frame.number, "colour"), frame.colour);
    if (!frame.depth.empty()) write_file(folder / kPictures / picture_name(frame.number, "depth"), frame.depth);
    lines += line_of(frame);
  }
  write_file(folder / kList, lines);
}

std::vector<LoggedFrame> read_frame_log(const fs::path& folder) {
  std::vector<LoggedFrame> frames;
  const fs::path file = folder / kList;
  std::error_code error;
  if (!fs::exists(file, error)) return frames;
  std::istringstream lines(read_file(file));
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (line.empty()) continue;
    try {
      frames.push_back(frame_of(Json::parse(line), folder));
    } catch (const nlohmann::json::exception& problem) {
      throw Error(file, number, "is no record of a frame (" + std::string(problem.what()) + ")");
    } catch (const Error& problem) {
      throw Error(file, number, problem.what());
    }
  }
  return frames;
}

}  // namespace waretwin

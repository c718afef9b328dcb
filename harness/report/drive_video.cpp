#include "harness/report/drive_video.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#ifdef WARETWIN_VIDEO
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/videoio.hpp>
#endif

#include "core/error.h"
#include "core/files.h"
#include "harness/pictures/rasteriser.h"
#include "harness/report/frame_log.h"
#include "harness/report/page_mesh.h"
#include "harness/score/upright.h"

namespace waretwin {

namespace fs = std::filesystem;

#ifdef WARETWIN_VIDEO

namespace {

constexpr int kWidth = 1280, kHeight = 540, kHalf = 640, kPictureHeight = 360;  // pixels
constexpr double kRate = 8.0;                                                   // frames a second
constexpr int kHold = 16;                                                       // the last picture stays for two seconds
constexpr std::size_t kMaxTriangles = 300'000;
constexpr double kCut = 2.5;  // metres above the floor: what hangs higher would hide the hall
const cv::Scalar kInk(230, 230, 230), kFaint(150, 150, 150), kPath(60, 160, 255), kRobot(80, 220, 255);
const cv::Vec3b kGround(38, 34, 30);

// Text without a rim, on the video's own ground.
void write(cv::Mat& image, const cv::Point& at, const std::string& text, const cv::Scalar& colour, double scale = 0.5) {
  cv::putText(image, text, at, cv::FONT_HERSHEY_SIMPLEX, scale, colour, 1, cv::LINE_AA);
}

// The map from above. The surface that a frame saw first is added when that frame's turn comes.
class GrowingMap {
 public:
  GrowingMap(const fs::path& folder, const std::vector<LoggedFrame>& frames) {
    std::error_code error;
    if (fs::exists(folder / "map.ply", error) && fs::exists(folder / "cloud.ply", error)) {
      mesh_ = thinned(read_page_mesh(folder), kMaxTriangles);
      const Eigen::Isometry3f X = upright_from_recording(folder).cast<float>();
      for (Eigen::Vector3f& p : mesh_.vertices) p = X * p;
    }
    std::vector<SeeingCamera> cameras;
    for (const LoggedFrame& frame : frames) {
      const Intrinsics& k = frame.intrinsics;
      cameras.push_back({frame.X_WC, k.fx, k.fy, k.cx, k.cy, k.width, k.height, std::min(frame.range_m, 8.0)});
    }
    seen_ = first_seen(mesh_, cameras);
    picture_ = std::make_unique<Picture>(view_of(frames), kGround);
  }

  // Frames in their order.
  cv::Mat with(const std::vector<LoggedFrame>& frames, std::size_t now) {
    PictureMesh part;
    part.vertices = mesh_.vertices;
    part.colours = mesh_.colours;
    for (const auto& t : mesh_.triangles) {
      if (std::max({seen_[t[0]], seen_[t[1]], seen_[t[2]]}) == now) part.triangles.push_back(t);
    }
    picture_->draw(part, ceiling_);
    cv::Mat image = picture_->image().clone();
    const auto pixel = [&](const Eigen::Vector3d& p_W) {
      const auto at = picture_->view().project(p_W);
      return at ? cv::Point(static_cast<int>(std::lround(at->x())), static_cast<int>(std::lround(at->y()))) : cv::Point();
    };
    for (std::size_t i = 1; i <= now; ++i) {
      cv::line(image, pixel(frames[i - 1].X_WB.translation()), pixel(frames[i].X_WB.translation()), kPath, 2, cv::LINE_AA);
    }
    for (const ListedObject& object : frames[now].objects) {
      const std::vector<Eigen::Vector3d> corners = object.cuboid.corners();
      for (const auto& [a, b] : {std::pair<std::size_t, std::size_t>{4, 5}, {5, 7}, {7, 6}, {6, 4}}) {
        cv::line(image, pixel(corners[a]), pixel(corners[b]), colour_of_id(object.id), 2, cv::LINE_AA);
      }
      draw_text(image, pixel(object.cuboid.centre) + cv::Point(-5, 5), std::to_string(object.id), cv::Scalar::all(255), 0.5);
    }
    draw_robot(image, frames[now], pixel);
    return image;
  }

 private:
  // The whole drive and map fit into the right half, whichever way round they are.
  PictureView view_of(const std::vector<LoggedFrame>& frames) {
    std::array<std::vector<double>, 3> values;
    for (const Eigen::Vector3f& p : mesh_.vertices) {
      for (int k = 0; k < 3; ++k) values[static_cast<std::size_t>(k)].push_back(static_cast<double>(p[k]));
    }
    Eigen::AlignedBox3d box;
    if (!mesh_.vertices.empty()) {
      Eigen::Vector3d low, high;
      for (std::size_t k = 0; k < 3; ++k) {
        std::sort(values[k].begin(), values[k].end());
        // Single far-away points would make everything else tiny.
        const std::size_t few = values[k].size() / 200;
        low[static_cast<int>(k)] = values[k][few];
        high[static_cast<int>(k)] = values[k][values[k].size() - 1 - few];
      }
      ceiling_ = low.z() + kCut;
      box.extend(low);
      box.extend(high);
    }
    for (const LoggedFrame& frame : frames) {
      box.extend(frame.X_WB.translation());
      for (const ListedObject& object : frame.objects) {
        for (const Eigen::Vector3d& corner : object.cuboid.corners()) box.extend(corner);
      }
    }
    constexpr int kMargin = 24;
    const Eigen::Vector2d extent = box.diagonal().head<2>().cwiseMax(1.0);
    const double scale = std::min((kHalf - 2.0 * kMargin) / extent.x(), (kHeight - 2.0 * kMargin) / extent.y());
    // The half is filled to its borders: what is beyond the map is ground.
    const Eigen::Vector2d half((kHalf - 2.0 * kMargin) / scale * 0.5, (kHeight - 2.0 * kMargin) / scale * 0.5);
    const Eigen::Vector2d middle = box.center().head<2>();
    return PictureView::from_above(middle - half, middle + half, scale, kMargin);
  }

  template <class Pixel>
  void draw_robot(cv::Mat& image, const LoggedFrame& frame, const Pixel& pixel) const {
    // What the camera has in view: its field at 1.5 m, flat.
    const Eigen::Vector3d eye = frame.X_WC.translation();
    std::vector<cv::Point> field = {pixel(eye)};
    for (const double u : {0.0, static_cast<double>(frame.intrinsics.width)}) {
      Eigen::Vector3d direction = frame.X_WC.linear() * frame.intrinsics.ray(u, frame.intrinsics.cy);
      direction.z() = 0.0;
      field.push_back(pixel(eye + 1.5 * direction.normalized()));
    }
    cv::Mat over = image.clone();
    cv::fillConvexPoly(over, field, kRobot, cv::LINE_AA);
    cv::addWeighted(over, 0.35, image, 0.65, 0.0, image);
    cv::circle(image, pixel(frame.X_WB.translation()), 6, kRobot, cv::FILLED, cv::LINE_AA);
    cv::circle(image, pixel(frame.X_WB.translation()), 6, cv::Scalar(30, 30, 30), 1, cv::LINE_AA);
  }

  PageMesh mesh_;
  std::vector<std::uint8_t> seen_;
  std::unique_ptr<Picture> picture_;
  double ceiling_ = kCut;
};

cv::Mat picture_of(const LoggedFrame& frame) {
  cv::Mat half(kPictureHeight, kHalf, CV_8UC3, cv::Scalar(kGround[0], kGround[1], kGround[2]));
  const std::string& bytes = frame.colour.empty() ? frame.depth : frame.colour;
  if (bytes.empty()) return half;
  const cv::Mat small = cv::imdecode(std::vector<unsigned char>(bytes.begin(), bytes.end()), cv::IMREAD_COLOR);
  if (small.empty()) throw Error("frame " + std::to_string(frame.number) + ": its picture in frames/small is no picture");
  const double scale = std::min(static_cast<double>(kHalf) / small.cols, static_cast<double>(kPictureHeight) / small.rows);
  const cv::Size size(static_cast<int>(scale * small.cols), static_cast<int>(scale * small.rows));
  cv::Mat place = half(cv::Rect((kHalf - size.width) / 2, (kPictureHeight - size.height) / 2, size.width, size.height));
  cv::resize(small, place, size, 0, 0, cv::INTER_CUBIC);
  const double sx = static_cast<double>(size.width) / frame.intrinsics.width,
               sy = static_cast<double>(size.height) / frame.intrinsics.height;
  for (const LoggedDetection& d : frame.detections) {
    const cv::Scalar colour = d.map_id > 0 ? colour_of_id(d.map_id) : kInk;
    const cv::Rect box(static_cast<int>(d.box.x * sx), static_cast<int>(d.box.y * sy), static_cast<int>(d.box.width * sx),
                       static_cast<int>(d.box.height * sy));
    cv::rectangle(place, box, colour, 2, cv::LINE_AA);
    char text[96];
    std::snprintf(text, sizeof text, "%.40s %.2f%s", d.class_name.c_str(), d.score,
                  d.map_id > 0 ? (" #" + std::to_string(d.map_id)).c_str() : "");
    draw_text(place, {box.x + 4, std::max(14, box.y + 16)}, text, cv::Scalar::all(255), 0.45);
  }
  return half;
}

cv::Mat words_of(const LoggedFrame& frame, Stamp start) {
  cv::Mat strip(kHeight - kPictureHeight, kHalf, CV_8UC3, cv::Scalar(kGround[0], kGround[1], kGround[2]));
  char text[160];
  std::snprintf(text, sizeof text, "%.1f s    frame %d    %zu object%s in the map", to_seconds(frame.stamp - start), frame.number,
                frame.objects.size(), frame.objects.size() == 1 ? "" : "s");
  write(strip, {20, 34}, text, kInk, 0.6);
  // Two columns; what does not fit is counted.
  constexpr std::size_t kRows = 5, kMost = 2 * kRows;
  for (std::size_t i = 0; i < std::min(kMost, frame.objects.size()); ++i) {
    const ListedObject& object = frame.objects[i];
    const cv::Point at(20 + 310 * static_cast<int>(i / kRows), 62 + 22 * static_cast<int>(i % kRows));
    cv::rectangle(strip, {at.x, at.y - 10}, {at.x + 12, at.y + 1}, colour_of_id(object.id), cv::FILLED);
    std::snprintf(text, sizeof text, "%d %.20s  %.2f x %.2f x %.2f m", object.id, object.class_name.c_str(), object.cuboid.size.x(),
                  object.cuboid.size.y(), object.cuboid.size.z());
    write(strip, at + cv::Point(20, 0), text, kFaint, 0.42);
  }
  if (frame.objects.size() > kMost) {
    std::snprintf(text, sizeof text, "and %zu more", frame.objects.size() - kMost);
    write(strip, {540, 34}, text, kFaint, 0.42);
  }
  return strip;
}

// What the page says "H.264" for plays in every browser; MPEG-4 part 2 in most players.
std::string open_writer(cv::VideoWriter& writer, const fs::path& file) {
  // OpenCV tells of every encoder that it lacks; what matters is whether one is left.
  struct Silence {
    cv::utils::logging::LogLevel before = cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
    ~Silence() { cv::utils::logging::setLogLevel(before); }
  } silence;
  const cv::Size size(kWidth, kHeight);
  if (writer.open(file.string(), cv::CAP_FFMPEG, cv::VideoWriter::fourcc('a', 'v', 'c', '1'), kRate, size)) return "H.264";
  if (writer.open(file.string(), cv::VideoWriter::fourcc('m', 'p', '4', 'v'), kRate, size)) return "MPEG-4";
  throw Error("--video: OpenCV has no encoder for H.264 or MPEG-4, or its file cannot be written");
}

}  // namespace

bool video_available() { return true; }

VideoSummary write_drive_video(const fs::path& folder, const fs::path& file, const std::function<void(double)>& progress) {
  if (file.extension() != ".mp4") throw Error("--video " + file.string() + ": expected a name that ends in .mp4");
  std::error_code error;
  if (file.has_parent_path() && !fs::is_directory(file.parent_path(), error))
    throw Error(file, "cannot be written: its folder does not exist");
  const std::vector<LoggedFrame> frames = read_frame_log(folder);
  if (frames.empty())
    throw Error(folder / "frames.jsonl", "is missing or empty: this drive kept no frames; expected a run or map of this version");
  if (frames.size() > 255) throw Error(folder / "frames.jsonl", std::to_string(frames.size()) + " frames; expected at most 255");
  GrowingMap map(folder, frames);
  VideoSummary summary;
  summary.width = kWidth;
  summary.height = kHeight;
  write_file_by(file, [&](const fs::path& temporary) {
    cv::VideoWriter writer;
    summary.codec = open_writer(writer, temporary);
    cv::Mat left, whole;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      cv::vconcat(picture_of(frames[i]), words_of(frames[i], frames.front().stamp), left);
      cv::Mat right(kHeight, kHalf, CV_8UC3, cv::Scalar(kGround[0], kGround[1], kGround[2]));
      const cv::Mat above = map.with(frames, i);
      const cv::Rect common(0, 0, std::min(kHalf, above.cols), std::min(kHeight, above.rows));
      above(common).copyTo(right(common));
      cv::hconcat(left, right, whole);
      const int times = i + 1 == frames.size() ? kHold : 1;
      for (int k = 0; k < times; ++k) {
        writer.write(whole);
        ++summary.frames;
      }
      if (progress) progress(static_cast<double>(i + 1) / static_cast<double>(frames.size()));
    }
    writer.release();
    // The writer does not say when the disk is full.
    cv::VideoCapture again(temporary.string());
    if (static_cast<int>(again.get(cv::CAP_PROP_FRAME_COUNT)) != summary.frames)
      throw Error(file, "cannot be written whole: " + std::to_string(summary.frames) + " frames were drawn, fewer can be read back");
  });
  return summary;
}

#else

bool video_available() { return false; }

VideoSummary write_drive_video(const fs::path&, const fs::path&, const std::function<void(double)>&) {
  throw Error("--video: this waretwin was built without OpenCV's videoio; install libopencv-dev with it and build again");
}

#endif

}  // namespace waretwin

#include "sensors/recordings/folder_writer.h"

#include <cmath>
#include <cstdio>
#include <optional>

#include "core/error.h"
#include "core/files.h"
#include "core/parallel.h"
#include "sensors/recordings/recorded_image.h"
#include "sensors/recordings/text_formats.h"

namespace waretwin {

namespace fs = std::filesystem;

namespace {

std::string numbered(const char* format, int number) {
  char text[48];
  std::snprintf(text, sizeof text, format, number);
  return text;
}

// The numbers of a row that come back to the same bits.
std::string row_text(const Eigen::RowVector4d& row) {
  char text[128];
  std::snprintf(text, sizeof text, "%.17g %.17g %.17g %.17g\n", row[0], row[1], row[2], row[3]);
  return text;
}

std::string matrix_text(const Pose& pose) {
  std::string text;
  for (int i = 0; i < 4; ++i) text += row_text(pose.matrix().row(i));
  return text;
}

// What a layout calls its pictures and writes beside them.
class Layout {
 public:
  struct Names {
    std::string colour, depth;
  };
  virtual ~Layout() = default;
  // Of the frame with this index, from 0.
  virtual Names names(int index) const = 0;
  virtual void add(const RgbdFrame& frame, int index, const Names& names) = 0;
  virtual void finish() = 0;
};

class TumLayout final : public Layout {
 public:
  explicit TumLayout(const fs::path& folder) : folder_(folder), colour_(list(folder, "rgb")), depth_(list(folder, "depth")) {}
  Names names(int index) const override {
    const std::string file = numbered("/%06d.png", index);
    return {"rgb" + file, "depth" + file};
  }
  void add(const RgbdFrame& frame, int, const Names& names) override {
    colour_.append(stamp_text(frame.stamp) + " " + names.colour + "\n");
    depth_.append(stamp_text(frame.stamp) + " " + names.depth + "\n");
    if (!frame.recorded_X_WC) return;
    if (!poses_) {
      poses_.emplace(folder_ / "groundtruth.txt");
      poses_->append("# seconds x y z qx qy qz qw\n");
    }
    const Eigen::Vector3d& p = frame.recorded_X_WC->translation();
    const Eigen::Quaterniond q(frame.recorded_X_WC->linear());
    char text[240];
    std::snprintf(text, sizeof text, " %.17g %.17g %.17g %.17g %.17g %.17g %.17g\n", p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
    poses_->append(stamp_text(frame.stamp) + text);
  }
  void finish() override {
    colour_.close();
    depth_.close();
    if (poses_) poses_->close();
  }

 private:
  static GrowingFile list(const fs::path& folder, const std::string& name) {
    make_folder(folder / name);
    GrowingFile file(folder / (name + ".txt"));
    file.append("# seconds file\n");
    return file;
  }
  fs::path folder_;
  GrowingFile colour_, depth_;
  std::optional<GrowingFile> poses_;
};

// Frames with numbers and, where they are known, poses.
class NumberedLayout : public Layout {
 public:
  explicit NumberedLayout(const fs::path& folder, int first) : folder_(folder), first_(first), stamps_(folder / "stamps.txt") {
    stamps_.append("# number seconds\n");
  }
  void add(const RgbdFrame& frame, int index, const Names&) override {
    stamps_.append(std::to_string(index + first_) + " " + stamp_text(frame.stamp) + "\n");
  }
  void finish() override { stamps_.close(); }

 protected:
  fs::path folder_;
  int first_;

 private:
  GrowingFile stamps_;
};

class SevenScenesLayout final : public NumberedLayout {
 public:
  SevenScenesLayout(const fs::path& folder, const Intrinsics& k) : NumberedLayout(folder, 0) {
    char text[200];
    std::snprintf(text, sizeof text, "%.17g 0 %.17g\n0 %.17g %.17g\n0 0 1\n", k.fx, k.cx, k.fy, k.cy);
    write_file(folder / "camera-intrinsics.txt", text);
  }
  Names names(int index) const override {
    const std::string stem = numbered("frame-%06d", index);
    return {stem + ".color.png", stem + ".depth.png"};
  }
  void add(const RgbdFrame& frame, int index, const Names& names) override {
    NumberedLayout::add(frame, index, names);
    if (frame.recorded_X_WC) write_file(folder_ / (numbered("frame-%06d", index) + ".pose.txt"), matrix_text(*frame.recorded_X_WC));
  }
};

class SceneNnLayout final : public NumberedLayout {
 public:
  explicit SceneNnLayout(const fs::path& folder) : NumberedLayout(folder, 1), times_(folder / "timestamp.txt") {
    make_folder(folder / "image");
    make_folder(folder / "depth");
  }
  Names names(int index) const override { return {numbered("image/image%05d.png", index + 1), numbered("depth/depth%05d.png", index + 1)}; }
  void add(const RgbdFrame& frame, int index, const Names& names) override {
    NumberedLayout::add(frame, index, names);
    constexpr double kNanosecondsPerMicrosecond = 1000.0;
    const std::string micro = std::to_string(std::llround(static_cast<double>(frame.stamp) / kNanosecondsPerMicrosecond));
    times_.append(std::to_string(index + 1) + " " + micro + " " + micro + "\n");
    if (!frame.recorded_X_WC) return;
    if (!log_) log_.emplace(folder_ / "trajectory.log");
    const std::string i = std::to_string(index);
    log_->append(i + " " + i + " " + std::to_string(index + 1) + "\n" + matrix_text(*frame.recorded_X_WC));
  }
  void finish() override {
    NumberedLayout::finish();
    times_.close();
    if (log_) log_->close();
  }

 private:
  GrowingFile times_;
  std::optional<GrowingFile> log_;
};

std::unique_ptr<Layout> make_layout(const std::string& format, const fs::path& folder, const StreamInfo& info) {
  if (format != "tum" && format != "7scenes" && format != "scenenn") {
    throw Error("format: '" + format + "' is not known; expected tum, 7scenes, scenenn or rosbag");
  }
  if (info.cameras.empty()) return nullptr;
  if (format == "tum") return std::make_unique<TumLayout>(folder);
  if (format == "scenenn") return std::make_unique<SceneNnLayout>(folder);
  return std::make_unique<SevenScenesLayout>(folder, info.cameras.begin()->second.intrinsics);
}

class FolderWriter final : public RecordingWriter {
 public:
  FolderWriter(std::unique_ptr<Layout> layout, const fs::path& folder, const StreamInfo& info)
      : folder_(folder), layout_(std::move(layout)) {
    if (!info.cameras.empty() && info.cameras.begin()->second.native) {
      make_folder(folder_ / "depth_native");
      native_.emplace(folder_ / "depth_native.txt");
      native_->append("# seconds file\n");
    }
    if (!info.lasers.empty()) {
      laser_.emplace(folder_ / "laser.txt");
      laser_->append("# seconds angle_min angle_increment beam_interval_s range_min range_max count ranges; radians, metres, 0 = none\n");
    }
    if (info.has_odometry) {
      odometry_.emplace(folder_ / "odometry.txt");
      odometry_->append("# seconds x y yaw; metres, radians\n");
    }
  }

  void add(const OdometryReading& reading) override {
    WARETWIN_CHECK(odometry_, "the stream said that it has odometry");
    odometry_->append(odometry_line(reading));
  }

  void add(const LaserScan& scan) override {
    WARETWIN_CHECK(laser_, "the stream said that it has a laser");
    laser_->append(laser_line(scan));
  }

  void add(const RgbdFrame& frame) override {
    WARETWIN_CHECK(layout_, "the stream said that it has a camera");
    WARETWIN_CHECK(!frame.colour.empty() && !frame.depth.empty(), "the frame's pictures are loaded");
    const int index = frames_++;
    const Layout::Names names = layout_->names(index);
    const bool has_native = native_ && !frame.native_depth.empty();
    const std::string native_name = "depth_native" + numbered("/%06d.png", index);
    // Packing the pictures takes longer than writing them.
    parallel_for(3, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (i == 0) write_colour_image(folder_ / names.colour, frame.colour);
        if (i == 1) write_depth_image(folder_ / names.depth, frame.depth);
        if (i == 2 && has_native) write_depth_image(folder_ / native_name, frame.native_depth);
      }
    });
    layout_->add(frame, index, names);
    if (has_native) native_->append(stamp_text(frame.stamp) + " " + native_name + "\n");
  }

  void finish() override {
    if (layout_) layout_->finish();
    for (auto* file : {&native_, &laser_, &odometry_}) {
      if (*file) (*file)->close();
    }
  }

 private:
  fs::path folder_;
  int frames_ = 0;
  std::unique_ptr<Layout> layout_;  // nothing without a camera
  std::optional<GrowingFile> native_, laser_, odometry_;
};

}  // namespace

std::unique_ptr<RecordingWriter> make_folder_writer(const std::string& format, const fs::path& folder, const StreamInfo& info) {
  return std::make_unique<FolderWriter>(make_layout(format, folder, info), folder, info);
}

}  // namespace waretwin

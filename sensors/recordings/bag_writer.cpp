// A sensor stream as a ROS 1 bag. Compiled where librosbag-storage was found.
#include <nav_msgs/Odometry.h>
#include <rosbag/bag.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/LaserScan.h>
#include <tf2_msgs/TFMessage.h>

#include <boost/make_shared.hpp>
#include <cmath>
#include <opencv2/core.hpp>

#include "core/error.h"
#include "sensors/recordings/bag_names.h"
#include "sensors/recordings/recorded_image.h"
#include "sensors/recordings/ros_bag.h"

namespace waretwin {

namespace {

ros::Time ros_time(Stamp stamp) {
  constexpr Stamp kMost = Stamp{4294967295} * kNanosecondsPerSecond;
  if (stamp < 0 || stamp > kMost)
    throw Error("a stamp of " + std::to_string(stamp) + " ns has no place in a bag; expected 0 to 4294967295 s");
  return {static_cast<std::uint32_t>(stamp / kNanosecondsPerSecond), static_cast<std::uint32_t>(stamp % kNanosecondsPerSecond)};
}

std_msgs::Header header_of(Stamp stamp, const char* frame) {
  std_msgs::Header header;
  header.stamp = ros_time(stamp);
  header.frame_id = frame;
  return header;
}

// A bag takes no message of the time 0.
ros::Time receipt(Stamp stamp) { return std::max(ros_time(stamp), ros::TIME_MIN); }

geometry_msgs::TransformStamped transform(Stamp stamp, const char* parent, const char* child, const Pose& X_PC) {
  geometry_msgs::TransformStamped t;
  t.header = header_of(stamp, parent);
  t.child_frame_id = child;
  const Eigen::Quaterniond q(X_PC.linear());
  t.transform.translation.x = X_PC.translation().x();
  t.transform.translation.y = X_PC.translation().y();
  t.transform.translation.z = X_PC.translation().z();
  t.transform.rotation.x = q.x(), t.transform.rotation.y = q.y(), t.transform.rotation.z = q.z(), t.transform.rotation.w = q.w();
  return t;
}

sensor_msgs::CameraInfo camera_info(const Intrinsics& k, const Distortion& d) {
  sensor_msgs::CameraInfo info;
  info.width = static_cast<std::uint32_t>(k.width);
  info.height = static_cast<std::uint32_t>(k.height);
  info.distortion_model = d.is_none() ? "plumb_bob" : "rational_polynomial";
  info.D = {d.k1, d.k2, d.p1, d.p2, d.k3};
  if (!d.is_none()) info.D.insert(info.D.end(), {d.k4, d.k5, d.k6});
  info.K = {k.fx, 0, k.cx, 0, k.fy, k.cy, 0, 0, 1};
  info.R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  info.P = {k.fx, 0, k.cx, 0, 0, k.fy, k.cy, 0, 0, 0, 1, 0};
  return info;
}

sensor_msgs::Image raw_image(const cv::Mat& picture, const char* encoding) {
  sensor_msgs::Image image;
  const cv::Mat whole = picture.isContinuous() ? picture : picture.clone();
  image.width = static_cast<std::uint32_t>(whole.cols);
  image.height = static_cast<std::uint32_t>(whole.rows);
  image.encoding = encoding;
  image.is_bigendian = 0;
  image.step = static_cast<std::uint32_t>(whole.step[0]);
  image.data.assign(whole.datastart, whole.dataend);
  return image;
}

class BagWriter final : public RecordingWriter {
 public:
  BagWriter(const std::filesystem::path& file, const StreamInfo& info, const RosBagFormat& format)
      : file_(file), info_(info), compressed_(format.images == "compressed") {
    guarded([&] {
      bag_.open(file_.string(), rosbag::bagmode::Write);
      if (format.compression == "lz4") bag_.setCompression(rosbag::compression::LZ4);
      if (format.compression == "bz2") bag_.setCompression(rosbag::compression::BZ2);
    });
  }

  void add(const OdometryReading& reading) override {
    const double yaw = std::round(yaw_of(reading.X_OB) * 1e9) / 1e9, half = 0.5 * yaw;
    nav_msgs::Odometry odometry;
    odometry.header = header_of(reading.stamp, bag_names::kOdometryFrame);
    odometry.child_frame_id = bag_names::kBaseFrame;
    odometry.pose.pose.position.x = reading.X_OB.translation().x();
    odometry.pose.pose.position.y = reading.X_OB.translation().y();
    odometry.pose.pose.orientation.z = std::sin(half);
    odometry.pose.pose.orientation.w = std::cos(half);
    write(bag_names::kOdometry, reading.stamp, odometry);
    tf2_msgs::TFMessage tf;
    tf.transforms.push_back(transform(reading.stamp, bag_names::kOdometryFrame, bag_names::kBaseFrame, reading.X_OB));
    write(bag_names::kTf, reading.stamp, tf);
  }

  void add(const LaserScan& scan) override {
    const double turns_hz = info_.lasers.at(scan.sensor).rate_hz;
    sensor_msgs::LaserScan message;
    message.header = header_of(scan.stamp, bag_names::kLaserFrame);
    message.angle_min = static_cast<float>(scan.angle_min);
    message.angle_increment = static_cast<float>(scan.angle_increment);
    const double beams = scan.ranges.empty() ? 0.0 : static_cast<double>(scan.ranges.size() - 1);
    message.angle_max = static_cast<float>(scan.angle_min + beams * scan.angle_increment);
    message.time_increment = static_cast<float>(to_seconds(scan.beam_interval));
    message.scan_time = turns_hz > 0.0 ? static_cast<float>(1.0 / turns_hz) : 0.0f;
    message.range_min = static_cast<float>(scan.range_min);
    message.range_max = static_cast<float>(scan.range_max);
    message.ranges = scan.ranges;
    write(bag_names::kLaser, scan.stamp, message);
  }

  void add(const RgbdFrame& frame) override {
    WARETWIN_CHECK(!frame.colour.empty() && !frame.depth.empty(), "the frame's pictures are loaded");
    const StreamInfo::Camera& camera = info_.cameras.at(frame.sensor);
    write_picture(bag_names::kColour, bag_names::kColourInfo, bag_names::kColourFrame, frame.stamp, frame.colour, "bgr8",
                  camera_info(camera.intrinsics, {}));
    write_picture(bag_names::kDepth, bag_names::kDepthInfo, bag_names::kColourFrame, frame.stamp, depth_to_millimetres(frame.depth),
                  "16UC1", camera_info(camera.intrinsics, {}));
    if (!camera.native || frame.native_depth.empty()) return;
    const Lens& lens = camera.native->lens;
    write_picture(bag_names::kNativeDepth, bag_names::kNativeInfo, bag_names::kDepthFrame, frame.stamp,
                  depth_to_millimetres(frame.native_depth), "16UC1", camera_info(lens.intrinsics(), lens.distortion()));
  }

  void finish() override {
    guarded([&] { bag_.close(); });
  }

 private:
  // What the library throws is a full disk or a folder that cannot be written.
  template <class F>
  void guarded(const F& work) {
    try {
      work();
    } catch (const rosbag::BagException& e) {
      throw Error(file_, "cannot write: " + std::string(e.what()));
    }
  }

  template <class Message>
  void write(const std::string& topic, Stamp stamp, const Message& message) {
    guarded([&] {
      if (!mounts_written_) {
        mounts_written_ = true;
        write_mounts(stamp);
      }
      bag_.write(topic, receipt(stamp), message);
    });
  }

  // Latched, as a static broadcaster's are: a player sends it to whoever asks late.
  void write_mounts(Stamp stamp) {
    tf2_msgs::TFMessage tf;
    for (const auto& [name, camera] : info_.cameras) {
      tf.transforms.push_back(transform(stamp, bag_names::kBaseFrame, bag_names::kColourFrame, camera.X_BC));
      if (camera.native) {
        tf.transforms.push_back(transform(stamp, bag_names::kBaseFrame, bag_names::kDepthFrame, camera.X_BC * camera.native->X_CD));
      }
    }
    for (const auto& [name, laser] : info_.lasers) {
      tf.transforms.push_back(transform(stamp, bag_names::kBaseFrame, bag_names::kLaserFrame, laser.X_BL));
    }
    const auto header = boost::make_shared<ros::M_string>();
    (*header)["topic"] = bag_names::kTfStatic;
    (*header)["type"] = ros::message_traits::datatype(tf);
    (*header)["md5sum"] = ros::message_traits::md5sum(tf);
    (*header)["message_definition"] = ros::message_traits::definition(tf);
    (*header)["callerid"] = "/waretwin";
    (*header)["latching"] = "1";
    bag_.write(bag_names::kTfStatic, receipt(stamp), tf, header);
  }

  void write_picture(const std::string& topic, const std::string& info_topic, const char* frame, Stamp stamp, const cv::Mat& picture,
                     const char* encoding, sensor_msgs::CameraInfo info) {
    const std_msgs::Header header = header_of(stamp, frame);
    if (compressed_) {
      sensor_msgs::CompressedImage message;
      message.header = header;
      const std::string png = encoded_png(picture);
      const bool depth = picture.type() == CV_16UC1;
      // Depth as compressed_depth_image_transport writes it: 12 bytes (kind and two parameters of floats, unused here) before the PNG.
      message.format = std::string(encoding) + (depth ? "; compressedDepth png" : "; png compressed bgr8");
      if (depth) message.data.assign(12, 0);
      message.data.insert(message.data.end(), png.begin(), png.end());
      write(topic + (depth ? "/compressedDepth" : "/compressed"), stamp, message);
    } else {
      sensor_msgs::Image message = raw_image(picture, encoding);
      message.header = header;
      write(topic, stamp, message);
    }
    info.header = header;
    write(info_topic, stamp, info);
  }

  std::filesystem::path file_;
  StreamInfo info_;
  bool compressed_;
  bool mounts_written_ = false;
  rosbag::Bag bag_;
};

}  // namespace

std::unique_ptr<RecordingWriter> make_bag_writer(const std::filesystem::path& folder, const StreamInfo& info, const RosBagFormat& format) {
  return std::make_unique<BagWriter>(folder / "recording.bag", info, format);
}

}  // namespace waretwin

// Bags as other people's robots record them, written with ROS's own library. C++17, as all that includes ROS.
#include <gtest/gtest.h>
#include <nav_msgs/Odometry.h>
#include <rosbag/bag.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/LaserScan.h>
#include <tf2_msgs/TFMessage.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "core/files.h"
#include "sensors/recordings/recording.h"
#include "tests/support/expect_error.h"
#include "tests/support/test_data.h"

namespace waretwin {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kWidth = 8, kHeight = 6;

ros::Time at(double seconds) {
  ros::Time time;
  time.fromSec(1600000000.0 + seconds);
  return time;
}

template <class Message>
Message stamped(double seconds, const std::string& frame) {
  Message message;
  message.header.stamp = at(seconds);
  message.header.frame_id = frame;
  return message;
}

sensor_msgs::Image image(double seconds, const cv::Mat& pixels, const std::string& encoding) {
  auto message = stamped<sensor_msgs::Image>(seconds, "/optical");
  message.width = static_cast<std::uint32_t>(pixels.cols);
  message.height = static_cast<std::uint32_t>(pixels.rows);
  message.encoding = encoding;
  // Rows with a gap, as some drivers have them.
  const std::size_t row = pixels.elemSize() * static_cast<std::size_t>(pixels.cols);
  message.step = static_cast<std::uint32_t>(row + 4);
  message.data.assign(message.step * message.height, 0xAB);
  for (int v = 0; v < pixels.rows; ++v) std::memcpy(message.data.data() + static_cast<std::size_t>(v) * message.step, pixels.ptr(v), row);
  return message;
}

cv::Mat red() { return {kHeight, kWidth, CV_8UC3, cv::Scalar(200, 30, 10)}; }  // as rgb8

cv::Mat metres() {
  cv::Mat depth(kHeight, kWidth, CV_32FC1, cv::Scalar(1.2344));
  depth.at<float>(0, 1) = std::numeric_limits<float>::quiet_NaN();
  depth.at<float>(0, 2) = std::numeric_limits<float>::infinity();
  depth.at<float>(0, 3) = -1.0f;
  return depth;
}

sensor_msgs::CameraInfo camera_info(double seconds) {
  auto info = stamped<sensor_msgs::CameraInfo>(seconds, "optical");
  info.width = kWidth, info.height = kHeight;
  info.K = {50, 0, 3.5, 0, 51, 2.5, 0, 0, 1};
  info.distortion_model = "plumb_bob";
  return info;
}

geometry_msgs::TransformStamped transform(double seconds, const std::string& parent, const std::string& child, double x, double y, double z,
                                          double yaw) {
  auto t = stamped<geometry_msgs::TransformStamped>(seconds, parent);
  t.child_frame_id = child;
  t.transform.translation.x = x, t.transform.translation.y = y, t.transform.translation.z = z;
  t.transform.rotation.z = std::sin(yaw / 2), t.transform.rotation.w = std::cos(yaw / 2);
  return t;
}

nav_msgs::Odometry odometry(double seconds, double x, double yaw) {
  auto reading = stamped<nav_msgs::Odometry>(seconds, "odom");
  reading.pose.pose.position.x = x;
  reading.pose.pose.orientation.z = std::sin(yaw / 2), reading.pose.pose.orientation.w = std::cos(yaw / 2);
  return reading;
}

sensor_msgs::LaserScan scan(double seconds) {
  auto message = stamped<sensor_msgs::LaserScan>(seconds, "laser");
  message.angle_min = -1.0f, message.angle_increment = 0.5f, message.time_increment = 1e-4f;
  message.range_min = 0.1f, message.range_max = 10.0f;
  message.ranges = {1.5f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 0.05f, 10.0f};
  return message;
}

// A bag in a folder of its own.
class RosBag : public ::testing::Test {
 protected:
  RosBag() { bag_.open(file(), rosbag::bagmode::Write); }

  std::string file() const { return (folder_.path() / "drive.bag").string(); }
  template <class Message>
  void write(const std::string& topic, double seconds, const Message& message) {
    bag_.write(topic, at(seconds), message);
  }
  void mounts() {
    tf2_msgs::TFMessage tf;
    tf.transforms = {transform(0, "base_link", "mast", 0.1, 0, 1.0, kPi / 2), transform(0, "mast", "optical", 0.2, 0, 0.4, 0),
                     transform(0, "/base_link", "/laser", 0.3, 0.2, 0.25, 0.5)};
    write("/tf_static", 0, tf);
  }
  // Received `late` seconds after it was taken.
  void frame(double seconds, double late = 0.0) {
    write("/cam/color/image_raw", seconds + late, image(seconds, red(), "rgb8"));
    write("/cam/color/camera_info", seconds + late, camera_info(seconds));
    write("/cam/depth_registered/image", seconds + late, image(seconds + 0.003, metres(), "32FC1"));
  }
  std::unique_ptr<Recording> open(const RecordingConfig& config = {}) {
    bag_.close();
    return open_recording(file(), config);
  }

  test::TemporaryFolder folder_;
  rosbag::Bag bag_;
};

TEST_F(RosBag, IsReadAsItsMessagesSay) {
  mounts();
  frame(1.0);
  write("/scan", 1.1, scan(1.1));
  write("/odom", 1.2, odometry(1.2, 0.5, 0.25));
  frame(2.0);
  const auto recording = open();
  const StreamInfo& info = recording->info();
  EXPECT_EQ(info.source, "drive.bag");
  EXPECT_EQ(info.frame_count, 2);
  EXPECT_FALSE(info.has_recorded_poses);
  EXPECT_TRUE(recording->remarks().empty());
  const StreamInfo::Camera& camera = info.cameras.at("camera");
  EXPECT_EQ(camera.intrinsics.fx, 50);
  EXPECT_EQ(camera.intrinsics.fy, 51);
  EXPECT_EQ(camera.intrinsics.cx, 3.5);
  EXPECT_EQ(camera.intrinsics.width, kWidth);
  EXPECT_DOUBLE_EQ(camera.rate_hz, 1.0);
  // Along the chain of tf: the mast is turned by 90 deg.
  EXPECT_TRUE(camera.X_BC.translation().isApprox(Eigen::Vector3d(0.1, 0.2, 1.4), 1e-12)) << camera.X_BC.translation().transpose();
  EXPECT_NEAR(yaw_of(camera.X_BC), kPi / 2, 1e-12);
  EXPECT_NEAR(info.lasers.at("laser").X_BL.translation().y(), 0.2, 1e-12);
  EXPECT_NEAR(yaw_of(info.lasers.at("laser").X_BL), 0.5, 1e-12);

  auto event = recording->next();
  auto& first = std::get<RgbdFrame>(*event);
  EXPECT_EQ(first.stamp, 1600000001'000000000);
  load_pictures(first);
  EXPECT_EQ(first.colour.at<cv::Vec3b>(3, 3), cv::Vec3b(10, 30, 200)) << "BGR";
  EXPECT_FLOAT_EQ(first.depth.at<float>(3, 3), 1.234f) << "whole millimetres";
  for (const int u : {1, 2, 3}) EXPECT_EQ(first.depth.at<float>(0, u), 0.0f) << u;
  event = recording->next();
  const auto& turn = std::get<LaserScan>(*event);
  EXPECT_NEAR(static_cast<double>(turn.stamp - 1600000001'100000000), 0.0, 500.0) << "to the resolution of the test's own clock";
  EXPECT_EQ(turn.ranges, (std::vector<float>{1.5f, 0, 0, 0, 10.0f}));
  EXPECT_EQ(turn.beam_interval, 100000);
  EXPECT_EQ(turn.angle_increment, 0.5);
  event = recording->next();
  const Pose& X_OB = std::get<OdometryReading>(*event).X_OB;
  EXPECT_EQ(X_OB.translation().x(), 0.5);
  EXPECT_NEAR(yaw_of(X_OB), 0.25, 1e-12);
}

TEST_F(RosBag, SortsWhatCameOutOfOrderAndLeavesOutWhatHasNoPartner) {
  mounts();
  frame(1.0);
  frame(3.0);
  frame(2.0, 1.2);
  write("/cam/color/image_raw", 3.5, image(3.5, red(), "rgb8"));             // no depth
  write("/cam/depth_registered/image", 3.8, image(3.8, metres(), "32FC1"));  // no colour
  write("/cam/color/image_raw", 4.0, image(1.0, red(), "rgb8"));             // sent twice
  write("/scan", 1.5, scan(1.6));
  write("/scan", 1.6, scan(1.5));
  const auto recording = open();
  EXPECT_EQ(recording->info().frame_count, 3);
  std::string all;
  for (const std::string& remark : recording->remarks()) all += remark + "\n";
  for (const char* part :
       {"2 pictures came out of order", "1 pictures have a stamp that was there before", "1 depth images came out of order",
        "1 scans came out of order", "1 of 4 colour pictures have no depth image", "1 of 4 depth images have no colour"}) {
    EXPECT_NE(all.find(part), std::string::npos) << part << " is not in\n" << all;
  }
  Stamp last = 0;
  while (const auto event = recording->next()) {
    EXPECT_GE(stamp_of(*event), last);
    last = stamp_of(*event);
  }
}

// Some drivers set no stamps.
TEST_F(RosBag, ReadingsOfOneStampAreRefused) {
  mounts();
  for (const double t : {1.0, 2.0, 3.0}) {
    frame(t);
    auto reading = odometry(t, t, 0);
    reading.header.stamp = ros::Time(0, 0);
    write("/odom", t, reading);
    write("/scan", t, scan(1.5));
  }
  bag_.close();
  RecordingConfig config;
  EXPECT_ERROR(open_recording(file(), config), "drive.bag: all 3 scans (/scan) have the stamp 1600000001.5", "expected the time",
               "recording.bag.laser_topic=none");
  config.bag.laser_topic = "none";
  EXPECT_ERROR(open_recording(file(), config), "all 3 odometry readings (/odom) have the stamp 0.000000000", "odometry_topic=none");
  config.bag.odometry_topic = "none";
  const auto recording = open_recording(file(), config);
  EXPECT_EQ(recording->info().frame_count, 3);
  EXPECT_FALSE(recording->info().has_odometry);
  EXPECT_TRUE(recording->info().lasers.empty());
}

TEST_F(RosBag, PicturesOfOneStampAreRefused) {
  mounts();
  for (int i = 0; i < 4; ++i) frame(0.0, 1.0 + i);
  EXPECT_ERROR(open(), "all 4 pictures (/cam/color/image_raw) have the stamp 1600000000.000000000; expected the time");
}

TEST_F(RosBag, ClocksAreShiftedBeforePicturesArePaired) {
  mounts();
  write("/cam/color/camera_info", 1, camera_info(1));
  for (const double t : {1.0, 1.5, 2.0}) {
    write("/cam/color/image_raw", t, image(t, red(), "rgb8"));
    write("/cam/depth_registered/image", t + 0.2, image(t + 0.2, metres(), "32FC1"));
  }
  write("/scan", 3, scan(3));
  RecordingConfig config;
  config.clock.depth_s = -0.2;
  config.clock.colour_s = 0.0;
  config.clock.laser_s = 10.0;
  bag_.close();
  EXPECT_ERROR(open_recording(file()), "no colour picture with a depth image within", "3 in /cam/color/image_raw");
  const auto recording = open_recording(file(), config);
  EXPECT_EQ(recording->info().frame_count, 3);
  Stamp last = 0;
  while (const auto event = recording->next()) last = stamp_of(*event);
  EXPECT_EQ(last, 1600000013'000000000);
  // Both of the camera's clocks: the pairs stay, the frames move.
  config.clock.colour_s = 5.0;
  config.clock.depth_s = 4.8;
  const auto moved = open_recording(file(), config);
  EXPECT_EQ(stamp_of(*moved->next()), 1600000006'000000000);
}

TEST_F(RosBag, PosesComeFromTfAtTheInstantOfThePicture) {
  mounts();
  for (const double t : {0.5, 1.5, 2.5}) {
    tf2_msgs::TFMessage tf;
    tf.transforms = {transform(t, "map", "odom", 1.0, 0, 0, 0), transform(t, "odom", "base_link", 2.0 * t, 0, 0, 0.2 * t)};
    write("/tf", t, tf);
  }
  frame(1.0);
  frame(2.0);
  frame(9.0);  // tf had ended
  RecordingConfig config;
  config.bag.world_frame = "map";
  config.max_pose_gap_s = 1.001;
  const auto recording = open(config);
  EXPECT_TRUE(recording->info().has_recorded_poses);
  EXPECT_EQ(recording->lost_frames(), 0) << "the frame stays, without a pose";
  EXPECT_EQ(recording->remarks().back(), "1 frames have no pose in tf");
  EXPECT_EQ(recording->info().frame_count, 3);
  const Pose X_BC = recording->info().cameras.at("camera").X_BC;
  for (const double t : {1.0, 2.0}) {
    const auto event = recording->next();
    const Pose expected = make_upright_pose(1.0 + 2.0 * t, 0, 0, 0.2 * t) * X_BC;
    EXPECT_TRUE(std::get<RgbdFrame>(*event).recorded_X_WC->isApprox(expected, 1e-9)) << t;
  }
  // A camera whose clock is half a second behind: its pictures show where the vehicle was half a second later.
  config.clock.colour_s = config.clock.depth_s = 0.5;
  const auto late = open_recording(file(), config);
  const auto event = late->next();
  EXPECT_EQ(stamp_of(*event), 1600000001'500000000);
  EXPECT_EQ(std::get<RgbdFrame>(*event).named_stamp, 1600000001'000000000);
  EXPECT_TRUE(std::get<RgbdFrame>(*event).recorded_X_WC->isApprox(make_upright_pose(1.0 + 3.0, 0, 0, 0.3) * X_BC, 1e-9));
  config.bag.world_frame = "moon";
  EXPECT_ERROR(open_recording(file(), config), "'moon'", "recording.bag.world_frame");
}

// Of the transforms between world and camera the one with the longest gap decides; those of other frames do not count.
TEST_F(RosBag, PosesInLongGapsOfTfAreNone) {
  mounts();
  const auto send = [&](double t, const std::string& parent, const std::string& child, double x) {
    tf2_msgs::TFMessage tf;
    tf.transforms = {transform(t, parent, child, x, 0, 0, 0)};
    write("/tf", t, tf);
  };
  for (int i = 0; i <= 40; ++i) send(0.1 * i, "odom", "base_link", 0.1 * i);
  for (const double t : {0.0, 0.4, 0.8, 2.0, 2.4, 4.0}) send(t, "map", "odom", 1.0);
  for (const double t : {0.0, 4.0}) {
    send(t, "base_link", "lift", 0.0);  // beside the way to the camera
    send(t, "earth", "map", 1000.0);    // above both
  }
  for (const double t : {0.65, 1.25, 1.95, 2.0, 2.25, 3.05, 5.0}) frame(t);
  bag_.close();
  RecordingConfig config;
  config.bag.world_frame = "map";
  const auto poses = [&] {
    std::string text;
    const auto recording = open_recording(file(), config);
    while (const auto event = recording->next()) text += std::get<RgbdFrame>(*event).recorded_X_WC ? "1" : "0";
    for (const std::string& remark : recording->remarks()) text += "\n" + remark;
    return text;
  };
  EXPECT_EQ(poses(),
            "1001100\n1 frames have no pose in tf\n3 frames have no pose: they lie in gaps of tf of more than 0.500000 s "
            "(recording.max_pose_gap_s)");
  config.max_pose_gap_s = 1.3;
  EXPECT_EQ(poses().substr(0, 7), "1111100");
  config.max_pose_gap_s = 10.0;
  EXPECT_EQ(poses(), "1111110\n1 frames have no pose in tf");
  config.max_pose_gap_s = 0.0;
  EXPECT_EQ(poses().substr(0, 7), "0001000") << "the one at which both have a message";
  config.clock.colour_s = config.clock.depth_s = 0.03;
  EXPECT_ERROR(open_recording(file(), config), "tf says of no frame", "recording.max_pose_gap_s");
}

// To tf the time 0 is "the latest".
TEST_F(RosBag, TheFirstPictureMayBeAtTimeNought) {
  tf2_msgs::TFMessage mounts;
  for (const double t : {0.0, 1.0, 2.0}) {
    tf2_msgs::TFMessage tf;
    tf.transforms = {transform(0, "odom", "base_link", 5.0 + t, 0, 0, 0), transform(0, "base_link", "optical", 0.1, 0, 1, 0)};
    for (auto& each : tf.transforms) each.header.stamp.fromSec(t);
    bag_.write("/tf", std::max(tf.transforms[0].header.stamp, ros::TIME_MIN), tf);
    // A second broadcaster that says the same, and one that says nothing.
    bag_.write("/tf", std::max(tf.transforms[0].header.stamp, ros::TIME_MIN), tf);
    tf.transforms.resize(1);
    tf.transforms[0].transform.translation.x = std::nan("");
    bag_.write("/tf", std::max(tf.transforms[0].header.stamp, ros::TIME_MIN), tf);
  }
  auto colour = image(0, red(), "rgb8"), depth = image(0, metres(), "32FC1");
  auto info = camera_info(0);
  colour.header.stamp = depth.header.stamp = info.header.stamp = ros::Time(0, 0);
  bag_.write("/cam/color/image_raw", ros::TIME_MIN, colour);
  bag_.write("/cam/depth_registered/image", ros::TIME_MIN, depth);
  bag_.write("/cam/color/camera_info", ros::TIME_MIN, info);
  RecordingConfig config;
  config.bag.world_frame = "odom";
  config.max_pose_gap_s = 1.0;
  testing::internal::CaptureStderr();
  const auto recording = open(config);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << "libraries are quiet";
  const auto event = recording->next();
  EXPECT_NEAR(std::get<RgbdFrame>(*event).recorded_X_WC->translation().x(), 5.1, 1e-6);
  EXPECT_EQ(recording->remarks().back(), "3 transforms are none and are left out");
}

TEST_F(RosBag, DepthOfAnotherViewIsRefused) {
  tf2_msgs::TFMessage tf;
  tf.transforms = {transform(0, "base_link", "optical", 0.1, 0, 1, 0), transform(0, "optical", "depth_optical", 0.03, 0, 0, 0)};
  write("/tf_static", 0, tf);
  write("/cam/color/image_raw", 1, image(1, red(), "rgb8"));
  write("/cam/color/camera_info", 1, camera_info(1));
  auto depth = image(1, metres(), "32FC1");
  depth.header.frame_id = "depth_optical";
  write("/cam/depth/image_raw", 1, depth);
  bag_.close();
  EXPECT_ERROR(open_recording(file()), "/cam/depth/image_raw is in frame 'depth_optical'", "recording.bag.registered=yes");
  RecordingConfig config;
  config.bag.registered = "yes";
  EXPECT_EQ(open_recording(file(), config)->info().frame_count, 1);
}

TEST_F(RosBag, DepthOfAnotherLensIsRefused) {
  mounts();
  frame(1.0);
  auto info = camera_info(1);
  info.K[0] = info.K[4] = 58;
  write("/cam/depth_registered/camera_info", 1, info);
  EXPECT_ERROR(open(), "is taken with another lens than /cam/color/image_raw", "58");
}

// The depth of another camera of the robot is not this one's.
TEST_F(RosBag, OwnImagesOfTheDepthCameraAreOfTheSameDevice) {
  mounts();
  frame(1.0);
  write("/rear/depth/image_raw", 1, image(1, metres(), "32FC1"));
  write("/rear/depth/camera_info", 1, camera_info(1));
  bag_.close();
  EXPECT_FALSE(open_recording(file())->info().cameras.at("camera").native);
  const auto sources = open_recording(file())->sources();
  EXPECT_EQ(sources, (std::vector<std::string>{"pictures: /cam/color/image_raw", "depth: /cam/depth_registered/image"}));
}

TEST_F(RosBag, PicturesThatAreNotReadAreNamed) {
  mounts();
  write("/cam/color/image_raw", 1, image(1, cv::Mat(kHeight, kWidth, CV_8UC1, cv::Scalar(7)), "bayer_rggb8"));
  write("/cam/depth_registered/image", 1, image(1, metres(), "32FC1"));
  write("/scan", 1, scan(1));
  EXPECT_ERROR(open(), "no picture that is read", "/cam/color/image_raw (bayer_rggb8)");
}

TEST_F(RosBag, PicturesWithoutDepthLeaveALaserLog) {
  mounts();
  write("/cam/color/image_raw", 1, image(1, red(), "rgb8"));
  write("/scan", 1, scan(1));
  auto broken = scan(2);
  broken.angle_min = std::numeric_limits<float>::quiet_NaN();
  write("/scan", 2, broken);
  const auto recording = open();
  EXPECT_TRUE(recording->info().cameras.empty());
  ASSERT_EQ(recording->remarks().size(), 2u);
  EXPECT_NE(recording->remarks()[0].find("the bag holds no depth"), std::string::npos);
  EXPECT_EQ(recording->remarks()[1], "1 scans name no angles and are left out");
}

// What a preset names is preferred, what a user names is demanded.
TEST_F(RosBag, PresetsAreNoDemands) {
  mounts();
  frame(1.0);
  RecordingConfig config;
  config.bag = RosBagConfig::of_preset("agiprobot");
  EXPECT_EQ(open(config)->info().frame_count, 1);
  config.bag.colour_topic = "/camera/colour";
  EXPECT_ERROR(open_recording(file(), config), "/camera/colour is not in the bag");
}

// A camera that hangs upside down: the pictures are turned, and so is the camera, so that every pixel sees the same ray as before.
TEST_F(RosBag, PicturesOfAnUpsideDownCameraAreTurned) {
  mounts();
  cv::Mat colour = red(), depth = metres();
  colour.at<cv::Vec3b>(4, 1) = cv::Vec3b(1, 2, 3);
  depth.at<float>(4, 1) = 2.5f;
  write("/cam/color/camera_info", 1, camera_info(1));
  write("/cam/color/image_raw", 1, image(1, colour, "bgr8"));
  write("/cam/depth_registered/image", 1, image(1, depth, "32FC1"));
  bag_.close();
  const Pose X_BC = open_recording(file())->info().cameras.at("camera").X_BC;
  const Eigen::Vector3d p_B = X_BC * Eigen::Vector3d((1 - 3.5) / 50 * 2.5, (4 - 2.5) / 51 * 2.5, 2.5);
  const std::pair<int, cv::Point> turns[] = {{0, {1, 4}}, {90, {1, 1}}, {180, {6, 1}}, {270, {4, 6}}};
  for (const auto& [degrees, pixel] : turns) {
    SCOPED_TRACE(degrees);
    RecordingConfig config;
    config.rotate_deg = degrees;
    const auto recording = open_recording(file(), config);
    const StreamInfo::Camera& camera = recording->info().cameras.at("camera");
    auto event = recording->next();
    auto& frame = std::get<RgbdFrame>(*event);
    load_pictures(frame);
    ASSERT_EQ(frame.colour.cols, camera.intrinsics.width);
    EXPECT_EQ(frame.colour.at<cv::Vec3b>(pixel), cv::Vec3b(1, 2, 3));
    const double z = static_cast<double>(frame.depth.at<float>(pixel));
    const Intrinsics& k = camera.intrinsics;
    EXPECT_TRUE((camera.X_BC * Eigen::Vector3d((pixel.x - k.cx) / k.fx * z, (pixel.y - k.cy) / k.fy * z, z)).isApprox(p_B, 1e-6));
  }
}

TEST_F(RosBag, DistortedPicturesBecomePinholeOnes) {
  mounts();
  const int width = 160, height = 120;
  auto info = camera_info(1);
  info.width = width, info.height = height;
  info.K = {100, 0, 79.5, 0, 100, 59.5, 0, 0, 1};
  info.D = {-0.2, 0.05, 0.001, -0.002, 0.0};
  // A white line where a straight edge (x = 0.5 z) falls in the distorted picture.
  const Lens lens(Intrinsics::checked(width, height, 100, 100, 79.5, 59.5), {-0.2, 0.05, 0, 0, 0, 0, 0.001, -0.002});
  cv::Mat colour(height, width, CV_8UC3, cv::Scalar::all(0)), depth(height, width, CV_16UC1, cv::Scalar(1500));
  for (double y = -0.5; y <= 0.5; y += 0.002) {
    const auto pixel = lens.project(Eigen::Vector3d(0.5, y, 1.0));
    colour.at<cv::Vec3b>(cv::Point(static_cast<int>(std::lround(pixel->x())), static_cast<int>(std::lround(pixel->y())))) = {255, 255, 255};
  }
  write("/cam/color/camera_info", 1, info);
  write("/cam/color/image_raw", 1, image(1, colour, "bgr8"));
  write("/cam/depth_registered/image", 1, image(1, depth, "16UC1"));
  const auto brightest = [](const cv::Mat& picture, int v) {
    int best = 0;
    for (int u = 0; u < picture.cols; ++u) best = picture.at<cv::Vec3b>(v, u)[0] > picture.at<cv::Vec3b>(v, best)[0] ? u : best;
    return best;
  };
  const auto recording = open();
  auto event = recording->next();
  auto& frame = std::get<RgbdFrame>(*event);
  load_pictures(frame);
  for (const int v : {20, 40, 60, 80, 100}) EXPECT_NEAR(brightest(frame.colour, v), 79.5 + 50.0, 1.01) << v;
  EXPECT_GT(std::abs(brightest(colour, 100) - 129.5), 3) << "the stored picture's edge is bent";
  EXPECT_FLOAT_EQ(frame.depth.at<float>(60, 80), 1.5f);

  RecordingConfig as_is;
  as_is.bag.rectified = "yes";
  const auto untouched = open_recording(file(), as_is);
  event = untouched->next();
  load_pictures(std::get<RgbdFrame>(*event));
  EXPECT_EQ(cv::norm(std::get<RgbdFrame>(*event).colour, colour, cv::NORM_L1), 0.0);
}

TEST_F(RosBag, CompressedPicturesOfEitherKind) {
  mounts();
  const auto packed = [](double t, const std::string& format, const cv::Mat& picture, std::size_t head) {
    auto message = stamped<sensor_msgs::CompressedImage>(t, "optical");
    message.format = format;
    std::vector<unsigned char> png;
    cv::imencode(".png", picture, png);
    message.data.assign(head, 0);
    message.data.insert(message.data.end(), png.begin(), png.end());
    return message;
  };
  write("/cam/color/camera_info", 1, camera_info(1));
  write("/cam/color/image_raw/compressed", 1,
        packed(1, "bgr8; jpeg compressed bgr8", cv::Mat(kHeight, kWidth, CV_8UC3, cv::Scalar(9, 8, 7)), 0));
  auto quantised = packed(1, "32FC1; compressedDepth", cv::Mat(kHeight, kWidth, CV_16UC1, cv::Scalar(500)), 12);
  const float a = 1000.0f, b = 100.0f;  // depth = a / (q - b) = 2.5 m
  std::memcpy(quantised.data.data() + 4, &a, 4);
  std::memcpy(quantised.data.data() + 8, &b, 4);
  write("/cam/depth_registered/image_raw/compressedDepth", 1, quantised);
  const auto recording = open();
  auto event = recording->next();
  auto& frame = std::get<RgbdFrame>(*event);
  load_pictures(frame);
  EXPECT_EQ(frame.colour.at<cv::Vec3b>(1, 1), cv::Vec3b(9, 8, 7));
  EXPECT_EQ(frame.depth.at<float>(1, 1), 2.5f);
}

TEST_F(RosBag, SaysWhichTopicIsMeantAndWhatIsMissing) {
  frame(1.0);
  write("/other/image_raw", 1, image(1, red(), "bgr8"));
  write("/scan", 1.1, scan(1.1));
  bag_.close();
  EXPECT_ERROR(open_recording(file()), "/cam/color/image_raw, /other/image_raw", "recording.bag.colour_topic");
  RecordingConfig config;
  config.bag.colour_topic = "/cam/color/image_raw";
  EXPECT_ERROR(open_recording(file(), config), "where the camera (frame 'optical')", "recording.camera_mount");
  config.camera_mount = {0.1, 0, 1.4, 0, 45, 0};
  EXPECT_ERROR(open_recording(file(), config), "where the laser (frame 'laser')", "recording.laser_mount");
  config.laser_mount = {0.3, 0.2, 0.3, 43.9, 0, 0};
  const auto recording = open_recording(file(), config);
  EXPECT_TRUE(recording->info().cameras.at("camera").X_BC.translation().isApprox(Eigen::Vector3d(0.1, 0, 1.4)));
  EXPECT_LT((recording->info().cameras.at("camera").X_BC.linear() * Eigen::Vector3d::UnitZ()).z(), -0.7) << "looks down";
  EXPECT_EQ(stamp_of(*recording->next()), 1600000001'000000000);
  config.bag.depth_topic = "/nowhere";
  EXPECT_ERROR(open_recording(file(), config), "recording.bag.depth_topic", "/nowhere", "is not in the bag", "/cam/depth_registered/image");
  config.bag.depth_topic = "/scan";
  EXPECT_ERROR(open_recording(file(), config), "/scan holds sensor_msgs/LaserScan");
  config.bag.depth_topic = "/cam/color/image_raw";
  EXPECT_ERROR(open_recording(file(), config), "recording.bag.depth_topic", "is the colour topic");
  config.bag.depth_topic = "/other/image_raw";
  auto wrong = open_recording(file(), config);
  auto event = wrong->next();
  EXPECT_ERROR(load_pictures(std::get<RgbdFrame>(*event)), "has encoding 'bgr8'; expected 16UC1");
}

TEST_F(RosBag, DamagedBagsAreNamed) {
  mounts();
  frame(1.0);
  write("/cam/color/image_raw", 2, [] {
    auto damaged = image(2, red(), "rgb8");
    damaged.data.resize(10);
    return damaged;
  }());
  write("/cam/depth_registered/image", 2, image(2, metres(), "32FC1"));
  const auto recording = open();
  recording->next();
  auto event = recording->next();
  EXPECT_ERROR(load_pictures(std::get<RgbdFrame>(*event)), "drive.bag: /cam/color/image_raw", "is damaged: 8 x 6");
  const std::string whole = read_file(file());
  write_file(file(), "not a bag");
  EXPECT_ERROR(open_recording(file()), "drive.bag");
  write_file(file(), whole.substr(0, whole.size() / 2));
  EXPECT_ERROR(open_recording(file()), "drive.bag", "rosbag reindex");
  write_file(file(), "");
  EXPECT_ERROR(open_recording(file()), "drive.bag");
  write_file(folder_.path() / "b.bag", whole);
  EXPECT_ERROR(open_recording(folder_.path()), "holds 2 bags", "expected one");
}

}  // namespace
}  // namespace waretwin

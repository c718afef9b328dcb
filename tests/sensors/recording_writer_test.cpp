#include "sensors/recordings/recording_writer.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "core/random.h"
#include "sensors/odometry_model.h"
#include "sensors/sensors_config.h"
#include "tests/support/expect_error.h"
#include "tests/support/test_data.h"

namespace waretwin {
namespace {

namespace fs = std::filesystem;

// Odd numbers everywhere: what is rounded on its way through the files does not come back.
StreamInfo odd_stream() {
  StreamInfo info;
  info.source = "odd";
  Pose X_BC = make_upright_pose(0.1, 0.2, 1.4, 0.3);
  X_BC.linear() = rotation_from_rpy(0.01, 0.7853981, 0.3) * optical_from_forward();
  Pose X_CD = Pose::Identity();
  X_CD.linear() = rotation_from_rpy(-1.0 / 9, 1e-3, 2e-3);
  X_CD.translation() = Eigen::Vector3d(-0.032, 1.0 / 7, 0);
  info.cameras["front"] = {
      Intrinsics::checked(40, 30, 612.3456789012345, 612.1, 19.7, 14.3),
      X_BC,
      0.5,
      3.86,
      15.0,
      DepthCameraView{Lens(Intrinsics::checked(24, 20, 490.1, 490.3, 11.5, 9.5), CameraConfig().time_of_flight.lens), X_CD}};
  info.lasers["low"] = {make_upright_pose(0.275, 0.2, 0.3, 0.766), 25.0};
  info.has_odometry = true;
  info.own_body_B.emplace(Eigen::Vector3d(-0.45, -1.0 / 3, 0), Eigen::Vector3d(0.45, 1.0 / 3, 1.42));
  info.X_WB_start = make_upright_pose(1.0 / 3, 2.0 / 7, 0, 1.1);
  return info;
}

RgbdFrame frame_of(int number) {
  const RandomStream random(7, "test", "pictures", number);
  RgbdFrame frame;
  frame.sensor = "front";
  // Every other one with a scan and an odometry reading at the very same time: they come first.
  frame.stamp = 1305031102'000000000 + 200'000'000LL * number + (number % 2 == 0 ? 0 : 66'666'667);
  frame.colour.create(30, 40, CV_8UC3);
  frame.depth.create(30, 40, CV_32FC1);
  frame.native_depth.create(20, 24, CV_32FC1);
  for (std::size_t i = 0; i < frame.colour.total() * 3; ++i) frame.colour.data[i] = static_cast<unsigned char>(random.words(i)[0] & 255u);
  // All millimetres that a reading may have; 65535 marks an invalid one in other people's recordings.
  const auto fill = [&](cv::Mat& depth, std::uint32_t draw) {
    for (std::size_t i = 0; i < depth.total(); ++i) depth.ptr<float>()[i] = static_cast<float>(random.words(i, draw)[0] % 65535u) * 0.001f;
  };
  fill(frame.depth, 1);
  fill(frame.native_depth, 2);
  return frame;
}

bool same(const cv::Mat& a, const cv::Mat& b) { return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_L1) == 0.0; }

// The formats of this build.
std::vector<std::string> formats() {
  std::vector<std::string> names = recording_formats();
#ifndef WARETWIN_ROSBAG
  std::erase(names, "rosbag");
#endif
  return names;
}

class RecordingFormat : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(All, RecordingFormat, ::testing::ValuesIn(formats()), [](const auto& format) { return "of_" + format.param; });

TEST_P(RecordingFormat, WhatIsWrittenReadsBackToTheSameBits) {
  const StreamInfo info = odd_stream();
  std::vector<SensorEvent> events;
  OdometryModel odometry(OdometryConfig{}, 5, "odometry");
  for (int i = 0; i < 50; ++i) {
    const Stamp stamp = 1305031102'000000000 + i * 20'000'000;
    events.emplace_back(odometry.advance(stamp, make_upright_pose(0.1 * i, 0.01 * i, 0, 0.05 * i)));
    if (i % 10 == 0) {
      LaserScan scan;
      scan.stamp = stamp;
      scan.sensor = "low";
      // What a scan says of itself are 32-bit floats, as drivers deliver it.
      scan.angle_min = static_cast<double>(-2.35619449f);
      scan.angle_increment = static_cast<double>(0.00872664626f);
      scan.beam_interval = 55556;
      scan.range_min = static_cast<double>(0.05f);
      scan.range_max = 30;
      scan.ranges = {0.0f, 1.23f, 29.99f, 0.1f + static_cast<float>(i) / 3.0f, 0.05f, 30.0f};
      events.emplace_back(scan);
    }
  }
  for (int i = 0; i < 5; ++i) events.emplace_back(frame_of(i));
  std::stable_sort(events.begin(), events.end(), [](const auto& a, const auto& b) { return stamp_of(a) < stamp_of(b); });

  const test::TemporaryFolder folder;
  const auto writer = make_recording_writer(GetParam(), folder.path(), info, "a test");
  for (const SensorEvent& event : events) std::visit([&](const auto& e) { writer->add(e); }, event);
  writer->finish();
  for (const auto& entry : fs::directory_iterator(folder.path())) {
    EXPECT_TRUE(is_recording_part(entry.path().filename().string())) << entry.path();
  }
  EXPECT_FALSE(fs::exists(folder.path() / "groundtruth.txt"));

  const auto recording = open_recording(folder.path());
  const StreamInfo& read = recording->info();
  const StreamInfo::Camera &camera = read.cameras.at("front"), &was = info.cameras.at("front");
  EXPECT_EQ(camera.X_BC.matrix(), was.X_BC.matrix());
  EXPECT_EQ(camera.intrinsics.fx, was.intrinsics.fx);
  EXPECT_EQ(camera.intrinsics.cy, was.intrinsics.cy);
  EXPECT_EQ(camera.depth_min_m, was.depth_min_m);
  EXPECT_EQ(camera.depth_max_m, was.depth_max_m);
  EXPECT_EQ(camera.rate_hz, was.rate_hz);
  ASSERT_TRUE(camera.native);
  EXPECT_EQ(camera.native->X_CD.matrix(), was.native->X_CD.matrix());
  EXPECT_EQ(camera.native->lens.ray(3, 17), was.native->lens.ray(3, 17));
  EXPECT_EQ(read.lasers.at("low").X_BL.matrix(), info.lasers.at("low").X_BL.matrix());
  EXPECT_EQ(read.X_WB_start.matrix(), info.X_WB_start.matrix());
  EXPECT_EQ(read.up_W, info.up_W);
  ASSERT_TRUE(read.own_body_B);
  EXPECT_EQ(read.own_body_B->min(), info.own_body_B->min());
  EXPECT_EQ(read.own_body_B->max(), info.own_body_B->max());
  EXPECT_TRUE(read.has_odometry);
  EXPECT_FALSE(read.has_recorded_poses);
  EXPECT_EQ(read.frame_count, 5);
  for (const SensorEvent& event : events) {
    auto next = recording->next();
    ASSERT_TRUE(next);
    ASSERT_EQ(next->index(), event.index());
    ASSERT_EQ(stamp_of(*next), stamp_of(event));
    if (const auto* reading = std::get_if<OdometryReading>(&event)) {
      EXPECT_EQ(std::get<OdometryReading>(*next).X_OB.matrix(), reading->X_OB.matrix());
    } else if (const auto* scan = std::get_if<LaserScan>(&event)) {
      const auto& again = std::get<LaserScan>(*next);
      EXPECT_EQ(again.sensor, scan->sensor);
      EXPECT_EQ(again.ranges, scan->ranges);
      EXPECT_EQ(again.angle_min, scan->angle_min);
      EXPECT_EQ(again.angle_increment, scan->angle_increment);
      EXPECT_EQ(again.beam_interval, scan->beam_interval);
      EXPECT_EQ(again.range_min, scan->range_min);
      EXPECT_EQ(again.range_max, scan->range_max);
    } else {
      auto& again = std::get<RgbdFrame>(*next);
      const auto& frame = std::get<RgbdFrame>(event);
      load_pictures(again);
      EXPECT_EQ(again.sensor, "front");
      EXPECT_TRUE(same(again.colour, frame.colour));
      EXPECT_TRUE(same(again.depth, frame.depth));
      EXPECT_TRUE(same(again.native_depth, frame.native_depth));
      EXPECT_FALSE(again.recorded_X_WC);
    }
  }
  EXPECT_FALSE(recording->next());
}

TEST(RecordingWriter, WritesOnlyWhatTheVehicleHas) {
  StreamInfo info = odd_stream();
  info.cameras.clear();
  info.has_odometry = false;
  const test::TemporaryFolder folder;
  const auto writer = make_recording_writer("tum", folder.path(), info, "a test");
  LaserScan scan;
  scan.ranges = {1.0f};
  writer->add(scan);
  writer->finish();
  for (const char* name : {"rgb.txt", "depth.txt", "depth_native.txt", "odometry.txt"})
    EXPECT_FALSE(fs::exists(folder.path() / name)) << name;
  EXPECT_TRUE(open_recording(folder.path())->info().cameras.empty());

  info = odd_stream();
  info.cameras.at("front").native.reset();
  const test::TemporaryFolder other;
  const auto plain = make_recording_writer("tum", other.path(), info, "a test");
  RgbdFrame frame = frame_of(0);
  frame.native_depth.release();
  plain->add(frame);
  plain->finish();
  EXPECT_FALSE(fs::exists(other.path() / "depth_native.txt"));
  EXPECT_FALSE(open_recording(other.path())->info().cameras.at("front").native);
}

// Formats that are published with poses carry them, to the same bits, and none where the stream has none.
TEST_P(RecordingFormat, CarriesPosesWhereTheLayoutHasThem) {
  const bool with_poses = GetParam() != "rosbag", as_matrix = GetParam() != "tum";
  StreamInfo info = odd_stream();
  info.cameras.at("front").native.reset();
  const test::TemporaryFolder folder;
  const auto writer = make_recording_writer(GetParam(), folder.path(), info, "a test");
  std::vector<Pose> poses;
  for (int i = 0; i < 3; ++i) {
    RgbdFrame frame = frame_of(i);
    Pose X_WC = make_upright_pose(i / 3.0, 1.0 / 7, 1.4, 0.2 * i);
    X_WC.linear() = X_WC.linear() * optical_from_forward();
    poses.push_back(X_WC);
    frame.recorded_X_WC = X_WC;
    writer->add(frame);
  }
  writer->finish();
  const auto recording = open_recording(folder.path());
  EXPECT_EQ(recording->info().has_recorded_poses, with_poses);
  EXPECT_TRUE(recording->remarks().empty());
  for (const Pose& pose : poses) {
    const auto event = recording->next();
    ASSERT_TRUE(event);
    const auto& frame = std::get<RgbdFrame>(*event);
    ASSERT_EQ(frame.recorded_X_WC.has_value(), with_poses);
    if (with_poses) {
      EXPECT_TRUE(frame.recorded_X_WC->isApprox(pose, 1e-14));
      EXPECT_TRUE(!as_matrix || frame.recorded_X_WC->matrix() == pose.matrix()) << "a matrix comes back to the same bits";
    }
  }
}

// What the user says goes over recording.yaml.
TEST_P(RecordingFormat, TrustedDepthIsTheRecordingsUnlessToldOtherwise) {
  const test::TemporaryFolder folder;
  const auto writer = make_recording_writer(GetParam(), folder.path(), odd_stream(), "a test");
  writer->add(frame_of(0));
  writer->finish();
  RecordingConfig config;
  const auto range = [&] {
    const StreamInfo::Camera& camera = open_recording(folder.path(), config)->info().cameras.at("front");
    return std::pair(camera.depth_min_m, camera.depth_max_m);
  };
  EXPECT_EQ(range(), std::pair(0.5, 3.86));
  config.depth_max_m = 9;
  EXPECT_EQ(range(), std::pair(0.5, 9.0));
  config.depth_max_m = 0.4;
  EXPECT_ERROR(range(), "depth_max_m above depth_min_m");
}

TEST(RecordingWriter, UnknownFormatsAreRefused) {
  const test::TemporaryFolder folder;
  EXPECT_ERROR(make_recording_writer("rosbag2", folder.path(), odd_stream(), "a test"), "rosbag2", "tum, 7scenes, scenenn or rosbag");
}

TEST(RecordingWriter, HasRoomForOneSensorOfAKind) {
  const test::TemporaryFolder folder;
  StreamInfo info = odd_stream();
  info.cameras["rear"] = info.cameras.at("front");
  EXPECT_ERROR(make_recording_writer("tum", folder.path(), info, "a test"), "sensors.cameras: front, rear", "expected one");
  info = odd_stream();
  info.lasers["high"] = info.lasers.at("low");
  EXPECT_ERROR(make_recording_writer("tum", folder.path(), info, "a test"), "sensors.lasers: high, low", "expected one");
  info.lasers.clear();
  info.cameras.clear();
  EXPECT_ERROR(make_recording_writer("tum", folder.path(), info, "a test"), "neither camera nor laser");
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(RecordingWriter, NativeImagesNeedTheirLens) {
  const test::TemporaryFolder folder;
  StreamInfo info = odd_stream();
  const auto writer = make_recording_writer("tum", folder.path(), info, "a test");
  writer->add(frame_of(0));
  writer->finish();
  info.cameras.at("front").native.reset();
  const test::TemporaryFolder without;
  const auto plain = make_recording_writer("tum", without.path(), info, "a test");
  plain->finish();
  fs::copy_file(without.path() / "recording.yaml", folder.path() / "recording.yaml", fs::copy_options::overwrite_existing);
  EXPECT_ERROR(open_recording(folder.path()), "depth_native.txt", "native under camera in recording.yaml");
}

}  // namespace
}  // namespace waretwin

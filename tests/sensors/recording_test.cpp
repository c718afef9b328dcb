#include "sensors/recordings/recording.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "core/config.h"
#include "core/files.h"
#include "sensors/recordings/text_formats.h"
#include "tests/support/expect_error.h"
#include "tests/support/test_data.h"

namespace waretwin {
namespace {

namespace fs = std::filesystem;

std::string encoded(const std::string& extension, const cv::Mat& image) {
  std::vector<unsigned char> bytes;
  cv::imencode(extension, image, bytes);
  return {bytes.begin(), bytes.end()};
}

cv::Mat colour_image(int shade) { return {6, 8, CV_8UC3, cv::Scalar(shade, 2 * shade, 3 * shade)}; }

cv::Mat depth_image(int units) {
  cv::Mat image(6, 8, CV_16UC1, cv::Scalar(units));
  image.at<std::uint16_t>(0, 0) = 0;
  image.at<std::uint16_t>(0, 1) = 65535;
  return image;
}

std::string matrix_text(const Pose& pose) {
  std::ostringstream out;
  out.precision(17);
  out << pose.matrix() << "\n";
  return out.str();
}

// Two frames, 0 and 3, in the 7-Scenes layout.
class FrameFolder : public ::testing::Test {
 protected:
  FrameFolder() {
    write("camera-intrinsics.txt", "500 0 3.5\n0 510 2.5\n0 0 1\n");
    for (const int number : {0, 3}) {
      const std::string stem = "frame-00000" + std::to_string(number);
      write(stem + ".color.png", encoded(".png", colour_image(10 + number)));
      write(stem + ".depth.png", encoded(".png", depth_image(1234 + number)));
      Pose pose = make_upright_pose(number, 1, 2, 0.5);
      pose.linear() = pose.linear() * optical_from_forward();
      write(stem + ".pose.txt", matrix_text(pose));
    }
  }

  void write(const std::string& name, const std::string& bytes) { write_file(folder_.path() / name, bytes); }
  fs::path path() const { return folder_.path(); }

  test::TemporaryFolder folder_;
};

std::vector<RgbdFrame> all_frames(SensorStream& stream) {
  std::vector<RgbdFrame> frames;
  while (auto event = stream.next()) {
    if (auto* frame = std::get_if<RgbdFrame>(&*event)) {
      load_pictures(*frame);
      frames.push_back(*frame);
    }
  }
  return frames;
}

TEST_F(FrameFolder, YieldsFramesInOrderWithPosesAndStamps) {
  const auto recording = open_recording(path());
  const StreamInfo& info = recording->info();
  EXPECT_EQ(info.frame_count, 2);
  EXPECT_TRUE(info.has_recorded_poses);
  EXPECT_FALSE(info.has_odometry);
  const StreamInfo::Camera& camera = info.cameras.at("camera");
  EXPECT_EQ(camera.intrinsics.width, 8);
  EXPECT_EQ(camera.intrinsics.height, 6);
  EXPECT_EQ(camera.intrinsics.fx, 500);
  EXPECT_EQ(camera.intrinsics.fy, 510);
  EXPECT_EQ(camera.intrinsics.cx, 3.5);
  EXPECT_EQ(camera.intrinsics.cy, 2.5);
  EXPECT_EQ(camera.rate_hz, 30.0);
  EXPECT_EQ(info.up_W, Eigen::Vector3d::UnitZ());
  const std::vector<RgbdFrame> frames = all_frames(*recording);
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(frames[0].stamp, 0);
  EXPECT_EQ(frames[1].stamp, 100'000'000);
  EXPECT_EQ(frames[1].colour.at<cv::Vec3b>(2, 2), cv::Vec3b(13, 26, 39));
  EXPECT_EQ(frames[1].depth.at<float>(2, 2), 1237 * 0.001f);
  EXPECT_EQ(frames[1].depth.at<float>(0, 0), 0.0f);
  EXPECT_EQ(frames[1].depth.at<float>(0, 1), 0.0f);
  ASSERT_TRUE(frames[1].recorded_X_WC);
  EXPECT_NEAR(frames[1].recorded_X_WC->translation().x(), 3.0, 1e-12);
  EXPECT_LT((info.X_WB_start.matrix() - frames[0].recorded_X_WC->matrix()).norm(), 1e-12);
}

TEST_F(FrameFolder, ConfigurationOverrides) {
  RecordingConfig config;
  config.up = {0, -2, 0};
  config.frame_rate_hz = 10;
  config.depth_scale = 2000;
  config.intrinsics = {100, 101, 4, 3};
  config.depth_max_m = 9;
  const auto recording = open_recording(path(), config);
  EXPECT_EQ(recording->info().up_W, Eigen::Vector3d(0, -1, 0));
  EXPECT_EQ(recording->info().cameras.at("camera").intrinsics.fy, 101);
  EXPECT_EQ(recording->info().cameras.at("camera").depth_max_m, 9);
  const std::vector<RgbdFrame> frames = all_frames(*recording);
  EXPECT_EQ(frames[1].stamp, 300'000'000);
  EXPECT_EQ(frames[0].depth.at<float>(2, 2), 617 * 0.001f);
}

TEST_F(FrameFolder, LostCamerasAreLeftOutAndCounted) {
  write("frame-000003.pose.txt", "-inf -inf -inf -inf\n-inf -inf -inf -inf\n-inf -inf -inf -inf\n0 0 0 1\n");
  const auto recording = open_recording(path());
  EXPECT_EQ(recording->lost_frames(), 1);
  EXPECT_EQ(all_frames(*recording).size(), 1u);
  write("frame-000000.pose.txt", "nan nan nan nan nan nan nan nan nan nan nan nan 0 0 0 1");
  EXPECT_ERROR(open_recording(path()), "no frame with a pose", "2 are lost");
}

TEST_F(FrameFolder, WithoutAnyPosesItStillPlays) {
  fs::remove(path() / "frame-000000.pose.txt");
  EXPECT_ERROR(open_recording(path()), "frame-000000.pose.txt", "for each frame or for none");
  fs::remove(path() / "frame-000003.pose.txt");
  const auto recording = open_recording(path());
  EXPECT_FALSE(recording->info().has_recorded_poses);
  EXPECT_EQ(recording->info().up_W, Eigen::Vector3d(0, -1, 0));
  EXPECT_FALSE(all_frames(*recording).front().recorded_X_WC);
}

TEST_F(FrameFolder, DamageIsNamed) {
  write("frame-000003.pose.txt", "2 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  EXPECT_ERROR(open_recording(path()), "frame-000003.pose.txt", "not a rigid motion");
  write("frame-000003.pose.txt", "-1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  EXPECT_ERROR(open_recording(path()), "not a rigid motion");
  write("frame-000003.pose.txt", "1 0 0\n");
  EXPECT_ERROR(open_recording(path()), "holds 3 numbers", "4 x 4");
  write("frame-000003.pose.txt", "1 0 0 0\n0 1 zero 0\n0 0 1 0\n0 0 0 1\n");
  EXPECT_ERROR(open_recording(path()), "frame-000003.pose.txt:2:", "'zero' is not a number");
  write("frame-000003.pose.txt", matrix_text(Pose::Identity()));
  for (const char* bad : {"500 0 3\n0 -510 2\n0 0 1", "500 0 3\n0 510 2\n0 0 2", "nan 0 3\n0 510 2\n0 0 1"}) {
    write("camera-intrinsics.txt", bad);
    EXPECT_ERROR(open_recording(path()), "camera-intrinsics.txt", "not a camera matrix");
  }
  fs::remove(path() / "camera-intrinsics.txt");
  EXPECT_ERROR(open_recording(path()), "camera-intrinsics.txt", "no such file");
  write("camera-intrinsics.txt", "500 0 3.5\n0 510 2.5\n0 0 1\n");
  fs::remove(path() / "frame-000003.depth.png");
  EXPECT_ERROR(open_recording(path()), "frame-000003.depth.png", "no such file");
}

TEST_F(FrameFolder, DamagedPicturesAreNamedWhenLoaded) {
  const std::string whole = encoded(".png", depth_image(1000));
  const auto load_second = [&] { all_frames(*open_recording(path())); };
  write("frame-000003.depth.png", "");
  EXPECT_ERROR(load_second(), "frame-000003.depth.png", "is not a picture that can be decoded");
  write("frame-000003.depth.png", "not a picture");
  EXPECT_ERROR(load_second(), "frame-000003.depth.png", "is not a picture that can be decoded");
  write("frame-000003.depth.png", encoded(".png", colour_image(3)));
  EXPECT_ERROR(load_second(), "frame-000003.depth.png", "8 bits and 3 channels");
  write("frame-000003.depth.png", encoded(".png", cv::Mat(5, 8, CV_16UC1, cv::Scalar(3))));
  EXPECT_ERROR(load_second(), "frame-000003.depth.png", "8 x 5 pixels; expected 8 x 6");
}

TEST(RecordingLayout, UnknownFoldersNameWhatWasLookedFor) {
  const test::TemporaryFolder folder;
  EXPECT_ERROR(open_recording(folder.path()), "rgb.txt and depth.txt", "camera-intrinsics.txt", "laser.txt");
  EXPECT_ERROR(open_recording(folder.path() / "none"), "no such folder");
  write_file(folder.path() / "file", "x");
  EXPECT_ERROR(open_recording(folder.path() / "file"), "not a folder");
}

class TumFolder : public ::testing::Test {
 protected:
  TumFolder() {
    make_folder(path() / "rgb");
    make_folder(path() / "depth");
    for (const int i : {0, 1, 2}) {
      write("rgb/" + std::to_string(i) + ".png", encoded(".png", colour_image(20 + i)));
      write("depth/" + std::to_string(i) + ".png", encoded(".png", depth_image(5000 + 10 * i)));
    }
    write("rgb.txt", "# colour\n1305031102.175304 rgb/0.png\n1305031102.211214 rgb/1.png\n1305031102.243211 rgb/2.png\n");
    write("depth.txt", "1305031102.160407 depth/0.png\n1305031102.226738 depth/1.png\n1305031102.300000 depth/2.png\n");
    write("groundtruth.txt",
          "# seconds x y z qx qy qz qw\n1305031102.1700 1 2 3 0 0 0 1\n1305031102.1800 2 2 3 0 0 0 1\n1305031102.2100 4 2 3 0 0 0 1\n");
  }
  void write(const std::string& name, const std::string& bytes) { write_file(folder_.path() / name, bytes); }
  fs::path path() const { return folder_.path(); }

  test::TemporaryFolder folder_;
};

TEST_F(TumFolder, AssociatesByMutualNearestStamp) {
  const auto recording = open_recording(path());
  const StreamInfo& info = recording->info();
  EXPECT_EQ(info.cameras.at("camera").intrinsics.fx, 517.3);
  EXPECT_EQ(info.up_W, Eigen::Vector3d::UnitZ());
  const std::vector<RgbdFrame> frames = all_frames(*recording);
  // The second depth image lies 15.5 ms after the second picture and 16.5 ms before the third; the third is too late for any.
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(frames[0].stamp, 1305031102175304000);
  EXPECT_EQ(frames[1].stamp, 1305031102211214000);
  EXPECT_EQ(frames[0].depth.at<float>(2, 2), 1000 * 0.001f);
  EXPECT_EQ(frames[1].depth.at<float>(2, 2), 1002 * 0.001f);
  ASSERT_TRUE(frames[0].recorded_X_WC);
  EXPECT_NEAR(frames[0].recorded_X_WC->translation().x(), 1.5304, 1e-6);
  ASSERT_TRUE(frames[1].recorded_X_WC);
  EXPECT_EQ(frames[1].recorded_X_WC->translation().x(), 4.0);
}

TEST_F(TumFolder, PosesAreInterpolatedUnlessTheGapIsLong) {
  // The pictures are at .175304 and .211214.
  write("groundtruth.txt", "1305031102.1000 1 2 3 0 0 0 1\n1305031102.2000 2 2 3 0 0 0 1\n1305031102.9000 4 2 3 0 0 0 1\n");
  auto recording = open_recording(path());
  auto frames = all_frames(*recording);
  EXPECT_NEAR(frames.at(0).recorded_X_WC.value().translation().x(), 1.75304, 1e-6);
  EXPECT_EQ(frames.at(1).recorded_X_WC.value().translation().x(), 2.0) << "in the gap, but 11 ms from its edge";
  RecordingConfig config;
  config.association_s = 0.0165;
  config.max_pose_gap_s = 0.05;
  write("groundtruth.txt", "1305031102.1000 1 2 3 0 0 0 1\n1305031102.2000 2 2 3 0 0 0 1\n");
  recording = open_recording(path(), config);
  frames = all_frames(*recording);
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_FALSE(frames[0].recorded_X_WC);
  EXPECT_TRUE(frames[1].recorded_X_WC) << "beyond the end, but near it";
  EXPECT_EQ(recording->remarks().back(),
            "1 frames have no pose: they lie in gaps of groundtruth.txt of more than 0.050000 s (recording.max_pose_gap_s)");
  write("groundtruth.txt", "1305031100 1 2 3 0 0 0 1\n");
  EXPECT_EQ(open_recording(path())->remarks().back(), "2 frames have no pose in groundtruth.txt");
}

TEST_F(TumFolder, CalibrationFilesAndScaleCount) {
  write("calibration.txt", "400 401 4 3 0.1 0.2\n");
  RecordingConfig config;
  config.depth_scale = 1000;
  const auto recording = open_recording(path(), config);
  EXPECT_EQ(recording->info().cameras.at("camera").intrinsics.fy, 401);
  EXPECT_EQ(all_frames(*recording)[0].depth.at<float>(2, 2), 5000 * 0.001f);
  write("calibration.txt", "400 401 4\n");
  EXPECT_ERROR(open_recording(path()), "calibration.txt", "expected 'fx fy cx cy'");
}

TEST_F(TumFolder, FilesOfOneStampAreRefused) {
  write("rgb.txt", "0 rgb/0.png\n0 rgb/1.png\n");
  EXPECT_ERROR(open_recording(path()), "rgb.txt: all 2 files have the stamp 0.000000000; expected the time at which each was taken");
}

TEST_F(TumFolder, DamageIsNamed) {
  write("groundtruth.txt", "1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 0\n");
  EXPECT_ERROR(open_recording(path()), "groundtruth.txt:2:", "not a pose");
  write("groundtruth.txt", "1 0 0 0\n");
  EXPECT_ERROR(open_recording(path()), "groundtruth.txt:1:", "expected 'seconds x y z qx qy qz qw'");
  fs::remove(path() / "groundtruth.txt");
  EXPECT_FALSE(open_recording(path())->info().has_recorded_poses);
  write("depth.txt", "1305031102.160407 depth/7.png\n");
  EXPECT_ERROR(open_recording(path()), "depth.txt:1:", "'depth/7.png' does not exist");
  write("depth.txt", "1305031102.160407 ../../etc/passwd\n");
  EXPECT_ERROR(open_recording(path()), "leaves the folder");
  write("depth.txt", "soon depth/1.png\n");
  EXPECT_ERROR(open_recording(path()), "depth.txt:1:", "'soon' is not a number");
  write("depth.txt", "99 depth/1.png\n");
  EXPECT_ERROR(open_recording(path()), "no colour picture with a depth image");
  fs::remove(path() / "depth.txt");
  EXPECT_ERROR(open_recording(path()), "depth.txt: no such file");
}

TEST(LaserLog, PlaysWithoutACameraAndNamesDamage) {
  const test::TemporaryFolder folder;
  write_file(folder.path() / "laser.txt", "2.5 -1 0.5 0 0.05 30 3 1 0 2\n1.5 -1 0.5 0 0.05 30 1 4\n");
  const auto recording = open_recording(folder.path());
  EXPECT_TRUE(recording->info().cameras.empty());
  EXPECT_EQ(recording->info().duration_s, 1.0);
  EXPECT_EQ(stamp_of(*recording->next()), 1'500'000'000);
  write_file(folder.path() / "laser.txt", "2.5 -1 0.5 0 0.05 30 3 1 0\n");
  EXPECT_ERROR(open_recording(folder.path()), "laser.txt:1:", "announces '3' ranges and holds 2");
  write_file(folder.path() / "laser.txt", "2.5 -1 0.5 0 0.05 30 1 -1\n");
  EXPECT_ERROR(open_recording(folder.path()), "'-1' is not a range");
  write_file(folder.path() / "laser.txt", "2.5 -1\n");
  EXPECT_ERROR(open_recording(folder.path()), "expected seven");
  write_file(folder.path() / "laser.txt", "");
  write_file(folder.path() / "odometry.txt", "1 2 3\n");
  EXPECT_ERROR(open_recording(folder.path()), "odometry.txt:1:", "expected 'seconds x y yaw'");
}

TEST(RecordingStamps, AreExactToTheNanosecond) {
  for (const Stamp stamp : {Stamp{0}, Stamp{1}, Stamp{-1'500'000'001}, Stamp{1305031102'175304123}, Stamp{999'999'999}}) {
    EXPECT_EQ(parse_text_stamp("f", 1, stamp_text(stamp)), stamp);
  }
  EXPECT_EQ(parse_text_stamp("f", 1, "12"), 12'000'000'000);
  EXPECT_EQ(parse_text_stamp("f", 1, "1.5e1"), 15'000'000'000);
  for (const char* bad : {"", "x", "1.2.3", "nan", "1e300", "99999999999999999999", "1.x"})
    EXPECT_ERROR(parse_text_stamp("f", 1, bad), "f:1:");
}

TEST(RecordingNumbers, BeyondTheRangeOfADoubleAreZeroOrInfinite) {
  EXPECT_EQ(parse_text_number("f", 1, "1e-999"), 0.0);
  EXPECT_EQ(parse_text_number("f", 1, "-1e999"), -std::numeric_limits<double>::infinity());
  EXPECT_EQ(parse_text_number("f", 1, "+2.5"), 2.5);
  EXPECT_ERROR(parse_text_number("f", 3, "2,5"), "f:3: '2,5' is not a number");
}

// Two frames, 1 and 2, as SceneNN's playback tool unpacks them.
class SceneNnFolder : public FrameFolder {
 protected:
  SceneNnFolder() {
    fs::remove_all(path());
    for (const int number : {1, 2}) {
      const std::string digits = "0000" + std::to_string(number) + ".png";
      fs::create_directories(path() / "image");
      fs::create_directories(path() / "depth");
      write("image/image" + digits, encoded(".png", colour_image(10 + number)));
      write("depth/depth" + digits, encoded(".png", depth_image(1234 + number)));
    }
    write("timestamp.txt", "1 1000000 1000500\n2 1033367 1033800\n");
    write("trajectory.log", "0 0 1\n" + matrix_text(pose(0)) + "1 1 2\n" + matrix_text(pose(1)));
  }
  // The world's y points down.
  static Pose pose(int index) {
    Pose pose = Pose::Identity();
    pose.translation() = Eigen::Vector3d(index, 2, 3);
    return pose;
  }
};

TEST_F(SceneNnFolder, YieldsFramesWithStampsAndPoses) {
  const auto recording = open_recording(path());
  const StreamInfo& info = recording->info();
  EXPECT_TRUE(info.has_recorded_poses);
  EXPECT_EQ(info.up_W, -Eigen::Vector3d::UnitY());
  EXPECT_EQ(info.cameras.at("camera").intrinsics.fx, 544.47329) << "the dataset's Asus camera";
  EXPECT_TRUE(recording->remarks().empty());
  const std::vector<RgbdFrame> frames = all_frames(*recording);
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(frames[0].stamp, 1'000'000'000);
  EXPECT_EQ(frames[1].stamp, 1'033'367'000);
  EXPECT_EQ(frames[1].recorded_X_WC->matrix(), pose(1).matrix());
  EXPECT_EQ(frames[1].depth.at<float>(3, 3), 1236 * 0.001f);
  EXPECT_EQ(frames[1].depth.at<float>(0, 1), 0.0f) << "65535 is invalid";
  EXPECT_EQ(frames[1].colour.at<cv::Vec3b>(0, 0)[0], 12);
}

TEST_F(SceneNnFolder, ReadsItsIntrinsicsAndExactStamps) {
  fs::create_directories(path() / "intrinsic");
  write("intrinsic/asus.ini", "depth_width 8\ndepth_height 6\nfx 50\nfy 51\n");
  write("stamps.txt", "1 1.000000001\n2 1.5\n");
  const auto recording = open_recording(path());
  const Intrinsics& k = recording->info().cameras.at("camera").intrinsics;
  EXPECT_EQ(std::tuple(k.fx, k.fy, k.cx, k.cy), std::tuple(50, 51, 4, 3));
  EXPECT_EQ(all_frames(*recording)[0].stamp, 1'000'000'001);
  write("intrinsic/asus.ini", "fx 50\n");
  EXPECT_ERROR(open_recording(path()), "asus.ini", "has no fy above 0");
  write("stamps.txt", "1 1\n");
  write("intrinsic/asus.ini", "depth_width 8\ndepth_height 6\nfx 50\nfy 51\n");
  EXPECT_ERROR(open_recording(path()), "stamps.txt", "no stamp for frame 2");
}

TEST_F(SceneNnFolder, FramesOfOneStampAreRefused) {
  write("timestamp.txt", "1 0 0\n2 0 0\n");
  EXPECT_ERROR(open_recording(path()), "timestamp.txt: all 2 frames have the stamp 0.000000000; expected the time", "or no such file");
  write("stamps.txt", "1 7\n2 7\n");
  EXPECT_ERROR(open_recording(path()), "stamps.txt: all 2 frames have the stamp 7.000000000");
}

TEST_F(SceneNnFolder, SaysWhatIsLeftOutAndWhatIsDamaged) {
  fs::remove(path() / "depth/depth00002.png");
  EXPECT_EQ(open_recording(path())->remarks().front(), "1 pictures without a depth image are left out");
  write("depth/depth00002.png", encoded(".png", depth_image(1)));
  write("trajectory.log", "1 1 2\n" + matrix_text(pose(1)));
  auto recording = open_recording(path());
  EXPECT_EQ(recording->info().frame_count, 1);
  EXPECT_EQ(recording->remarks().front(), "1 frames that trajectory.log does not name are left out");
  write("trajectory.log", "0 0 1\nnan nan nan nan\nnan nan nan nan\nnan nan nan nan\n0 0 0 1\n1 1 2\n" + matrix_text(pose(1)));
  EXPECT_EQ(open_recording(path())->lost_frames(), 1);
  write("trajectory.log", "0 0 1\n1 0 0 0\n0 1 0\n0 0 1 0\n0 0 0 1\n");
  EXPECT_ERROR(open_recording(path()), "trajectory.log:3:", "expected a row of a 4 x 4 matrix");
  write("trajectory.log", "0 0 1\n1 0 0 0\n");
  EXPECT_ERROR(open_recording(path()), "trajectory.log:1:", "is no entry of a trajectory");
  write("trajectory.log", "0 0 1\n2 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  EXPECT_ERROR(open_recording(path()), "trajectory.log:1:", "not a rigid motion");
  fs::remove(path() / "trajectory.log");
  EXPECT_FALSE(open_recording(path())->info().has_recorded_poses);
  write("timestamp.txt", "1 1000000 1000500\n");
  EXPECT_ERROR(open_recording(path()), "timestamp.txt", "no line for frame 2");
  write("timestamp.txt", "1 soon 1\n");
  EXPECT_ERROR(open_recording(path()), "timestamp.txt:1:", "'soon'");
  fs::remove(path() / "timestamp.txt");
  EXPECT_EQ(all_frames(*open_recording(path()))[0].stamp, 33'333'333) << "numbers at frame_rate_hz";
}

TEST_F(FrameFolder, PlacesAndTurnsWhatTheRecordingDoesNotSay) {
  fs::remove(path() / "frame-000000.pose.txt");
  fs::remove(path() / "frame-000003.pose.txt");
  RecordingConfig config;
  config.start = {1, 2, 90};
  config.camera_mount = {0.1, 0, 1.4, 0, 45, 0};
  config.rotate_deg = 180;
  const auto recording = open_recording(path(), config);
  EXPECT_TRUE(recording->info().X_WB_start.isApprox(make_upright_pose(1, 2, 0, std::numbers::pi / 2)));
  const StreamInfo::Camera& camera = recording->info().cameras.at("camera");
  EXPECT_TRUE(camera.X_BC.linear().col(2).isApprox(Eigen::Vector3d(std::sqrt(0.5), 0, -std::sqrt(0.5)))) << "45 deg down";
  EXPECT_EQ(camera.intrinsics.cx, 8 - 1 - 3.5);
  const std::vector<RgbdFrame> frames = all_frames(*recording);
  EXPECT_EQ(frames[0].depth.at<float>(5, 7), 0.0f) << "the stored picture's first pixel";
  EXPECT_EQ(frames[0].depth.at<float>(0, 0), 1234 * 0.001f);
}

// Recorded poses are those of the camera that took the stored pictures.
TEST_F(FrameFolder, TurnsRecordedPosesWithThePictures) {
  const Pose stored = *all_frames(*open_recording(path()))[1].recorded_X_WC;
  RecordingConfig config;
  config.rotate_deg = 90;
  const auto recording = open_recording(path(), config);
  const std::vector<RgbdFrame> frames = all_frames(*recording);
  const Intrinsics& k = recording->info().cameras.at("camera").intrinsics;
  EXPECT_EQ(std::tuple(k.width, k.height, k.fx, k.fy), std::tuple(6, 8, 510, 500));
  // Stored pixel (2, 5) lies at (6 - 1 - 5, 2) after a quarter turn.
  const Eigen::Vector3d before((2 - 3.5) / 500, (5 - 2.5) / 510, 1), after((0 - k.cx) / k.fx, (2 - k.cy) / k.fy, 1);
  EXPECT_TRUE((*frames[1].recorded_X_WC * after).isApprox(stored * before, 1e-9));
}

TEST_F(FrameFolder, DepthInFloatMetresAndWithOtherInvalidValues) {
  cv::Mat metres(6, 8, CV_32FC1, cv::Scalar(1.2346));
  metres.at<float>(0, 0) = std::numeric_limits<float>::quiet_NaN();
  metres.at<float>(0, 1) = -1.0f;
  metres.at<float>(0, 2) = 70.0f;
  write("frame-000000.depth.png", encoded(".tiff", metres));
  RecordingConfig config;
  config.depth_invalid = {1237};
  const std::vector<RgbdFrame> frames = all_frames(*open_recording(path(), config));
  EXPECT_EQ(frames[0].depth.at<float>(3, 3), 1235 * 0.001f);
  for (const int u : {0, 1, 2}) EXPECT_EQ(frames[0].depth.at<float>(0, u), 0.0f) << u;
  EXPECT_EQ(cv::countNonZero(frames[1].depth), 0) << "all of it is 1237";
}

TEST(RecordingConfig, ChecksItsDirections) {
  RecordingConfig config;
  EXPECT_ERROR(read_config_text("up: [0, 0]", "c.yaml", [&](Fields& f) { config.visit(f); }), "c.yaml:1:", "'up' is not a direction");
  for (const auto& wrong : std::vector<std::pair<std::string, std::string>>{{"start: [1, 2]", "expected x_m, y_m, yaw_deg"},
                                                                            {"camera_mount: [1]", "pitch_deg"},
                                                                            {"rotate_deg: 45", "expected 0, 90, 180 or 270"},
                                                                            {"clock: {laser_s: x}", "laser_s"},
                                                                            {"bag: {preset: turtlebot}", "agiprobot"}}) {
    config = {};
    EXPECT_ERROR(read_config_text(wrong.first, "c.yaml", [&](Fields& f) { config.visit(f); }), "c.yaml:1:", wrong.second);
  }
  config = {};
  read_config_text("bag: {preset: agiprobot, depth_topic: /mine}", "c.yaml", [&](Fields& f) { config.visit(f); });
  EXPECT_EQ(config.bag.colour_topic, "/camera/rgb/image_raw");
  EXPECT_EQ(config.bag.depth_topic, "/mine") << "keys go over the preset";
  config = {};
  EXPECT_ERROR(read_config_text("intrinsics: [1]", "c.yaml", [&](Fields& f) { config.visit(f); }),
               "has 1 numbers; expected fx, fy, cx, cy");
}

TEST(RealRecordings, SevenScenesPlays) {
  WARETWIN_NEED_DATA("rgbd_7scenes");
  const auto recording = open_recording(test::shared_data("rgbd_7scenes"));
  EXPECT_EQ(recording->info().frame_count, 60);
  EXPECT_EQ(recording->info().up_W, Eigen::Vector3d(0, -1, 0));
  EXPECT_EQ(recording->info().cameras.at("camera").intrinsics.width, 640);
  auto event = recording->next();
  auto frame = std::get<RgbdFrame>(*event);
  load_pictures(frame);
  EXPECT_EQ(frame.colour.size(), cv::Size(640, 480));
  EXPECT_GT(cv::countNonZero(frame.depth), 640 * 480 / 2);
  double farthest = 0;
  cv::minMaxLoc(frame.depth, nullptr, &farthest);
  EXPECT_LT(farthest, 12.0);
  int frames = 1;
  Stamp last = stamp_of(*event);
  while ((event = recording->next())) {
    EXPECT_GT(stamp_of(*event), last);
    last = stamp_of(*event);
    ++frames;
  }
  EXPECT_EQ(frames, 60);
}

TEST(RealRecordings, Sun3dPlays) {
  WARETWIN_NEED_DATA("rgbd_sun3d");
  const auto recording = open_recording(test::shared_data("rgbd_sun3d"));
  EXPECT_EQ(recording->info().frame_count, 5);
  EXPECT_EQ(recording->info().up_W, Eigen::Vector3d(0, 1, 0));
  for (const RgbdFrame& frame : all_frames(*recording)) {
    EXPECT_GT(cv::countNonZero(frame.depth), 640 * 480 / 2);
    ASSERT_TRUE(frame.recorded_X_WC);
    EXPECT_NEAR(frame.recorded_X_WC->linear().determinant(), 1.0, 1e-9);
  }
}

}  // namespace
}  // namespace waretwin

// The pipeline with stages that only write down what they were given.
#include "mapper/mapper.h"

#include <gtest/gtest.h>

#include <memory>
#include <utility>

#include "core/error.h"
#include "mapper/integrate/tsdf_volume.h"

namespace waretwin {
namespace {

constexpr int kWidth = 8;
constexpr int kHeight = 6;

struct Log {
  std::vector<Stamp> detected;
  std::vector<Pose> integrated_at;
  std::vector<std::vector<std::int32_t>> labels;
};

class FixedLocaliser final : public Localiser {
 public:
  void add(const OdometryReading& reading) override { X_WB_ = reading.X_OB; }
  void add(const LaserScan&) override {}
  std::optional<Pose> pose_at(const RgbdFrame& frame) override { return frame.recorded_X_WC ? frame.recorded_X_WC : X_WB_; }
  std::optional<Pose> current_pose() const override { return X_WB_; }

 private:
  std::optional<Pose> X_WB_;
};

class OneBoxDetector final : public Detector {
 public:
  explicit OneBoxDetector(Log& log) : log_(log) {}
  std::vector<Detection> detect(const RgbdFrame& frame) override {
    log_.detected.push_back(frame.stamp);
    return {{.class_name = "box", .box = {1, 1, 2, 2}, .score = 1.0f}};
  }

 private:
  Log& log_;
};

// Two objects that share pixel 2.
class TwoObjectsSegmenter final : public Segmenter {
 public:
  Segmentation segment(const RgbdFrame&, const Intrinsics&, const std::vector<Detection>& detections, const Pose&) override {
    Segmentation result;
    result.objects.resize(2);
    result.objects[0] = {.detection = detections[0], .pixels = {1, 2}, .points_W = {}, .cuboid = {}, .hsv = {}};
    result.objects[1] = {.detection = detections[0], .pixels = {2, 3}, .points_W = {}, .cuboid = {}, .hsv = {}};
    result.rejected["made up"] = 1;
    return result;
  }
};

class CountingAssociator final : public Associator {
 public:
  std::vector<int> associate(const std::vector<SegmentedObject>&, const AssociationContext& context, ObjectList&) override {
    frame_ids.push_back(context.frame_id);
    return {7, 8};
  }
  std::vector<int> frame_ids;
};

class LoggingIntegrator final : public Integrator {
 public:
  explicit LoggingIntegrator(Log& log) : log_(log) {}
  void integrate(const RgbdFrame&, const Intrinsics&, const std::vector<std::int32_t>& labels, const Pose& X_WC, TsdfVolume&) override {
    log_.labels.push_back(labels);
    log_.integrated_at.push_back(X_WC);
  }

 private:
  Log& log_;
};

Stages logging_stages(Log& log) {
  Stages stages;
  stages.localiser = std::make_unique<FixedLocaliser>();
  stages.detector = std::make_unique<OneBoxDetector>(log);
  stages.segmenter = std::make_unique<TwoObjectsSegmenter>();
  stages.associator = std::make_unique<CountingAssociator>();
  stages.integrator = std::make_unique<LoggingIntegrator>(log);
  return stages;
}

StreamInfo one_camera() {
  StreamInfo info;
  info.cameras["camera"].intrinsics = Intrinsics::checked(kWidth, kHeight, 8, 8, 3.5, 2.5);
  info.cameras["camera"].X_BC = make_upright_pose(0, 0, 1, 0);
  return info;
}

RgbdFrame frame_at(Stamp stamp) {
  RgbdFrame frame;
  frame.stamp = stamp;
  frame.sensor = "camera";
  frame.colour = cv::Mat::zeros(kHeight, kWidth, CV_8UC3);
  frame.depth = cv::Mat::ones(kHeight, kWidth, CV_32FC1);
  return frame;
}

OdometryReading odometry_at(Stamp stamp, double x) {
  OdometryReading reading;
  reading.stamp = stamp;
  reading.X_OB = make_upright_pose(x, 0, 0, 0);
  return reading;
}

TEST(Mapper, KeepsTheMappingRateAndCountsWhatItDrops) {
  Log log;
  MapperConfig config = MapperConfig::make("paper");
  config.rate_hz = 1.0;
  Mapper mapper(config, logging_stages(log), one_camera());
  mapper.consume(odometry_at(0, 0.0));
  int loaded = 0;
  for (int i = 0; i < 46; ++i) {  // 15 Hz, 3 s and a frame
    RgbdFrame frame = frame_at(from_seconds(i / 15.0));
    const RgbdFrame pictures = frame;
    frame.colour.release();
    frame.depth.release();
    frame.load = [&loaded, pictures](RgbdFrame& late) {
      ++loaded;
      late.colour = pictures.colour;
      late.depth = pictures.depth;
    };
    mapper.consume(std::move(frame));
  }
  const ObjectMap map = mapper.finish();
  EXPECT_EQ(log.detected, (std::vector<Stamp>{0, from_seconds(1), from_seconds(2), from_seconds(3)}));
  EXPECT_EQ(map.frames_seen, 46);
  EXPECT_EQ(map.frames_dropped_by_rate, 42);
  EXPECT_EQ(map.frames.size(), 4u);
  EXPECT_EQ(loaded, 4) << "dropped frames must not be loaded";
}

TEST(Mapper, EachCameraHasTheMappingRateForItself) {
  Log log;
  StreamInfo info = one_camera();
  info.cameras["rear"] = info.cameras.at("camera");
  MapperConfig config;
  config.rate_hz = 1.0;
  Mapper mapper(config, logging_stages(log), info);
  mapper.consume(odometry_at(0, 0));
  for (int i = 0; i < 20; ++i) {
    RgbdFrame front = frame_at(i * 100'000'000), rear = frame_at(i * 100'000'000);
    rear.sensor = "rear";
    mapper.consume(std::move(front));
    mapper.consume(std::move(rear));
  }
  EXPECT_EQ(mapper.map().frames.size(), 4u);
  EXPECT_EQ(mapper.map().frames_dropped_by_rate, 36);
}

TEST(Mapper, MapsEveryFrameAtRateZero) {
  Log log;
  MapperConfig config = MapperConfig::make("best");
  Mapper mapper(config, logging_stages(log), one_camera());
  mapper.consume(odometry_at(0, 0.0));
  for (int i = 0; i < 5; ++i) mapper.consume(frame_at(i));
  EXPECT_EQ(mapper.map().frames.size(), 5u);
  EXPECT_EQ(mapper.map().frames[4].frame_id, 4);
}

TEST(Mapper, CountsFramesWithoutAPose) {
  Log log;
  Mapper mapper(MapperConfig::make("best"), logging_stages(log), one_camera());
  mapper.consume(frame_at(0));
  EXPECT_EQ(mapper.map().frames_without_pose, 1);
  EXPECT_TRUE(mapper.map().frames.empty());
  EXPECT_TRUE(log.detected.empty());
}

TEST(Mapper, LabelsPixelsWithMapIdsTheEarlierObjectFirst) {
  Log log;
  Mapper mapper(MapperConfig::make("best"), logging_stages(log), one_camera());
  mapper.consume(odometry_at(0, 0.0));
  mapper.consume(frame_at(1));
  ASSERT_EQ(log.labels.size(), 1u);
  ASSERT_EQ(log.labels[0].size(), static_cast<std::size_t>(kWidth * kHeight));
  EXPECT_EQ(std::vector<std::int32_t>(log.labels[0].begin(), log.labels[0].begin() + 5), (std::vector<std::int32_t>{0, 7, 7, 8, 0}));
  EXPECT_EQ(mapper.map().rejected.at("made up"), 1);
}

TEST(Mapper, PutsTheCameraOnTheVehicle) {
  Log log;
  Mapper mapper(MapperConfig::make("best"), logging_stages(log), one_camera());
  mapper.consume(odometry_at(0, 2.0));
  mapper.consume(frame_at(1));
  ASSERT_EQ(log.integrated_at.size(), 1u);
  EXPECT_TRUE(log.integrated_at[0].translation().isApprox(Eigen::Vector3d(2, 0, 1)));
}

TEST(Mapper, TurnsARecordingUpright) {
  Log log;
  StreamInfo info = one_camera();
  info.cameras["camera"].X_BC = Pose::Identity();
  info.up_W = -Eigen::Vector3d::UnitY();
  Mapper mapper(MapperConfig::make("best"), logging_stages(log), info);
  RgbdFrame frame = frame_at(0);
  frame.recorded_X_WC = Pose(Eigen::Translation3d(0, -1, 0));  // a metre above the recording's origin
  mapper.consume(std::move(frame));
  ASSERT_EQ(log.integrated_at.size(), 1u);
  EXPECT_NEAR(log.integrated_at[0].translation().z(), 1.0, 1e-12);
  const ObjectMap map = mapper.finish();
  EXPECT_TRUE((map.X_RW * Eigen::Vector3d(0, 0, 1)).isApprox(Eigen::Vector3d(0, -1, 0)));
  ASSERT_EQ(map.trajectory.size(), 1u);
  EXPECT_TRUE((map.X_RW * map.trajectory[0].X_WB).translation().isApprox(Eigen::Vector3d(0, -1, 0)));
}

TEST(Mapper, RefusesStampsThatGoBack) {
  Log log;
  Mapper mapper(MapperConfig::make("best"), logging_stages(log), one_camera());
  mapper.consume(odometry_at(10, 0.0));
  EXPECT_THROW(mapper.consume(odometry_at(9, 0.0)), Error);
}

TEST(Mapper, RefusesFramesOfACameraThatTheStreamDoesNotName) {
  Log log;
  Mapper mapper(MapperConfig::make("best"), logging_stages(log), one_camera());
  RgbdFrame frame = frame_at(0);
  frame.sensor = "other";
  EXPECT_THROW(mapper.consume(std::move(frame)), Error);
}

}  // namespace
}  // namespace waretwin

#include "sim/simulated_stream.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <opencv2/core.hpp>
#include <tuple>
#include <variant>

#include "core/error.h"
#include "tests/sim/fixtures.h"

namespace waretwin {
namespace {

Scenario drive() {
  Scenario scenario;
  scenario.name = "drive";
  scenario.seed = 3;
  scenario.sensors = SensorsConfig::of_the_paper();
  scenario.sensors.cameras.at("camera").width = 160;
  scenario.sensors.cameras.at("camera").height = 90;
  Waypoint from, to;
  from.x_m = -3;
  to.x_m = -2;
  to.y_m = 0.2;
  scenario.robot.route = {from, to};
  return scenario;
}

std::shared_ptr<const Scene> hall() {
  static const auto scene = std::make_shared<const Scene>(fixtures::busy_hall(8));
  return scene;
}

std::vector<SensorEvent> all_events(SimulatedStream& stream) {
  std::vector<SensorEvent> events;
  while (auto event = stream.next()) events.push_back(std::move(*event));
  return events;
}

TEST(SimulatedStream, EventsInOrderAtTheirRates) {
  SimulatedStream stream(drive(), hall(), SimulationConfig());
  const double duration = stream.duration_s();
  const auto events = all_events(stream);
  int odometry = 0, scans = 0, frames = 0;
  std::tuple<Stamp, std::size_t> before{-1, 0};
  for (const SensorEvent& event : events) {
    const std::tuple<Stamp, std::size_t> now{stamp_of(event), event.index()};  // equal stamps: odometry, laser, camera
    EXPECT_LT(before, now);
    before = now;
    odometry += std::holds_alternative<OdometryReading>(event) ? 1 : 0;
    scans += std::holds_alternative<LaserScan>(event) ? 1 : 0;
    frames += std::holds_alternative<RgbdFrame>(event) ? 1 : 0;
  }
  EXPECT_EQ(odometry, static_cast<int>(std::floor(duration * 50)) + 1);
  EXPECT_EQ(scans, static_cast<int>(std::floor((duration - 0.03) * 25)) + 1);
  EXPECT_EQ(frames, static_cast<int>(std::floor(duration * 15)) + 1);
  EXPECT_EQ(stream.info().frame_count, frames);
  EXPECT_EQ(stream.frames_rendered(), 0);  // nobody loaded a picture
  EXPECT_FALSE(stream.next().has_value());
}

TEST(SimulatedStream, InfoHoldsTheCalibration) {
  const Scenario scenario = drive();
  const SimulatedStream stream(scenario, hall(), SimulationConfig());
  const StreamInfo& info = stream.info();
  EXPECT_EQ(info.source, "drive");
  EXPECT_TRUE(info.has_odometry);
  EXPECT_FALSE(info.has_recorded_poses);
  EXPECT_TRUE(info.cameras.at("camera").X_BC.isApprox(scenario.sensors.cameras.at("camera").mount.X_BC()));
  EXPECT_EQ(info.cameras.at("camera").intrinsics.width, 160);
  EXPECT_TRUE(info.lasers.at("laser").X_BL.isApprox(scenario.sensors.lasers.at("laser").mount.X_BL()));
  EXPECT_TRUE(info.X_WB_start.isApprox(stream.true_X_WB(0)));
  EXPECT_DOUBLE_EQ(*info.duration_s, stream.duration_s());
}

TEST(SimulatedStream, DroppedFramesChangeNothing) {
  SimulatedStream every(drive(), hall(), SimulationConfig()), some(drive(), hall(), SimulationConfig());
  int frames = 0;
  while (true) {
    auto a = every.next(), b = some.next();
    ASSERT_EQ(a.has_value(), b.has_value());
    if (!a) break;
    if (auto* scan = std::get_if<LaserScan>(&*a)) {
      EXPECT_EQ(scan->ranges, std::get<LaserScan>(*b).ranges);
    }
    auto* frame = std::get_if<RgbdFrame>(&*a);
    if (frame == nullptr) continue;
    load_pictures(*frame);
    EXPECT_EQ(every.last_frame_truth().stamp, frame->stamp);
    EXPECT_FALSE(every.last_frame_truth().instances.empty());
    EXPECT_TRUE(every.last_frame_truth().X_WC.isApprox(every.true_X_WB(frame->stamp) * every.info().cameras.at("camera").X_BC));
    if (frames++ % 7 != 3) continue;
    auto& other = std::get<RgbdFrame>(*b);
    EXPECT_TRUE(some.last_frame_truth().instances.empty());
    load_pictures(other);
    EXPECT_EQ(std::memcmp(frame->colour.data, other.colour.data, frame->colour.total() * 3), 0);
    EXPECT_EQ(std::memcmp(frame->depth.data, other.depth.data, frame->depth.total() * 4), 0);
  }
  EXPECT_EQ(every.frames_rendered(), frames);
  EXPECT_LT(some.frames_rendered(), frames);
  EXPECT_GT(every.last_frame_ms(), 0.0);
}

TEST(SimulatedStream, DepthIsWholeMillimetresWithinTheRange) {
  SimulatedStream stream(drive(), hall(), SimulationConfig());
  while (auto event = stream.next()) {
    auto* frame = std::get_if<RgbdFrame>(&*event);
    if (frame == nullptr) continue;
    load_pictures(*frame);
    EXPECT_EQ(frame->colour.type(), CV_8UC3);
    const cv::Mat again = depth_from_millimetres(depth_to_millimetres(frame->depth));
    EXPECT_EQ(std::memcmp(frame->depth.data, again.data, again.total() * 4), 0);
    int measured = 0;
    const cv::Mat& truth = stream.last_frame_truth().ideal_depth;
    for (int v = 0; v < 90; ++v) {
      for (int u = 0; u < 160; ++u) {
        const float z = frame->depth.at<float>(v, u);
        if (z == 0.0f) continue;
        ++measured;
        ASSERT_GE(z, 0.5f);
        ASSERT_LE(z, 3.86f);
        ASSERT_NEAR(z, truth.at<float>(v, u), 0.06);
      }
    }
    EXPECT_GT(measured, 2000);
    break;
  }
}

TEST(SimulatedStream, UnrectifiedFramesAreInTheLensThroughout) {
  Scenario scenario = drive();
  CameraConfig& camera = scenario.sensors.cameras.at("camera");
  camera.colour.rectify = false;
  SimulatedStream stream(scenario, hall(), SimulationConfig());
  EXPECT_EQ(stream.info().cameras.at("camera").intrinsics.fx, camera.colour_lens().intrinsics().fx);
  EXPECT_LT(stream.info().cameras.at("camera").intrinsics.fx, camera.intrinsics().fx);
  while (auto event = stream.next()) {
    auto* frame = std::get_if<RgbdFrame>(&*event);
    if (frame == nullptr) continue;
    load_pictures(*frame);
    int measured = 0, off = 0;
    for (int v = 0; v < 90; ++v) {
      for (int u = 0; u < 160; ++u) {
        const float z = frame->depth.at<float>(v, u);
        if (z == 0.0f) continue;
        ++measured;
        off += std::abs(z - stream.last_frame_truth().ideal_depth.at<float>(v, u)) > 0.03f ? 1 : 0;
      }
    }
    EXPECT_GT(measured, 2000);
    EXPECT_LT(off, measured / 50);
    break;
  }
}

TEST(SimulatedStream, TruthDepthAndNoColour) {
  SimulationConfig config;
  config.truth_depth = true;
  config.colour = false;
  SimulatedStream stream(drive(), hall(), config);
  while (auto event = stream.next()) {
    auto* frame = std::get_if<RgbdFrame>(&*event);
    if (frame == nullptr) continue;
    load_pictures(*frame);
    EXPECT_EQ(cv::norm(frame->colour), 0.0);
    EXPECT_LE(cv::norm(frame->depth, stream.last_frame_truth().ideal_depth, cv::NORM_INF), 0.000501);
    break;
  }
}

// The hall of the other tests with a low box for a vehicle, as long as it and 0.3 m high.
std::shared_ptr<const Scene> hall_with_vehicle() {
  Scene scene = *hall();
  const int box = fixtures::add_mesh(scene, fixtures::unit_box(), fixtures::add_material(scene, {0.5f, 0.5f, 0.5f}));
  scene.vehicle = {fixtures::add_instance(scene, box, fixtures::placed({-0.45f, -0.3f, 0.0f}, {0.9f, 0.6f, 0.25f}))};
  return std::make_shared<const Scene>(scene);
}

TEST(SimulatedStream, TheVehicleStandsInItsSensorsView) {
  Scenario scenario = drive();
  scenario.sensors.cameras.at("camera").mount.pitch_deg = 60;
  scenario.sensors.lasers.at("laser").mount.z_m = 0.2;  // in the middle of the box
  SimulationConfig config;
  config.colour = false;
  config.truth_depth = true;
  config.max_frames = 8;
  SimulatedStream with(scenario, hall_with_vehicle(), config), without(scenario, hall(), config);
  EXPECT_FALSE(without.info().own_body_B);
  ASSERT_TRUE(with.info().own_body_B);
  EXPECT_NEAR(with.info().own_body_B->max().z(), 0.28, 1e-6);
  std::vector<SensorEvent> events = all_events(with);
  RgbdFrame last = std::get<RgbdFrame>(events.back());  // on the move
  load_pictures(last);
  const FrameTruth truth = with.last_frame_truth();
  const StreamInfo::Camera& camera = with.info().cameras.at("camera");
  int on_vehicle = 0;
  for (int v = 0; v < last.depth.rows; ++v) {
    for (int u = 0; u < last.depth.cols; ++u) {
      const Eigen::Vector3d ray_B = camera.X_BC.linear() * camera.intrinsics.ray(u, v);
      // Where the pixel's ray meets the box's upper side, at 0.25 m.
      const double z = (0.25 - camera.X_BC.translation().z()) / ray_B.z();
      const Eigen::Vector3d p_B = camera.X_BC.translation() + z * ray_B;
      if (z <= 0 || std::abs(p_B.x()) > 0.44 || std::abs(p_B.y()) > 0.29) continue;
      EXPECT_NEAR(last.depth.at<float>(v, u), z, 0.002) << u << ", " << v;
      ++on_vehicle;
    }
  }
  EXPECT_GT(on_vehicle, 100);
  for (const SensorEvent& event : events) {
    const auto* scan = std::get_if<LaserScan>(&event);
    if (scan == nullptr) continue;
    // It looks out of the inside of a box.
    for (const float range : scan->ranges) EXPECT_TRUE(range > 0.0f && range < 1.3f) << range;
  }
}

TEST(SimulatedStream, MountsErrAndOnlyTheTruthKnows) {
  Scenario scenario = drive();
  Mount& mount = scenario.sensors.cameras.at("camera").mount;
  mount.bracket.angle_sigma_deg = 1.0;
  scenario.sensors.lasers.at("laser").mount.vibration = {.angle_rms_deg = 0.5};
  SimulationConfig config;
  config.colour = false;
  config.max_frames = 12;
  SimulatedStream stream(scenario, hall(), config);
  EXPECT_EQ(stream.info().cameras.at("camera").X_BC.matrix(), mount.X_BC().matrix());
  EXPECT_EQ(stream.true_X_WL("laser", 0).matrix(), (stream.true_X_WB(0) * stream.info().lasers.at("laser").X_BL).matrix());  // it stands
  Stamp last = 0;
  double most = 0.0;
  while (auto event = stream.next()) {
    last = stamp_of(*event);
    const Pose X = (stream.true_X_WB(last) * stream.info().lasers.at("laser").X_BL).inverse() * stream.true_X_WL("laser", last);
    most = std::max(most, std::abs(Eigen::AngleAxisd(X.linear()).angle()));
  }
  EXPECT_GT(most, to_radians(0.3));  // it shakes on the way
  EXPECT_EQ(stream.last_frame_truth().X_WC.matrix(), stream.true_X_WC("camera", stream.last_frame_truth().stamp).matrix());
  const Pose off = (stream.true_X_WB(last) * mount.X_BC()).inverse() * stream.true_X_WC("camera", last);
  EXPECT_GT(std::abs(Eigen::AngleAxisd(off.linear()).angle()), to_radians(0.1));
  EXPECT_THROW(stream.true_X_WC("none", 0), Error);
  EXPECT_THROW(stream.true_X_WL("none", 0), Error);
}

TEST(SimulatedStream, EndsAfterTheFramesAskedFor) {
  SimulationConfig config;
  config.max_frames = 4;
  SimulatedStream stream(drive(), hall(), config);
  EXPECT_EQ(stream.info().frame_count, 4);
  EXPECT_NEAR(*stream.info().duration_s, 0.2, 1e-9);
  const auto events = all_events(stream);
  EXPECT_TRUE(std::holds_alternative<RgbdFrame>(events.back()));
  EXPECT_EQ(std::count_if(events.begin(), events.end(), [](const SensorEvent& e) { return std::holds_alternative<RgbdFrame>(e); }), 4);
}

TEST(SimulatedStream, AFrameOutlivesItsStream) {
  RgbdFrame frame;
  {
    SimulatedStream stream(drive(), hall(), SimulationConfig());
    while (auto event = stream.next()) {
      if (auto* f = std::get_if<RgbdFrame>(&*event)) {
        frame = *f;
        break;
      }
    }
    stream.next();
  }
  load_pictures(frame);
  EXPECT_EQ(frame.colour.cols, 160);
}

TEST(SimulatedStream, RejectsAnEmptyRoute) {
  Scenario scenario = drive();
  scenario.robot.route.clear();
  EXPECT_THROW(SimulatedStream(scenario, hall(), SimulationConfig()), Error);
}

}  // namespace
}  // namespace waretwin

// What a stereo camera sees against closed forms, and what it reads of it.
#include "sim/stereo_camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <opencv2/core.hpp>
#include <utility>

#include "core/parallel.h"
#include "sim/depth_camera.h"
#include "tests/sim/fixtures.h"
#include "tests/support/sample_statistics.h"

namespace waretwin {
namespace {

using fixtures::add_instance;
using fixtures::add_material;
using fixtures::add_mesh;
using fixtures::caster_of;
using fixtures::looking;
using fixtures::placed;

CameraConfig d435() { return CameraConfig::make("realsense_d435"); }

CameraConfig quiet() {
  CameraConfig camera = d435();
  auto& s = camera.stereo;
  s.occlusion = s.fattening = s.texture = s.noise = s.calibration = s.quantisation = false;
  return camera;
}

struct Rig {
  std::shared_ptr<const RayCaster> caster;
  CameraConfig camera;
  Surfaces surfaces;
  StereoModel model;

  Rig(Scene scene, const CameraConfig& config, std::uint64_t seed = 1)
      : caster(caster_of(std::move(scene))), camera(config), surfaces(caster), model(config, seed, "camera") {}
  StereoSignal look(const Pose& X_WD, Stamp moment = 0) const { return StereoCamera(caster, surfaces, camera).look(X_WD, moment); }
  cv::Mat read(const Pose& X_WD, Stamp stamp = 0) const { return model.read(look(X_WD), stamp); }
};

// A wall across the x axis that fills the picture.
int add_wall(Scene& scene, float x, int material) {
  Mesh wall;
  fixtures::add_quad(wall, {x, -20, -19}, {x, -20, 21}, {x, 20, 21}, {x, 20, -19});
  return add_instance(scene, add_mesh(scene, wall, material));
}

TEST(StereoCamera, PlaneAndCornerAreExact) {
  const Rig rig(fixtures::room(-3, 3, -2, 2, 2.5), quiet());
  for (const Pose& X_WD : {looking({0, 0, 1.4}, 0.0, 0.8), looking({1.2, 0.5, 1.0}, 0.6, 0.2)}) {
    const StereoSignal signal = rig.look(X_WD);
    const cv::Mat read = rig.model.read(signal, 0);
    const Intrinsics lens = rig.camera.depth_lens().intrinsics();
    int compared = 0;
    for (int v = 0; v < lens.height; v += 3) {
      for (int u = 0; u < lens.width; u += 3) {
        const Eigen::Vector3d d = X_WD.linear() * lens.ray(u, v), p = X_WD.translation();
        double expected = 1e9;  // along a ray whose z is 1: the depth
        for (int axis = 0; axis < 3; ++axis) {
          const double low = axis == 0 ? -3 : axis == 1 ? -2 : 0, high = axis == 0 ? 3 : axis == 1 ? 2 : 2.5;
          if (d[axis] != 0.0) expected = std::min(expected, ((d[axis] > 0 ? high : low) - p[axis]) / d[axis]);
        }
        ASSERT_NEAR(signal.depth.at<float>(v, u), expected, 1e-5) << u << " " << v;
        if (rig.model.rays().at<cv::Vec3f>(v, u)[2] == 0.0f) continue;
        ASSERT_NEAR(read.at<float>(v, u), expected, 0.00051) << u << " " << v;
        ++compared;
      }
    }
    EXPECT_GT(compared, 40000);
  }
}

// Brightness of the wall and the floor of a room by the declared laws.
TEST(StereoCamera, BrightnessIsThatOfTheSurface) {
  Scene scene = fixtures::room(-2, 2, -5, 5, 8, {0.5f, 0.3f, 0.1f});
  scene.materials[0].reflectivity_850nm = 0.4f;
  scene.materials[0].roughness = 1.0f;
  const Rig rig(std::move(scene), quiet());
  const Pose X_WD = looking({0, 0, 1.0});
  const StereoSignal signal = rig.look(X_WD);
  const Intrinsics lens = rig.camera.depth_lens().intrinsics();
  for (const auto& [u, v] : {std::pair{424, 240}, {600, 200}, {424, 470}, {300, 460}}) {
    const Eigen::Vector3d d = X_WD.linear() * lens.ray(u, v);
    const bool floor = d.z() < -0.5;
    const double depth = floor ? -1.0 / d.z() : 2.0 / d.x(), range = depth * d.norm(), cosine = (floor ? -d.z() : d.x()) / d.norm();
    EXPECT_NEAR(signal.ambient.at<float>(v, u), 0.4 * (floor ? 1.0 : 0.6), 1e-5) << u << " " << v;
    // A rough surface's gloss adds about a hundredth of the light.
    EXPECT_NEAR(signal.dots.at<float>(v, u), 0.4 * cosine / (range * range), 0.012 / (range * range)) << u << " " << v;
  }
}

// A board 0.6 m wide at z1 before a wall at z2: the right camera sees a wall point unless the board covers it in its picture, which is the
// left one moved by the board's disparity.
TEST(StereoCamera, TheShadowOfAnEdgeIsAsWideAsTheDisparitiesDiffer) {
  for (const double z1 : {0.8, 1.5, 2.0}) {
    const double z2 = 3.0, half = 0.3;
    Scene scene;
    const int material = add_material(scene, {0.6f, 0.6f, 0.6f});
    add_wall(scene, 3.0f, material);
    Mesh board;
    const auto x = static_cast<float>(z1), h = static_cast<float>(half);
    fixtures::add_quad(board, {x, -h, 0}, {x, -h, 2}, {x, h, 2}, {x, h, 0});
    add_instance(scene, add_mesh(scene, board, material));
    CameraConfig camera = quiet();
    camera.stereo.occlusion = true;
    const Rig rig(std::move(scene), camera);
    const StereoSignal signal = rig.look(looking({0, 0, 1.0}));
    const cv::Mat read = rig.model.read(signal, 0);
    const Intrinsics lens = camera.depth_lens().intrinsics();
    const double f = lens.fx, d1 = f * 0.05 / z1, d2 = f * 0.05 / z2;
    const double left_edge = lens.cx - f * half / z1, right_edge = lens.cx + f * half / z1;
    int shadow = 0, beside_picture = 0;
    for (int u = 0; u < lens.width; ++u) {
      const bool board_here = u > left_edge && u < right_edge;
      ASSERT_NEAR(signal.depth.at<float>(240, u), board_here ? z1 : z2, 1e-5) << u;
      const double at_right = u - d2;  // of a wall point
      if (std::abs(at_right - (left_edge - d1)) < 0.02 || std::abs(at_right + 0.5) < 0.02) continue;
      const bool covered = !board_here && at_right > left_edge - d1 && at_right < right_edge - d1;
      const bool outside = u - (board_here ? d1 : d2) < -0.5;
      ASSERT_EQ(signal.seen.at<std::uint8_t>(240, u) != 0, !covered && !outside) << z1 << " " << u;
      shadow += covered;
      beside_picture += outside;
      if (u < 22 || u > 825) continue;  // outside the field
      EXPECT_EQ(read.at<float>(240, u) > 0.0f, !covered && !outside) << u;
    }
    EXPECT_NEAR(shadow, f * 0.05 * (1.0 / z1 - 1.0 / z2), 1.0) << z1;
    EXPECT_NEAR(beside_picture, d2, 1.0);
    EXPECT_EQ(signal.seen.at<std::uint8_t>(240, static_cast<int>(right_edge) + 2), 1);
  }
}

TEST(StereoCamera, ATexturelessWallNeedsTheProjector) {
  CameraConfig camera = d435();
  const auto share = [&](float distance, float reflectivity) {
    Scene scene;
    add_wall(scene, distance, add_material(scene, {reflectivity, reflectivity, reflectivity}));
    const cv::Mat depth = Rig(std::move(scene), camera).read(looking({0, 0, 1.0}));
    // Right of the strip that the right camera does not see.
    const cv::Mat inner = depth(cv::Rect(100, 20, 700, 440));
    return cv::countNonZero(inner) / static_cast<double>(inner.total());
  };
  EXPECT_EQ(share(1.0f, 0.6f), 1.0);
  EXPECT_EQ(share(3.0f, 0.6f), 1.0);
  EXPECT_LT(share(3.0f, 0.03f), 0.01);  // dark and far
  EXPECT_EQ(share(1.0f, 0.03f), 1.0);
  camera.stereo.projector = false;
  EXPECT_EQ(share(1.0f, 0.6f), 0.0);
  EXPECT_EQ(share(3.0f, 0.6f), 0.0);
  camera.stereo.texture = false;
  EXPECT_EQ(share(1.0f, 0.6f), 1.0);
}

// The whole chain on a white wall: samples a window apart, so that they are independent; 99 % bounds of the variance.
TEST(StereoCamera, DepthDeviatesWithTheSquareOfTheDistance) {
  CameraConfig camera = d435();
  camera.stereo.calibration = false;
  for (const double distance : {0.7, 1.0, 2.0, 3.0, 4.0}) {
    Scene scene;
    add_wall(scene, static_cast<float>(distance), add_material(scene, {0.7f, 0.7f, 0.7f}));
    const Rig rig(std::move(scene), camera, 4);
    const StereoSignal signal = rig.look(looking({0, 0, 1.0}));
    std::vector<double> z;
    for (Stamp stamp = 0; stamp < 8; ++stamp) {
      const cv::Mat depth = rig.model.read(signal, stamp);
      for (int v = 140; v < 340; v += 9) {
        for (int u = 324; u < 524; u += 9) {
          ASSERT_GT(depth.at<float>(v, u), 0.0f);
          z.push_back(depth.at<float>(v, u));
        }
      }
    }
    const double contrast = rig.model.texture(signal).at<float>(240, 424);
    const double sigma = camera.stereo.depth_deviation(distance, contrast);
    EXPECT_NEAR(sigma, distance * distance * 0.08 / 21.2, 0.05 * sigma) << distance;
    // Steps of a disparity (1/32 px) and of a millimetre add their own variance. Away from the middle of the wall the dots are a little
    // weaker: half a percent.
    const double step = distance * distance / 21.2 / 32.0;
    const double ratio = test::sample_variance(z) / (sigma * sigma + step * step / 12.0 + 1e-6 / 12.0);
    EXPECT_GT(ratio, test::variance_ratio_low(z.size())) << distance;
    EXPECT_LT(ratio, test::variance_ratio_high(z.size()) + 0.005) << distance;
    EXPECT_NEAR(test::sample_mean(z), distance, 2.8 * sigma / std::sqrt(static_cast<double>(z.size())) + step / 2 + 0.0005);
  }
}

TEST(StereoCamera, DepthIsRegisteredIntoTheColourView) {
  const CameraConfig camera = quiet();
  const auto caster = caster_of(fixtures::room(-3, 3, -2, 2, 2.5));
  const Surfaces surfaces(caster);
  const auto depth_camera = DepthCamera::make(camera, 1, "camera", caster, surfaces);
  const Pose X_WC = looking({0, 0, 1.4}, 0.3, 0.5);
  const DepthReading reading = depth_camera->read({}, 0, [&](Stamp) { return X_WC; });
  EXPECT_EQ(reading.native.size(), cv::Size(848, 480));
  EXPECT_EQ(reading.registered.size(), cv::Size(1280, 720));
  const Intrinsics view = camera.intrinsics();
  int compared = 0;
  for (int v = 0; v < view.height; v += 5) {
    for (int u = 0; u < view.width; u += 5) {
      const double z = reading.registered.at<float>(v, u);
      if (z == 0.0) continue;
      const Eigen::Vector3d d = X_WC.linear() * view.ray(u, v), p = X_WC.translation();
      double expected = 1e9, second = 1e9;
      for (int axis = 0; axis < 3; ++axis) {
        const double low = axis == 0 ? -3 : axis == 1 ? -2 : 0, high = axis == 0 ? 3 : axis == 1 ? 2 : 2.5;
        const double t = ((d[axis] > 0 ? high : low) - p[axis]) / d[axis];
        second = std::min(second, std::max(t, expected));
        expected = std::min(expected, t);
      }
      if (second - expected < 0.05) continue;  // the corners' triangles are flat
      ASSERT_NEAR(z, expected, 0.0021) << u << " " << v;
      ++compared;
    }
  }
  EXPECT_GT(compared, 30000);
}

// A sheet sends the dots back so bright that both pictures are white there.
TEST(StereoCamera, RetroreflectorsAreHoles) {
  for (const float gain : {0.0f, 220.0f}) {
    Scene scene = fixtures::room(-1, 1.5f, -4, 4, 3);
    fixtures::add_marker(scene, {1.499f, -0.2f, 0.8f}, 0.4f, gain);
    const cv::Mat depth = Rig(std::move(scene), d435()).read(looking({0, 0, 1.0}));
    EXPECT_EQ(depth.at<float>(240, 424) == 0.0f, gain > 0.0f) << gain;
    EXPECT_GT(depth.at<float>(240, 600), 1.4f);
  }
}

TEST(StereoCamera, LooksAtItsMoment) {
  Scene scene;
  const int mesh = add_mesh(scene, fixtures::unit_box(), add_material(scene, {0.6f, 0.6f, 0.6f}));
  const int box = add_instance(scene, mesh, placed({1, -5, -5}, {1, 10, 10}));
  const auto caster = std::make_shared<RayCaster>(std::make_shared<const Scene>(std::move(scene)));
  caster->set_shutter(1000, 3000);
  caster->set_motion(box, placed({1, -5, -5}, {1, 10, 10}), placed({3, -5, -5}, {1, 10, 10}));
  caster->commit();
  const Surfaces surfaces(caster);
  for (const Stamp moment : {1000, 1500, 3000}) {
    const StereoSignal signal = StereoCamera(caster, surfaces, d435()).look(looking({0, 0, 0}), moment);
    EXPECT_NEAR(signal.depth.at<float>(240, 424), 1.0 + static_cast<double>(moment - 1000) / 1000.0, 1e-5);
    EXPECT_EQ(signal.seen.at<std::uint8_t>(240, 424), 1) << "both cameras look at once";
  }
}

TEST(StereoCamera, EverySwitchChangesTheReading) {
  const Pose X_WD = looking({-1.0, 0, 1.4}, 0.3, 0.5);
  const auto hall = [] {
    Scene scene = fixtures::busy_hall(8);
    // Near enough for a shadow wider than what edges grow by.
    add_instance(scene, add_mesh(scene, fixtures::unit_box(), 0), placed({-0.2f, 0.0f, 0.8f}, {0.05f, 0.3f, 0.4f}));
    return scene;
  };
  const cv::Mat all = Rig(hall(), d435()).read(X_WD);
  EXPECT_GT(cv::countNonZero(all), 200000);
  for (const auto& [name, member] : {std::pair{"projector", &StereoConfig::projector},
                                     {"occlusion", &StereoConfig::occlusion},
                                     {"fattening", &StereoConfig::fattening},
                                     {"texture", &StereoConfig::texture},
                                     {"noise", &StereoConfig::noise},
                                     {"correlation", &StereoConfig::correlation},
                                     {"calibration", &StereoConfig::calibration},
                                     {"quantisation", &StereoConfig::quantisation}}) {
    CameraConfig camera = d435();
    camera.stereo.*member = false;
    const cv::Mat without = Rig(hall(), camera).read(X_WD);
    EXPECT_NE(std::memcmp(all.data, without.data, all.total() * all.elemSize()), 0) << name;
  }
}

TEST(StereoCamera, IsTheSameAtAnyThreadCount) {
  const Rig rig(fixtures::busy_hall(8), d435());
  const Pose X_WD = looking({0, 0, 1.4}, 0.3, 0.7);
  set_thread_count(1);
  const StereoSignal one = rig.look(X_WD);
  const cv::Mat read = rig.model.read(one, 3);
  for (const int threads : {2, 4}) {
    set_thread_count(threads);
    const StereoSignal other = rig.look(X_WD);
    for (const auto& [a, b] :
         {std::pair{one.depth, other.depth}, {one.ambient, other.ambient}, {one.dots, other.dots}, {one.seen, other.seen}})
      EXPECT_EQ(std::memcmp(a.data, b.data, a.total() * a.elemSize()), 0) << threads;
    const cv::Mat again = rig.model.read(other, 3);
    EXPECT_EQ(std::memcmp(read.data, again.data, read.total() * read.elemSize()), 0) << threads;
  }
  set_thread_count(0);
}

}  // namespace
}  // namespace waretwin

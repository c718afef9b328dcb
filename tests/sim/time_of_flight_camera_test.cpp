// The depth camera's light against closed forms, and what each effect does to it.
#include "sim/time_of_flight_camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <cstring>
#include <numbers>

#include "core/parallel.h"
#include "sensors/depth_field.h"
#include "tests/sim/fixtures.h"

namespace waretwin {
namespace {

using fixtures::add_instance;
using fixtures::add_material;
using fixtures::add_mesh;
using fixtures::caster_of;
using fixtures::looking;
using fixtures::placed;

TimeOfFlightCamera::PulsePoses standing(const Pose& X_WD) {
  TimeOfFlightCamera::PulsePoses poses;
  poses.fill(X_WD);
  return poses;
}

struct Rig {
  std::shared_ptr<const RayCaster> caster;
  CameraConfig camera;
  Surfaces surfaces;
  TimeOfFlightModel model;

  Rig(Scene scene, const CameraConfig& config)
      : caster(caster_of(std::move(scene))), camera(config), surfaces(caster), model(config, 1, "camera") {}
  TimeOfFlightSignal look(const TimeOfFlightCamera::PulsePoses& poses) const {
    return TimeOfFlightCamera(caster, surfaces, camera, model.rays()).look(poses);
  }
  Eigen::Vector3d ray_W(const Pose& X_WD, int v, int u) const {
    const cv::Vec3f& r = model.rays().at<cv::Vec3f>(v, u);
    return X_WD.linear() * Eigen::Vector3d(r[0], r[1], r[2]).normalized();
  }
};

// Everything off but what a test asks for; a rough white dielectric as surface.
CameraConfig quiet() {
  CameraConfig camera;
  auto& t = camera.time_of_flight;
  t.motion = t.mixed_pixels = t.multipath = t.wiggle = t.noise = t.invalidation = false;
  return camera;
}

TEST(TimeOfFlightCamera, PlaneAndCornerAreExact) {
  const Rig rig(fixtures::room(-3, 3, -2, 2, 2.5), quiet());
  for (const Pose& X_WD : {looking({0, 0, 1.4}, 0.0, 0.8), looking({1.2, 0.5, 1.0}, 0.6, 0.2)}) {
    const TimeOfFlightSignal signal = rig.look(standing(X_WD));
    int seen = 0;
    for (int v = 0; v < signal.range.rows; v += 3) {
      for (int u = 0; u < signal.range.cols; u += 3) {
        if (rig.model.rays().at<cv::Vec3f>(v, u)[2] == 0.0f) {
          ASSERT_EQ(signal.range.at<float>(v, u), 0.0f);
          continue;
        }
        const Eigen::Vector3d d = rig.ray_W(X_WD, v, u), p = X_WD.translation();
        double expected = 1e9;
        for (int axis = 0; axis < 3; ++axis) {
          const double low = axis == 0 ? -3 : axis == 1 ? -2 : 0, high = axis == 0 ? 3 : axis == 1 ? 2 : 2.5;
          if (d[axis] != 0.0) expected = std::min(expected, ((d[axis] > 0 ? high : low) - p[axis]) / d[axis]);
        }
        ASSERT_NEAR(signal.range.at<float>(v, u), expected, 1e-5 * expected) << u << " " << v;
        ++seen;
      }
    }
    EXPECT_GT(seen, 20000);
  }
}

TEST(TimeOfFlightCamera, SphereIsExactUpToItsFacets) {
  constexpr int kSteps = 1200;
  Scene scene;
  const int mesh = add_mesh(scene, fixtures::unit_sphere(kSteps), add_material(scene, {0.8f, 0.8f, 0.8f}));
  Eigen::Affine3f X_WM = Eigen::Affine3f::Identity();
  X_WM.linear() *= 0.4f;
  X_WM.translation() = Eigen::Vector3f(1.5f, 0.0f, 1.0f);
  add_instance(scene, mesh, X_WM);
  const Rig rig(std::move(scene), quiet());
  const Pose X_WD = looking({0, 0, 1});
  const TimeOfFlightSignal signal = rig.look(standing(X_WD));
  int seen = 0;
  for (int v = 0; v < signal.range.rows; ++v) {
    for (int u = 0; u < signal.range.cols; ++u) {
      if (rig.model.rays().at<cv::Vec3f>(v, u)[2] == 0.0f) continue;
      const Eigen::Vector3d d = rig.ray_W(X_WD, v, u), to_centre = Eigen::Vector3d(1.5, 0, 1.0) - X_WD.translation();
      const double along = d.dot(to_centre), square = 0.16 - (to_centre - along * d).squaredNorm();
      if (square < 0.01) continue;  // towards the rim a facet's depth below the sphere grows
      const double expected = along - std::sqrt(square);
      // A facet lies below the sphere by at most R (pi / steps)^2 / 4, seen at cos >= 1/4.
      const double facet = 0.4 * std::pow(std::numbers::pi / kSteps, 2) / 4.0 * 4.0;
      ASSERT_NEAR(signal.range.at<float>(v, u), expected, 1e-5 * expected + facet) << u << " " << v;
      ++seen;
    }
  }
  EXPECT_GT(seen, 30000);
}

TEST(TimeOfFlightCamera, SignalIsReflectivityTimesCosineOverRangeSquared) {
  Scene scene = fixtures::room(-2, 2, -5, 5, 8, {0.5f, 0.3f, 0.1f});
  const Rig guessed(scene, quiet());
  scene.materials[0].reflectivity_850nm = 0.15f;
  const Rig given(scene, quiet());
  const Pose X_WD = looking({0, 0, 4});
  const TimeOfFlightSignal a = guessed.look(standing(X_WD)), b = given.look(standing(X_WD));
  for (const auto& [v, u] : {std::pair{288, 320}, {288, 500}, {150, 320}, {400, 200}}) {
    const double range = a.range.at<float>(v, u), cosine = 2.0 / range;
    // The guess is the brightest channel; a rough dielectric's surface adds 1 % to 2 %.
    EXPECT_NEAR(a.signal.at<float>(v, u), 0.5 * cosine / (range * range), 0.012 / (range * range)) << v << " " << u;
    EXPECT_NEAR(b.signal.at<float>(v, u), 0.15 * cosine / (range * range), 0.012 / (range * range)) << v << " " << u;
  }
}

// A wall's edge before another wall: within the pixels that see both, a range in between where the walls are near each other.
TEST(TimeOfFlightCamera, EdgesMixBothSurfaces) {
  const auto flying = [](float gap, bool mixed, double& lowest_coherence) {
    Scene scene = fixtures::room(-2, 1.5f, -3, 3, 4);
    const int box = add_mesh(scene, fixtures::unit_box(), 0);
    // Off the pixel grid.
    add_instance(scene, box, placed({1.5f - gap, 0.0037f, 0.0f}, {gap, 2.0f, 4.0f}));
    CameraConfig camera = quiet();
    camera.time_of_flight.mixed_pixels = mixed;
    const Rig rig(std::move(scene), camera);
    const Pose X_WD = looking({0, 0, 2});
    const TimeOfFlightSignal signal = rig.look(standing(X_WD));
    int between = 0;
    lowest_coherence = 1.0;
    for (int v = 100; v < 450; ++v) {
      for (int u = 200; u < 440; ++u) {
        const double x = signal.range.at<float>(v, u) * rig.ray_W(X_WD, v, u).x();
        between += x > 1.5 - static_cast<double>(gap) + 0.002 && x < 1.5 - 0.002;
        lowest_coherence = std::min(lowest_coherence, static_cast<double>(signal.coherence.at<float>(v, u)));
      }
    }
    return between;
  };
  double coherence = 0.0;
  EXPECT_EQ(flying(0.06f, false, coherence), 0);
  EXPECT_EQ(coherence, 1.0);
  // A column of pixels, give or take the slant of the edge.
  const int near = flying(0.06f, true, coherence);
  EXPECT_GT(near, 300);
  EXPECT_LT(near, 800);
  EXPECT_GT(coherence, 0.96);
  // Half a wave (0.375 m of range) cancels: the maker's rule takes those pixels out.
  flying(0.375f, true, coherence);
  EXPECT_LT(coherence, 0.3);
}

// Two phasors have a sum in closed form: half of the light from each of two walls puts the range in the middle.
TEST(TimeOfFlightCamera, MixIsWeightedByLight) {
  // Vertical stripes of 1/9 of a pixel cannot be built; a step of the wall that covers a third of the pixel column can.
  const float gap = 0.05f;
  CameraConfig camera = quiet();
  camera.time_of_flight.mixed_pixels = true;
  camera.time_of_flight.lens_distortion = false;
  camera.time_of_flight.width = 641;  // a pixel on the axis
  const double pixel = 1.0 / camera.depth_lens().intrinsics().fx;
  Scene scene = fixtures::room(-2, 1.0f, -3, 3, 4);
  const int box = add_mesh(scene, fixtures::unit_box(), 0);
  // The camera looks along x; its right is -y. The step's edge lies a sixth of a pixel to the right of the axis at its own distance.
  add_instance(scene, box, placed({1.0f - gap, -2.0f, 0.0f}, {gap, 2.0f - static_cast<float>(pixel / 6.0 * 0.95), 4.0f}));
  const Rig rig(std::move(scene), camera);
  const Pose X_WD = looking({0, 0, 2});
  const TimeOfFlightSignal signal = rig.look(standing(X_WD));
  const int v = 288, u = 320;
  const double near = 0.95, far = 1.0;
  const double k = 4.0 * std::numbers::pi * 200e6 / 299792458.0;
  const double a = 3.0 / (near * near), b = 6.0 / (far * far);
  const double angle = std::atan2(a * std::sin(k * (near - far)), b + a * std::cos(k * (near - far)));
  EXPECT_NEAR(signal.range.at<float>(v, u), far + angle / k, 2e-4);
  const double length = std::sqrt(a * a + b * b + 2 * a * b * std::cos(k * (near - far))) / (a + b);
  EXPECT_NEAR(signal.coherence.at<float>(v, u), length, 1e-3);
}

TEST(TimeOfFlightCamera, MotionBlursEdgesAndLeavesPlanes) {
  Scene scene = fixtures::room(-2, 2.0f, -4, 4, 4);
  const int box = add_mesh(scene, fixtures::unit_box(), 0);
  add_instance(scene, box, placed({1.9f, 0.0037f, 0.0f}, {0.1f, 3.0f, 4.0f}));
  const auto changed = [&](bool motion, double turn_deg) {
    CameraConfig camera = quiet();
    camera.time_of_flight.motion = motion;
    const Rig rig(scene, camera);
    TimeOfFlightCamera::PulsePoses poses;
    for (int k = 0; k < kTimeOfFlightPulses; ++k)
      poses[static_cast<std::size_t>(k)] = looking({0, 0, 2}, to_radians(turn_deg) * pulse_time(k));
    const cv::Mat still = rig.look(standing(poses[4])).range, moved = rig.look(poses).range;
    int count = 0;
    for (int v = 0; v < still.rows; ++v) {
      for (int u = 0; u < still.cols; ++u) count += std::abs(still.at<float>(v, u) - moved.at<float>(v, u)) > 0.002f;
    }
    return count;
  };
  EXPECT_EQ(changed(false, 0.6), 0);
  // 0.6 deg are five pixels: along the edge of 430 rows, and nowhere on the planes.
  const int blurred = changed(true, 0.6);
  EXPECT_GT(blurred, 400 * 3);
  EXPECT_LT(blurred, 600 * 7);
}

// Two walls at a right angle, one camera. The slow reference shoots thousands of rays from one point.
TEST(TimeOfFlightCamera, CornersReadTooLongAsTheReferenceSays) {
  CameraConfig camera = quiet();
  camera.time_of_flight.multipath = true;
  const Rig rig(fixtures::room(-1.5f, 1.5f, -1.5f, 1.5f, 3, {0.7f, 0.7f, 0.7f}), camera);
  CameraConfig single = quiet();
  const Rig direct(fixtures::room(-1.5f, 1.5f, -1.5f, 1.5f, 3, {0.7f, 0.7f, 0.7f}), single);
  // Looks into the vertical edge at (1.5, 1.5).
  const Pose X_WD = looking({0, 0, 1.5}, to_radians(45));
  const TimeOfFlightSignal with = rig.look(standing(X_WD)), without = direct.look(standing(X_WD));
  const double k = 4.0 * std::numbers::pi * 200e6 / 299792458.0;
  const Eigen::Vector3d o = X_WD.translation();
  for (const int u : {334, 342, 350, 366, 382}) {
    const int v = 288;
    const double range = without.range.at<float>(v, u);
    const Eigen::Vector3d p = o + range * rig.ray_W(X_WD, v, u);
    // The wall of p is x = 1.5 or y = 1.5; integrate over the other four metres of the room that the camera lights, in the plane's own
    // grid.
    const bool on_x = p.x() > p.y();
    const Eigen::Vector3d n = on_x ? Eigen::Vector3d(-1, 0, 0) : Eigen::Vector3d(0, -1, 0);
    const double cosine = -n.dot((p - o).normalized());
    std::complex<double> phasor = 0.0;
    const int steps = 300;
    // Light from the wall beside: points q, irradiance there, form factor to p, within 1.5 m.
    for (int i = 0; i < steps; ++i) {
      for (int j = 0; j < 2 * steps; ++j) {
        // Denser towards the edge.
        const double s0 = 3.0 * std::pow(static_cast<double>(i) / steps, 2), s1 = 3.0 * std::pow((i + 1.0) / steps, 2), s = 0.5 * (s0 + s1);
        const double z = 3.0 * (j + 0.5) / (2 * steps);
        const Eigen::Vector3d q = on_x ? Eigen::Vector3d(1.5 - s, 1.5, z) : Eigen::Vector3d(1.5, 1.5 - s, z);
        const Eigen::Vector3d m = on_x ? Eigen::Vector3d(0, -1, 0) : Eigen::Vector3d(-1, 0, 0);
        const Eigen::Vector3d in_D = X_WD.linear().transpose() * (q - o);
        if (in_D.z() <= 0 || !inside_outline(camera.field, in_D.x() / in_D.z(), in_D.y() / in_D.z())) continue;
        const double d = (q - p).norm(), r = (q - o).norm();
        if (d > 1.5) continue;
        const double irradiance = -m.dot(q - o) / r / (r * r);
        const double transfer = n.dot((q - p) / d) * m.dot((p - q) / d) / (std::numbers::pi * d * d);
        const double area = (s1 - s0) * 3.0 / (2 * steps);
        phasor += std::polar(std::max(transfer, 0.0) * 0.7 * irradiance * area * range * range / cosine, k * 0.5 * (r + d - range));
      }
    }
    const double expected = std::arg(1.0 + phasor) / k;
    // Mean over rows, along which little changes: a pixel has 54 rays where the reference has 180,000.
    double found = 0.0;
    for (int row = v - 40; row <= v + 40; ++row) found += (with.range.at<float>(row, u) - without.range.at<float>(row, u)) / 81.0;
    // Nearest to the edge the cells of the grid smooth the rise.
    EXPECT_NEAR(found, expected, 0.2 * std::abs(expected) + 0.001) << u;
    if (u < 350) {
      EXPECT_GT(expected, 0.005) << u;
      EXPECT_GT(with.signal.at<float>(v, u), without.signal.at<float>(v, u)) << u;
    }
  }
}

TEST(TimeOfFlightCamera, AFlatFloorHasNoMultipath) {
  CameraConfig camera = quiet();
  camera.time_of_flight.multipath = true;
  Scene scene;
  Mesh floor;
  fixtures::add_quad(floor, {-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0});
  add_instance(scene, add_mesh(scene, floor, add_material(scene, {0.8f, 0.8f, 0.8f})));
  const Rig with(scene, camera), without(scene, quiet());
  const auto poses = standing(looking({0, 0, 1.4}, 0.0, 0.8));
  const cv::Mat a = with.look(poses).range, b = without.look(poses).range;
  EXPECT_EQ(std::memcmp(a.data, b.data, a.total() * a.elemSize()), 0);
}

// A sheet of 220 times a white surface's light saturates the pixel over the whole range; the wall around it is read as ever.
TEST(TimeOfFlightCamera, RetroreflectorsSaturate) {
  for (const float wall : {0.8f, 2.0f, 3.5f}) {
    for (const float gain : {0.0f, 220.0f}) {
      Scene scene = fixtures::room(-1, wall, -4, 4, 3);
      fixtures::add_marker(scene, {wall - 0.001f, -0.1f * wall, 1.0f - 0.1f * wall}, 0.2f * wall, gain);
      CameraConfig camera;
      camera.time_of_flight.multipath = false;
      const Rig rig(std::move(scene), camera);
      const TimeOfFlightSignal signal = rig.look(standing(looking({0, 0, 1})));
      const cv::Mat depth = rig.model.read(signal, 0);
      if (gain > 0.0f) {
        EXPECT_NEAR(signal.signal.at<float>(288, 320), gain / (wall * wall), 0.02 * gain / (wall * wall)) << wall;
      }
      // The dark sheet without its glass is too dark at 3.5 m.
      EXPECT_EQ(depth.at<float>(288, 320) == 0.0f, gain > 0.0f || wall > 3.0f) << wall << " " << gain;
      EXPECT_NEAR(depth.at<float>(288, 440), wall, 0.02) << wall;
    }
  }
}

TEST(TimeOfFlightCamera, IsTheSameAtAnyThreadCountAndAfterOtherPictures) {
  CameraConfig camera;
  const Rig rig(fixtures::busy_hall(8), camera);
  TimeOfFlightCamera::PulsePoses poses;
  for (int k = 0; k < kTimeOfFlightPulses; ++k) poses[static_cast<std::size_t>(k)] = looking({0, 0, 1.4}, 0.3 + 0.01 * pulse_time(k), 0.7);
  set_thread_count(1);
  const TimeOfFlightSignal one = rig.look(poses);
  TimeOfFlightCamera optics(rig.caster, rig.surfaces, camera, rig.model.rays());
  optics.look(standing(looking({1, 1, 1.0}, 2.0, 0.5)));
  for (const int threads : {2, 4}) {
    set_thread_count(threads);
    const TimeOfFlightSignal other = optics.look(poses);
    for (const auto& [a, b] :
         {std::pair{one.range, other.range}, {one.signal, other.signal}, {one.coherence, other.coherence}, {one.indirect, other.indirect}})
      EXPECT_EQ(std::memcmp(a.data, b.data, a.total() * a.elemSize()), 0) << threads;
  }
  set_thread_count(0);
}

}  // namespace
}  // namespace waretwin

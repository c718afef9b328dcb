#include "harness/calibrate/calibration.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/files.h"
#include "core/random.h"
#include "harness/calibrate/calibration_report.h"
#include "harness/calibrate/closed_form.h"
#include "harness/calibrate/extrinsics.h"
#include "sensors/mount.h"
#include "tests/support/expect_error.h"
#include "tests/support/test_data.h"

namespace waretwin {
namespace {

// The vehicle of scenes/agiprobot and a board before it; everything else is a wall 5 m away.
struct Bench {
  Pose X_BC = Mount{.z_m = 1.4, .pitch_deg = 45}.X_BC();
  Pose X_BL = Mount{.x_m = 0.275, .y_m = 0.2, .z_m = 0.3, .yaw_deg = 43.9}.X_BL();
  Intrinsics k = Intrinsics::checked(1280, 720, 640, 636, 639.5, 359.5);
  CheckerBoard board;
  double corner_sigma_px = 0.0, range_sigma_m = 0.0, bias_m = 0.0;
  int scans = 40;

  // Where the board is held, as in a scenario's motion.held: the face looks along x of the given pose.
  static Pose X_BO(double x, double y, double yaw_deg, double tilt_deg) {
    Pose X = Pose::Identity();
    X.linear() = rotation_from_rpy(0, to_radians(-tilt_deg), to_radians(yaw_deg + 180));
    Eigen::Matrix3d face;  // O of the board's x forward, z up: x to the viewer's right, y down, z into the board
    face.col(0) = Eigen::Vector3d::UnitY();
    face.col(1) = -Eigen::Vector3d::UnitZ();
    face.col(2) = -Eigen::Vector3d::UnitX();
    X.linear() = X.linear() * face;
    X.translation() = Eigen::Vector3d(x, y, 0.42);
    return X;
  }
  static std::vector<Pose> poses() {
    return {X_BO(1.3, 0.0, 0, 0),   X_BO(1.2, -0.5, 25, 20), X_BO(1.3, 0.5, -28, 25), X_BO(1.5, -0.8, -15, 35),
            X_BO(1.5, 0.8, 18, -5), X_BO(1.2, 0.1, -35, 10), X_BO(1.9, -0.2, 0, 45),  X_BO(1.9, 0.4, 30, 15)};
  }

  StillPose look(const Pose& X_BO, std::uint64_t seed, std::uint64_t number) const {
    const RandomStream random(seed, "bench", "look", static_cast<Stamp>(number));
    StillPose pose;
    pose.begin = from_seconds(static_cast<double>(number));
    pose.end = from_seconds(static_cast<double>(number) + 1.0);
    pose.frames = 5;
    pose.scans = scans;
    std::uint64_t draw = 0;
    for (const Eigen::Vector3d& p_O : board.corners_O()) {
      Eigen::Vector2d corner = k.project(X_BC.inverse() * (X_BO * p_O));
      for (int axis = 0; axis < 2; ++axis) corner[axis] += corner_sigma_px * random.normal(draw++);
      pose.corners.push_back(corner);
    }
    const Pose X_OL = X_BO.inverse() * X_BL;
    const Eigen::Vector2d half = board.half_size() + Eigen::Vector2d(0.05, 0.05);
    for (int i = 0; i < 541; ++i) {
      BeamMean beam{.angle = to_radians(-135.0 + 0.5 * i), .readings = scans, .range_m = 5.0, .sigma_m = range_sigma_m};
      const Eigen::Vector3d ray = X_OL.linear() * Eigen::Vector3d(std::cos(beam.angle), std::sin(beam.angle), 0.0);
      const double range = -X_OL.translation().z() / ray.z();
      const Eigen::Vector3d p = X_OL.translation() + range * ray;
      if (ray.z() > 0.0 && range > 0.0 && std::abs(p.x()) < half.x() && std::abs(p.y()) < half.y()) beam.range_m = range;
      beam.range_m += bias_m + range_sigma_m / std::sqrt(scans) * random.normal(draw++);
      pose.beams.push_back(beam);
    }
    return pose;
  }
  std::vector<StillPose> look(const std::vector<Pose>& boards, std::uint64_t seed = 1) const {
    std::vector<StillPose> still;
    for (const Pose& X_BO : boards) still.push_back(look(X_BO, seed, still.size()));
    return still;
  }
  // What is known beforehand: the camera's place by this much wrong.
  StreamInfo info(const Eigen::Vector3d& shift, double yaw_deg = 0, double pitch_deg = 0, double roll_deg = 0) const {
    StreamInfo info;
    info.source = "bench";
    Pose X = X_BC;
    X.linear() = rotation_from_rpy(to_radians(roll_deg), to_radians(pitch_deg), to_radians(yaw_deg)) * X_BC.linear();
    X.translation() += shift;
    info.cameras["camera"] = {.intrinsics = k, .X_BC = X};
    info.lasers["laser"] = {.X_BL = X_BL};
    return info;
  }
};

std::vector<Eigen::Vector3d> normals_of(const std::vector<Pose>& boards) {
  std::vector<Eigen::Vector3d> normals;
  for (const Pose& X : boards) normals.push_back(X.linear().col(2));
  return normals;
}

TEST(ClosedForm, ExactDataGivesThePose) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const RandomStream random(seed, "closed form", "pose");
    std::uint64_t draw = 0;
    const auto uniform = [&](double from, double to) { return from + (to - from) * random.uniform(draw++); };
    Pose X_CL = Pose::Identity();
    X_CL.linear() = rotation_from_rpy(uniform(-3, 3), uniform(-1.5, 1.5), uniform(-3, 3));
    X_CL.translation() = Eigen::Vector3d(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
    std::vector<PlaneAndPoints> planes;
    for (int i = 0; i < 6; ++i) {
      // A line in the laser's plane, and any plane through it.
      const double along = uniform(-3, 3), turn = uniform(0.4, 2.7);
      const Eigen::Vector3d direction(std::cos(along), std::sin(along), 0), foot(uniform(-2, 2), uniform(-2, 2), 0);
      const Eigen::Vector3d across(-direction.y(), direction.x(), 0);
      PlaneAndPoints plane;
      plane.normal_C = X_CL.linear() * (std::sin(turn) * across + std::cos(turn) * Eigen::Vector3d::UnitZ());
      plane.distance_m = plane.normal_C.dot(X_CL * foot);
      for (int k = 0; k < 5; ++k) plane.points_L.push_back(foot + 0.2 * k * direction);
      planes.push_back(plane);
    }
    const Pose found = closed_form_X_CL(planes);
    EXPECT_LT((found.translation() - X_CL.translation()).norm(), 1e-9) << seed;
    EXPECT_LT((found.linear() - X_CL.linear()).norm(), 1e-9) << seed;
    planes.resize(3);
    EXPECT_ERROR(closed_form_X_CL(planes), "degenerate", "3 boards");
  }
}

TEST(ClosedForm, NamesWhatIsDegenerate) {
  const Eigen::Matrix3d same = Eigen::Matrix3d::Identity();
  const auto at = &Bench::X_BO;
  EXPECT_NO_THROW(expect_determined(normals_of(Bench::poses()), 5, 5.0, same));
  EXPECT_ERROR(expect_determined(normals_of({at(1, 0, 10, 20), at(2, 0, 10, 21)}), 5, 5.0, same), "2 board poses with parallel boards",
               "at least 5 poses");
  EXPECT_ERROR(expect_determined(normals_of(std::vector<Pose>(9, at(1, 0, 0, 0))), 5, 5.0, same), "9 board poses with parallel boards");
  EXPECT_ERROR(expect_determined(normals_of({at(1, 0, 10, 20), at(2, 0, 40, 0)}), 5, 5.0, same), "2 board poses that", "at least 5");
  // Upright boards say nothing of heights.
  std::vector<Pose> upright;
  for (const double yaw : {-40.0, -20.0, 0.0, 20.0, 40.0, 50.0}) upright.push_back(at(1.5, 0, yaw, 0.3));
  EXPECT_ERROR(expect_determined(normals_of(upright), 5, 5.0, same), "lie in one plane", "1.00) of the vehicle");
  // Nor do boards that are only tilted tell a shift to the left.
  std::vector<Pose> tilted;
  for (const double tilt : {-20.0, 0.0, 10.0, 20.0, 30.0, 45.0}) tilted.push_back(at(1.5, 0, 0, tilt));
  EXPECT_ERROR(expect_determined(normals_of(tilted), 5, 5.0, same), "lie in one plane", "1.00, ");
  EXPECT_ERROR(expect_determined({}, 5, 5.0, same), "0 board poses", "at least 5");
}

#ifdef WARETWIN_CERES
TEST(Calibration, ExactObservationsGiveTheMounting) {
  Bench bench;
  bench.bias_m = 0.013;
  // The data sheet's bias pulls towards 0, the more the less is known: exact observations leave nothing of that.
  for (const double off : {0.0, 1.0, -1.0}) {
    const StreamInfo info = bench.info(off * Eigen::Vector3d(0.15, -0.12, 0.12), off * 5, off * 4, off * -5);
    const Calibration found = calibrate(bench.look(Bench::poses()), info, {});
    EXPECT_EQ(found.used_poses, 8);
    EXPECT_LT((found.found.X_BC.translation() - bench.X_BC.translation()).norm(), 1e-6);
    EXPECT_LT(rotation_between(found.found.X_BC, bench.X_BC), 1e-6);
    EXPECT_NEAR(found.found.bias_m, 0.013, 1e-6);
    EXPECT_GT(found.found.points, 8 * 30);
  }
}

TEST(Refine, ErrorsAreThoseThatTheCovarianceSays) {
  Bench bench;
  bench.corner_sigma_px = 0.08;
  bench.range_sigma_m = 0.008;
  constexpr int kSeeds = 60;
  double chi2 = 0.0, far = 0.0;
  Eigen::Matrix<double, 7, 1> squares = Eigen::Matrix<double, 7, 1>::Zero();
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    bench.bias_m = 0.02 * (seed % 2 == 0 ? 1 : -1);
    std::vector<BoardView> views;
    for (const StillPose& pose : bench.look(Bench::poses(), seed)) {
      views.push_back(view_board(pose.corners, bench.k, bench.board).value());
      views.back().points = points_by_estimate(pose, views.back(), bench.board, bench.X_BC.inverse() * bench.X_BL, bench.bias_m, 0.03);
    }
    const Refined found = refine(views, bench.k, bench.board, bench.X_BL, bench.X_BC, 0.0, {});
    const CalibrationError error = error_of(found.X_BC, bench.X_BC, found.covariance.topLeftCorner<6, 6>());
    chi2 += error.chi2 / kSeeds;
    far += error.chi2 > 10.64 ? 1.0 / kSeeds : 0.0;  // which one in ten is
    Eigen::Matrix<double, 7, 1> all;
    all << error.shift_B, error.turn_B, found.bias_m - bench.bias_m;
    squares += all.cwiseAbs2().cwiseQuotient(found.covariance.diagonal()) / kSeeds;
    EXPECT_NEAR(found.corner_sigma_px, 0.08, 0.02);
    EXPECT_NEAR(found.beam_factor, 1.0, 0.3);
  }
  // Means of draws of chi-square with 6 and 1 degrees of freedom, and a share: three and a half sigma wide.
  constexpr double kWide = 3.5;
  EXPECT_NEAR(chi2, 6.0, kWide * std::sqrt(12.0 / kSeeds));
  EXPECT_LT(far, 0.1 + kWide * std::sqrt(0.1 * 0.9 / kSeeds));
  for (int i = 0; i < 7; ++i) EXPECT_NEAR(squares[i], 1.0, kWide * std::sqrt(2.0 / kSeeds)) << i;
}

// The same of the whole estimate, which picks lines and beams itself.
TEST(Calibration, ErrorsAreThoseThatTheCovarianceSays) {
  Bench bench;
  bench.corner_sigma_px = 0.08;
  bench.range_sigma_m = 0.008;
  constexpr int kSeeds = 6;
  double chi2 = 0.0, bias = 0.0;
  for (std::uint64_t seed = 101; seed < 101 + kSeeds; ++seed) {
    bench.bias_m = 0.02 * (seed % 2 == 0 ? 1 : -1);
    const Calibration found = calibrate(bench.look(Bench::poses(), seed), bench.info({0.03, -0.02, 0.02}, 1, -2, 1), {});
    EXPECT_EQ(found.used_poses, 8) << seed;
    chi2 += error_of(found.found.X_BC, bench.X_BC, found.found.covariance.topLeftCorner<6, 6>()).chi2;
    bias += std::pow(found.found.bias_m - bench.bias_m, 2) / found.found.covariance(6, 6);
  }
  // Sums of chi-square with 6 and 1 degrees of freedom a seed: one in a thousand is beyond.
  EXPECT_LT(chi2, 68.0);
  EXPECT_LT(bias, 22.5);
}

TEST(Calibration, NeedsNoGuess) {
  Bench bench;
  bench.corner_sigma_px = 0.08;
  bench.range_sigma_m = 0.008;
  bench.bias_m = -0.015;
  std::vector<StillPose> still = bench.look(Bench::poses());
  // Two lines as long as the board: a panel that stays where it is, and one that is carried about.
  const auto put = [](StillPose& pose, double from_deg, double to_deg, double distance_m) {
    const double middle = to_radians(0.5 * (from_deg + to_deg));
    for (BeamMean& beam : pose.beams) {
      const double off = beam.angle - middle;
      if (std::abs(off) < to_radians(0.5 * (to_deg - from_deg))) beam.range_m = distance_m / std::cos(off);
    }
  };
  for (std::size_t i = 0; i < still.size(); ++i) {
    put(still[i], -120, -95, 1.5);
    put(still[i], 40 + static_cast<double>(i), 60 + static_cast<double>(i), 1.2 + 0.1 * static_cast<double>(i));
  }
  for (const StreamInfo& info : {bench.info({0.6, -0.6, 0.5}, 30, -25, 20), bench.info({-1, 1, -1}, 170, 40, 90)}) {
    const Calibration found = calibrate(still, info, {});
    EXPECT_EQ(found.used_poses, 8);
    EXPECT_LT((found.found.X_BC.translation() - bench.X_BC.translation()).norm(), 0.006);
    EXPECT_LT(to_degrees(rotation_between(found.found.X_BC, bench.X_BC)), 0.2);
  }
  EXPECT_ERROR(calibrate({still.begin(), still.begin() + 5}, bench.info({-1, 1, -1}, 170, 40, 90), {}), "0.30 m and 10.0 deg",
               "eight poses");
  // A board that is turned about its line in the scan looks like the hall.
  std::vector<Pose> turned;
  for (const double yaw : {-30.0, 0.0, 30.0}) {
    for (const double tilt : {0.0, 15.0, 30.0}) {
      Pose X = Bench::X_BO(1.4, 0.1, yaw, tilt);
      X.translation() += 0.12 * (X.linear().col(1) + Eigen::Vector3d::UnitZ());
      turned.push_back(X);
    }
  }
  EXPECT_EQ(calibrate(bench.look(turned), bench.info({0.03, -0.02, 0.02}, 1, -2, 1), {}).used_poses, 9);
  EXPECT_EQ(calibrate(bench.look(turned), bench.info({-1, 1, -1}, 170, 40, 90), {}).used_poses, 9);
  // Lines that are never the board agree on nothing.
  for (StillPose& pose : still) {
    for (BeamMean& beam : pose.beams) {
      if (beam.angle > to_radians(-92) && beam.angle < to_radians(20)) beam.range_m = 5.0;
    }
  }
  EXPECT_ERROR(calibrate(still, bench.info({0, 0, 0}), {}), "board poses that camera and laser both saw");
}

TEST(Calibration, LeavesOutWhatIsNotTheBoard) {
  Bench bench;
  bench.corner_sigma_px = 0.05;
  bench.range_sigma_m = 0.008;
  std::vector<StillPose> still = bench.look(Bench::poses());
  // A panel as long as the board stands before it in one pose, a leg before a few beams in another, and in a third nothing is there.
  for (BeamMean& beam : still[1].beams) {
    if (beam.range_m < 4.0) beam.range_m -= 0.18;
  }
  int leg = 0;
  for (BeamMean& beam : still[2].beams) {
    if (beam.range_m < 4.0 && ++leg > 20 && leg < 26) beam.range_m -= 0.06;
  }
  for (BeamMean& beam : still[3].beams) beam.range_m = 5.0;
  for (Eigen::Vector2d& corner : still[4].corners) corner.x() += 0.02 * (corner.y() - 200.0) * std::sin(corner.x());
  still.push_back(bench.look(Bench::X_BO(1.4, 0.3, 10, 30), 1, 8));
  still.push_back(bench.look(Bench::X_BO(1.4, -0.3, -20, 5), 1, 9));
  const Calibration found = calibrate(still, bench.info({0.03, -0.02, 0.02}, 1, -2, 1), {});
  EXPECT_EQ(found.used_poses, 7);
  EXPECT_NE(found.poses[1].unused.find("plane"), std::string::npos) << found.poses[1].unused;
  EXPECT_NE(found.poses[3].unused.find("no line"), std::string::npos) << found.poses[3].unused;
  EXPECT_NE(found.poses[4].unused.find("corners"), std::string::npos) << found.poses[4].unused;
  EXPECT_LT((found.found.X_BC.translation() - bench.X_BC.translation()).norm(), 0.006);
  EXPECT_LT(to_degrees(rotation_between(found.found.X_BC, bench.X_BC)), 0.2);
}

TEST(Calibration, PosesWithoutALineComeBackWhereBeamsMeetTheBoard) {
  Bench bench;
  bench.corner_sigma_px = 0.05;
  bench.range_sigma_m = 0.008;
  std::vector<StillPose> still = bench.look(Bench::poses());
  // Somebody stands before most of one board: what is left of its line is too short to be told.
  int beams = 0, hidden = 0;
  for (const BeamMean& beam : still[5].beams) beams += beam.range_m < 4.0 ? 1 : 0;
  for (BeamMean& beam : still[5].beams) {
    if (beam.range_m < 4.0 && ++hidden <= 0.82 * beams) beam.range_m -= 0.4;
  }
  const Calibration found = calibrate(still, bench.info({0.03, -0.02, 0.02}, 1, -2, 1), {});
  EXPECT_EQ(found.used_poses, 8);
  EXPECT_TRUE(found.poses[5].unused.empty()) << found.poses[5].unused;
  EXPECT_GT(found.poses[5].points, 5);
  EXPECT_LT(found.poses[5].points, 0.25 * beams);
  EXPECT_LT((found.found.X_BC.translation() - bench.X_BC.translation()).norm(), 0.006);
}

TEST(Calibration, LinesThatAgreeGoBeforeMoreThatTheGuessTold) {
  Bench bench;
  bench.corner_sigma_px = 0.05;
  bench.range_sigma_m = 0.004;
  std::vector<StillPose> still = bench.look(Bench::poses());
  // Beside each board a panel on its left, nearer to where a camera thought too far left has it; two boards are hidden.
  const double off_m[] = {0.15, -0.2, -0.15, 0.2, -0.15, 0.2, -0.2, 0.15};
  for (std::size_t i = 0; i < still.size(); ++i) {
    const auto at = [](const BeamMean& beam) {
      return Eigen::Vector2d(beam.range_m * std::cos(beam.angle), beam.range_m * std::sin(beam.angle));
    };
    std::vector<BeamMean>& beams = still[i].beams;
    const auto is_near = [](const BeamMean& beam) { return beam.range_m < 4.0; };
    const auto first = std::find_if(beams.begin(), beams.end(), is_near), past = std::find_if_not(first, beams.end(), is_near);
    const Eigen::Vector2d along = at(*(past - 1)) - at(*first), from = at(*(past - 1)) + 0.15 * along, normal(-along.y(), along.x());
    for (auto beam = past; beam < beams.end(); ++beam) {
      const Eigen::Vector2d ray(std::cos(beam->angle), std::sin(beam->angle));
      const double range = normal.dot(from) / normal.dot(ray), way = (range * ray - from).dot(along) / along.squaredNorm();
      if (range > 0.0 && way > 0.0 && way < 1.0) beam->range_m = range + off_m[i];
    }
    if (i < 2) std::for_each(first, past, [](BeamMean& beam) { beam.range_m = 5.0; });
  }
  CalibrateConfig config;
  config.guess = {.distance_m = 1.0, .angle_deg = 10.0};
  const Calibration found = calibrate(still, bench.info({0, 0.6, 0}), config);
  EXPECT_EQ(found.used_poses, 6);
  EXPECT_LT((found.found.X_BC.translation() - bench.X_BC.translation()).norm(), 0.01);
}

TEST(Calibration, RefusesLinesThatAgreeWithFewBoards) {
  Bench bench;
  bench.range_sigma_m = 0.004;
  std::vector<StillPose> still = bench.look(Bench::poses());
  // Something as long as the board stands before or behind each, where the guess still takes it for the board.
  const double off_m[] = {0.2, -0.15, -0.25, 0.2, 0.15, -0.2, 0.25, -0.2};
  for (std::size_t i = 0; i < still.size(); ++i) {
    for (BeamMean& beam : still[i].beams) {
      if (beam.range_m < 4.0) beam.range_m += off_m[i];
    }
  }
  EXPECT_ERROR(calibrate(still, bench.info({0, 0, 0}), {}), "the lines in the scans lie on the boards of ", " of 8 poses only",
               "expected at least 5");
}

TEST(Calibration, WithoutABiasOfItsOwnTheRangesAreTakenAsTheyRead) {
  Bench bench;
  CalibrateConfig config;
  config.refine.range_bias_m = 0.0;
  const Calibration exact = calibrate(bench.look(Bench::poses()), bench.info({0, 0, 0}), config);
  EXPECT_EQ(exact.found.bias_m, 0.0);
  EXPECT_EQ(exact.found.covariance(6, 6), 0.0);
  EXPECT_LT((exact.found.X_BC.translation() - bench.X_BC.translation()).norm(), 1e-6);
  bench.bias_m = 0.02;
  const Calibration biased = calibrate(bench.look(Bench::poses()), bench.info({0, 0, 0}), config);
  EXPECT_GT((biased.found.X_BC.translation() - bench.X_BC.translation()).norm(), 0.01) << "which is what the bias is estimated for";
}

TEST(Calibration, SaysThatNoBoardWasSeen) {
  class Grey : public SensorStream {
   public:
    explicit Grey(StreamInfo info) : info_(std::move(info)) {}
    const StreamInfo& info() const override { return info_; }
    std::optional<SensorEvent> next() override {
      if (++frames_ > 3) return std::nullopt;
      RgbdFrame frame;
      frame.stamp = frames_;
      frame.sensor = "camera";
      frame.colour = cv::Mat(90, 160, CV_8UC3, cv::Scalar::all(120));
      return frame;
    }

   private:
    StreamInfo info_;
    int frames_ = 0;
  };
  Grey stream(Bench().info({0, 0, 0}));
  CalibrateConfig config;
  config.board.columns = 7;
  EXPECT_ERROR(calibrate(stream, config), "of 3 frames 0 show a whole checkerboard with 7 x 6 inner corners", "--board");
}

TEST(Calibration, SaysWhichSensorsThereAre) {
  const Bench bench;
  StreamInfo info = bench.info({0, 0, 0});
  const std::vector<StillPose> still = bench.look(Bench::poses());
  CalibrateConfig config;
  config.camera = "left";
  EXPECT_ERROR(calibrate(still, info, config), "calibrate.camera: 'left'", "camera");
  info.lasers["rear"] = info.lasers["laser"];
  EXPECT_ERROR(calibrate(still, info, CalibrateConfig{}), "calibrate.laser: there are several", "laser, rear");
  info.lasers.clear();
  EXPECT_ERROR(calibrate(still, info, CalibrateConfig{}), "there is no laser");
  EXPECT_ERROR(calibrate(std::vector<StillPose>{}, bench.info({0, 0, 0}), CalibrateConfig{}), "0 board poses");
}

#else
TEST(Calibration, SaysWhichPackageIsMissing) { EXPECT_ERROR(expect_refinement(), "built without Ceres", "libceres-dev"); }
#endif

TEST(Lens, CornersGiveTheIntrinsicsWithinTheirSigmas) {
  Bench bench;
  bench.corner_sigma_px = 0.05;
  std::vector<std::vector<Eigen::Vector2d>> corners;
  for (const StillPose& pose : bench.look(Bench::poses())) corners.push_back(pose.corners);
  Intrinsics given = bench.k;
  given.fx = given.fy = 600.0;
  const LensEstimate lens = estimate_lens(corners, bench.board, given, {.estimate = true, .distortion = false});
  const double truth[] = {640, 636, 639.5, 359.5};
  for (int i = 0; i < 4; ++i) {
    EXPECT_GT(lens.sigmas[i], 0.0);
    EXPECT_LT(lens.sigmas[i], 3.0);
    EXPECT_LT(std::abs(lens.values[i] - truth[i]), 4.0 * lens.sigmas[i]) << i;
  }
  EXPECT_EQ(lens.values.tail<4>().norm(), 0.0);
  corners.resize(2);
  EXPECT_ERROR(estimate_lens(corners, bench.board, given, {}), "--intrinsics", "at least 3");
}

// A board drawn flat into a picture, turned a little; its inner corners are 40 px apart.
cv::Mat drawn_board(double x, double y) {
  cv::Mat flat(8 * 40, 11 * 40, CV_8UC3, cv::Scalar::all(220));
  for (int row = 0; row < 7; ++row) {
    for (int column = row % 2; column < 10; column += 2) {
      cv::rectangle(flat, {20 + 40 * column, 20 + 40 * row, 40, 40}, cv::Scalar::all(30), cv::FILLED);
    }
  }
  cv::Mat picture, turn = cv::getRotationMatrix2D({0, 0}, 8.0, 1.0);
  turn.at<double>(0, 2) += x;
  turn.at<double>(1, 2) += y;
  cv::warpAffine(flat, picture, turn, {720, 540}, cv::INTER_LINEAR, cv::BORDER_CONSTANT, cv::Scalar::all(120));
  return picture;
}

TEST(CheckerBoard, CornersAreFoundToAFractionOfAPixel) {
  const CheckerBoard board;
  const auto corners = find_corners(drawn_board(100, 150), board);
  ASSERT_TRUE(corners);
  ASSERT_EQ(corners->size(), 54u);
  const double c = std::cos(to_radians(8)), s = std::sin(to_radians(8));
  for (int i = 0; i < 54; ++i) {
    // Squares begin at the left edge of their first pixel.
    const double x = 20 + 40 * (i % 9 + 1) - 0.5, y = 20 + 40 * (i / 9 + 1) - 0.5;
    const Eigen::Vector2d expected(c * x + s * y + 100, -s * x + c * y + 150);
    EXPECT_LT(((*corners)[static_cast<std::size_t>(i)] - expected).norm(), 0.15) << i;
  }
  EXPECT_FALSE(find_corners(cv::Mat(540, 720, CV_8UC3, cv::Scalar::all(120)), board));
  EXPECT_FALSE(find_corners(drawn_board(100, 150), CheckerBoard{.columns = 8, .rows = 6}));
  EXPECT_TRUE(find_corners_again(drawn_board(100.2, 150), board, *corners, 0.5));
  EXPECT_FALSE(find_corners_again(drawn_board(101, 150), board, *corners, 0.5));
  EXPECT_FALSE(find_corners_again(drawn_board(112, 150), board, *corners, 0.5)) << "a board that moved out of the corners' windows";
  EXPECT_FALSE(find_corners_again(cv::Mat(540, 720, CV_8UC3, cv::Scalar::all(120)), board, *corners, 0.5));
}

TEST(StillPoses, CountWhatStandsStillBetweenItsFirstAndLastFrame) {
  StillPoses poses({}, {.still_px = 0.5, .frames = 3, .scans = 5});
  constexpr Stamp kFrame = 100'000'000, kScan = 40'000'000;
  Stamp next_scan = 0;
  const auto frame = [&](int number, const cv::Mat& picture) {
    for (; next_scan < number * kFrame; next_scan += kScan) {
      LaserScan scan;
      scan.stamp = next_scan;
      scan.angle_min = -1.0;
      scan.angle_increment = 0.5;
      scan.beam_interval = 1'000'000;
      // The third beam reads nothing every second time.
      scan.ranges = {2.0f, next_scan % (2 * kScan) == 0 ? 3.0f : 3.02f, next_scan % (2 * kScan) == 0 ? 4.0f : 0.0f};
      poses.add(scan);
    }
    RgbdFrame rgbd;
    rgbd.stamp = number * kFrame;
    rgbd.colour = picture;
    poses.add(rgbd);
  };
  const cv::Mat here = drawn_board(60, 120), there = drawn_board(150, 180), none(540, 720, CV_8UC3, cv::Scalar::all(120));
  int n = 0;
  for (int i = 0; i < 6; ++i) frame(n++, here);
  frame(n++, drawn_board(90, 140));
  frame(n++, none);
  for (int i = 0; i < 5; ++i) frame(n++, there);  // 0.8 to 1.2 s
  frame(n++, none);
  for (int i = 0; i < 4; ++i) frame(n++, drawn_board(70, 190));  // too few
  for (int i = 0; i < 5; ++i) frame(n++, there);                 // once more: the same pose
  const std::vector<StillPose> found = poses.finish();
  EXPECT_EQ(poses.frames(), n);
  EXPECT_EQ(poses.frames_with_board(), n - 2);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].begin, kFrame);
  EXPECT_EQ(found[0].end, 4 * kFrame);
  EXPECT_EQ(found[0].frames, 4);
  EXPECT_EQ(found[0].scans, 7) << "those from 0.12 to 0.36 s";
  EXPECT_EQ(found[1].frames, 3 + 3);
  ASSERT_EQ(found[0].beams.size(), 3u);
  EXPECT_NEAR(found[0].beams[1].angle, -0.5, 1e-12);
  EXPECT_NEAR(found[0].beams[1].range_m, (3 * 3.02 + 4 * 3.0 + (3.0 - 3.0)) / 7, 0.003);
  EXPECT_NEAR(found[0].beams[1].sigma_m, 0.0107, 0.0005);
  EXPECT_LT(found[0].beams[2].readings, 5);
  EXPECT_NEAR(found[0].beams[2].range_m, 4.0, 1e-9);
}

#ifdef WARETWIN_CERES
TEST(Extrinsics, FilesReadBackAndMoveTheCameraWithItsLaser) {
  const test::TemporaryFolder folder;
  Bench bench;
  bench.range_sigma_m = 0.008;
  bench.corner_sigma_px = 0.05;
  const Calibration found = calibrate(bench.look(Bench::poses()), bench.info({0.02, 0, 0}), {});
  const std::filesystem::path file = folder.path() / "extrinsics.yaml";
  write_file(file, extrinsics_yaml(extrinsics_of(found), "bench"));
  const Extrinsics read = read_extrinsics(file);
  EXPECT_EQ(read.X_BC, extrinsics_of(found).X_BC);
  EXPECT_EQ(read.poses, 8);
  EXPECT_EQ(read.covariance.size(), 36u);
  EXPECT_NEAR(rotation_between(read.mount.X_BC(), found.found.X_BC), 0.0, 1e-9);
  EXPECT_LT((read.mount.X_BC().translation() - found.found.X_BC.translation()).norm(), 1e-9);

  const StreamInfo before = bench.info({0.5, 0.4, 0.3}, 20);
  EXPECT_EQ(told_by_extrinsics(before, "").cameras.at("camera").X_BC.matrix(), before.cameras.at("camera").X_BC.matrix());
  EXPECT_TRUE(told_by_extrinsics(before, file).cameras.at("camera").X_BC.isApprox(found.found.X_BC, 1e-12));
  StreamInfo moved = before;
  moved.lasers["laser"].X_BL = make_upright_pose(1, 2, 0.5, 0.7);
  const StreamInfo told = told_by_extrinsics(moved, file);
  EXPECT_TRUE(
      (told.lasers.at("laser").X_BL.inverse() * told.cameras.at("camera").X_BC).isApprox(bench.X_BL.inverse() * found.found.X_BC, 1e-12));

  StreamInfo other = before;
  other.cameras.clear();
  EXPECT_ERROR(told_by_extrinsics(other, file), "extrinsics.yaml", "'camera' is not in bench", "none");
  std::string text = read_file(file);
  text.replace(text.find("X_BC: [") + 7, 2, "5,");
  text.replace(text.find("camera: camera"), 14, "camera: kamera");
  write_file(folder.path() / "bad.yaml", text);
  EXPECT_ERROR(read_extrinsics(folder.path() / "bad.yaml"), "bad.yaml", "X_BC");
  write_file(folder.path() / "short.yaml", "camera: a\nlaser: b\nX_BC: [1, 0]\nX_BL: [1]\n");
  EXPECT_ERROR(read_extrinsics(folder.path() / "short.yaml"), "short.yaml", "X_BC", "12");
  EXPECT_ERROR(read_extrinsics(folder.path() / "none.yaml"), "none.yaml");
}
#endif

TEST(CalibrationTruth, HoldsTheBracketsOfBothSensors) {
  Scenario scenario;
  scenario.seed = 3;
  scenario.sensors.cameras["camera"].mount.bracket = {0.02, 1.0};
  scenario.sensors.lasers["laser"];
  const Pose drawn = scenario.sensors.cameras["camera"].mount.X_BC();
  const CalibrationTruth camera_off = true_calibration(scenario, "camera", "laser");
  EXPECT_GT((camera_off.X_BC.translation() - drawn.translation()).norm(), 1e-3);
  EXPECT_GT(std::abs(camera_off.range_bias_m), 1e-6);
  // A laser that is off by itself moves the camera against it.
  scenario.sensors.lasers["laser"].mount.bracket = {0.02, 1.0};
  EXPECT_GT((true_calibration(scenario, "camera", "laser").X_BC.translation() - camera_off.X_BC.translation()).norm(), 1e-3);
}

}  // namespace
}  // namespace waretwin

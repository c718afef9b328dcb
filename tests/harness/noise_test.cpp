#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <cmath>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>

#include "core/config.h"
#include "core/parallel.h"
#include "core/pose.h"
#include "core/random.h"
#include "harness/noise/noise_report.h"
#include "sensors/recordings/recording.h"
#include "sensors/time_of_flight.h"
#include "tests/support/expect_error.h"
#include "tests/support/test_data.h"

namespace waretwin {
namespace {

// A plane whose nearest point lies `distance` metres away in the direction that is `tilt` degrees off the optical axis.
struct Plane {
  double distance, tilt_deg;
  Eigen::Vector3d normal() const { return {std::sin(to_radians(tilt_deg)), 0.0, std::cos(to_radians(tilt_deg))}; }
  // Along the optical axis; 0 where the ray misses it.
  double depth(const cv::Vec3f& ray) const {
    const double towards = normal().dot(Eigen::Vector3d(ray[0], ray[1], ray[2]));
    return towards > 1e-6 ? distance / towards : 0.0;
  }
};

cv::Mat pinhole_rays() { return rays_of(Lens(Intrinsics::checked(640, 480, 525, 525, 319.5, 239.5))); }
// The same view with fewer pixels, for whole surveys.
cv::Mat coarse_rays() { return rays_of(Lens(Intrinsics::checked(320, 240, 262.5, 262.5, 159.5, 119.5))); }

// Planes seen from 0.6 to 3.6 m, up to 60 degrees from the side.
std::vector<Plane> many_planes() {
  std::vector<Plane> planes;
  for (const double tilt : {0.0, 20.0, 40.0, 55.0}) {
    for (double distance = 0.6; distance <= 3.65; distance += 0.5) planes.push_back({distance * std::cos(to_radians(tilt)), tilt});
  }
  return planes;
}

double whole_millimetres(double metres) { return std::round(metres * 1000.0) * 0.001; }

cv::Mat gaussian_image(const Plane& plane, const cv::Mat& rays, double base, double growth, Stamp stamp) {
  const RandomStream random(11, "test", "noise", stamp);
  cv::Mat depth(rays.size(), CV_32FC1, cv::Scalar(0));
  for (int i = 0; i < static_cast<int>(rays.total()); ++i) {
    const double z = plane.depth(rays.ptr<cv::Vec3f>()[i]);
    if (z <= 0.0 || z > 6.0) continue;
    const double noise = (base + growth * z * z) * random.normal(static_cast<std::uint64_t>(i));
    depth.ptr<float>()[i] = static_cast<float>(whole_millimetres(z + noise));
  }
  return depth;
}

NoiseSurvey survey_gaussian(double base, double growth) {
  const cv::Mat rays = coarse_rays();
  NoiseSurveyor surveyor(rays, 0.3, 6.0, NoiseConfig());
  Stamp stamp = 0;
  for (const Plane& plane : many_planes()) surveyor.add(gaussian_image(plane, rays, base, growth, ++stamp));
  return surveyor.result();
}

bool holds(const Estimate& estimate, double value) { return estimate.low <= value && value <= estimate.high; }

TEST(NoiseSurvey, FindsTheGaussianLawThatWasPutIn) {
  for (const auto& [base, growth] : {std::pair{0.0005, 0.0005}, {0.001, 0.002}, {0.003, 0.0007}}) {
    SCOPED_TRACE(base);
    const NoiseSurvey survey = survey_gaussian(base, growth);
    ASSERT_TRUE(survey.gaussian);
    EXPECT_TRUE(holds(survey.gaussian->base_m, base)) << noise_text(survey);
    EXPECT_TRUE(holds(survey.gaussian->growth_per_m, growth)) << noise_text(survey);
    EXPECT_NEAR(survey.gaussian->base_m.value, base, 0.1 * base);
    EXPECT_NEAR(survey.gaussian->growth_per_m.value, growth, 0.1 * growth);
    // Three numbers of 144 went into the plane, which leaves independent errors a little opposed.
    EXPECT_NEAR(survey.correlation, -3.0 / 144.0, 0.015);
    EXPECT_EQ(better_law(survey), "gaussian");
    EXPECT_GT(survey.patches.planar, 9 * survey.patches.looked_at / 10 - survey.patches.few_readings);
  }
}

// Every cell holds the deviation that its patches had, whatever the angle.
TEST(NoiseSurvey, CellsHoldTheDeviationOfTheirPatches) {
  const NoiseSurvey survey = survey_gaussian(0.001, 0.002);
  ASSERT_GT(survey.cells.size(), 15u);
  double steepest = 0.0;
  for (const NoiseCell& cell : survey.cells) {
    const double chance = 0.5 * (cell.sigma_z.high - cell.sigma_z.low);
    EXPECT_NEAR(cell.sigma_z.value, 0.001 + 0.002 * cell.depth_m * cell.depth_m, 0.03 * cell.sigma_z.value + chance) << cell.depth_m;
    EXPECT_GE(cell.sigma_r.value, cell.sigma_z.value);
    steepest = std::max(steepest, cell.incidence_from_deg);
  }
  EXPECT_GE(steepest, 60.0);
}

TEST(NoiseSurvey, FindsTheNoiseOfATimeOfFlightCamera) {
  CameraConfig camera;
  camera.time_of_flight.noise_m = 0.0013;
  const TimeOfFlightModel model(camera, 5, "camera");
  NoiseConfig config;
  config.reflectivity = 0.4;
  NoiseSurveyor surveyor(model.rays(), camera.depth_min_m, camera.depth_max_m, config);
  NoiseConfig brighter_config;
  brighter_config.reflectivity = 2.0 * config.reflectivity;
  NoiseSurveyor brighter(model.rays(), camera.depth_min_m, camera.depth_max_m, brighter_config);
  Stamp stamp = 0;
  for (const Plane& plane : many_planes()) {
    const cv::Size size = model.rays().size();
    TimeOfFlightSignal light{
        {size, CV_32FC1, cv::Scalar(0)}, {size, CV_32FC1, cv::Scalar(0)}, {size, CV_32FC1, cv::Scalar(1)}, {size, CV_32FC1, cv::Scalar(0)}};
    for (int i = 0; i < size.area(); ++i) {
      const cv::Vec3f ray = model.rays().ptr<cv::Vec3f>()[i];
      const double z = ray[2] == 0.0f ? 0.0 : plane.depth(ray);
      if (z <= 0.0 || z > 10.0) continue;
      const double length = cv::norm(ray), range = z * length;
      light.range.ptr<float>()[i] = static_cast<float>(range);
      // The cosine of incidence is the plane's distance over the range.
      light.signal.ptr<float>()[i] = static_cast<float>(config.reflectivity * plane.distance / range / (range * range));
    }
    const cv::Mat depth = model.read(light, ++stamp);
    surveyor.add(depth);
    brighter.add(depth);
  }
  const NoiseSurvey survey = surveyor.result();
  ASSERT_TRUE(survey.time_of_flight && survey.gaussian);
  EXPECT_NEAR(survey.time_of_flight->noise_m.value, 0.0013, 0.1 * 0.0013) << noise_text(survey);
  EXPECT_TRUE(holds(survey.time_of_flight->noise_m, 0.0013)) << noise_text(survey);
  EXPECT_EQ(better_law(survey), "time_of_flight");
  EXPECT_LT(survey.time_of_flight->relative_rms, 0.05);
  // Told that the surfaces are brighter than they are, it takes the camera for a noisier one.
  EXPECT_GT(brighter.result().time_of_flight->noise_m.value, 1.5 * 0.0013);
}

TEST(NoiseSurvey, CountsMissingPixelsByRange) {
  const cv::Mat rays = pinhole_rays();
  cv::Mat depth = gaussian_image({2.1, 0.0}, rays, 0.001, 0.001, 1);
  // Every tenth pixel of all, and the left third as a whole, which belongs to no range.
  for (int i = 0; i < static_cast<int>(depth.total()); i += 10) depth.ptr<float>()[i] = 0.0f;
  depth.colRange(0, 216).setTo(0);
  NoiseSurveyor surveyor(rays, 0.3, 6.0, NoiseConfig());
  surveyor.add(depth);
  const NoiseSurvey survey = surveyor.result();
  EXPECT_NEAR(survey.planar_missing_share, 0.1, 0.005);
  EXPECT_NEAR(survey.missing_share, 0.1 + 0.9 * 216.0 / 640.0, 0.005);
  for (const MissingByRange& row : survey.missing) {
    EXPECT_GE(row.from_m, 2.0);
    if (row.pixels > 10000) {
      EXPECT_NEAR(row.share(), 0.1, 0.01);
    }
  }
  EXPECT_EQ(survey.patches.few_readings, 216 / 12 * 40);
}

TEST(NoiseSurvey, IsTheSameAtAnyNumberOfThreads) {
  set_thread_count(1);
  const std::string one = noise_json(survey_gaussian(0.001, 0.002));
  set_thread_count(4);
  const std::string four = noise_json(survey_gaussian(0.001, 0.002));
  set_thread_count(0);
  EXPECT_EQ(one, four);
}

TEST(NoiseSurvey, GivesKeysThatAScenarioTakes) {
  NoiseSurvey survey = survey_gaussian(0.001, 0.002);
  survey.calibration.intrinsics = Intrinsics::from_field_of_view(640, 480, to_radians(62.7), to_radians(49.1));
  survey.calibration.depth_min_m = 0.4;
  survey.calibration.depth_max_m = 5.0;
  CameraConfig camera;
  read_config_text(noise_yaml(survey, 0), "noise.yaml", [&](Fields& f) { camera.visit(f); });
  EXPECT_EQ(camera.depth_model, "gaussian");
  EXPECT_NEAR(camera.noise.sigma_base_m, survey.gaussian->base_m.value, 1e-6);
  EXPECT_NEAR(camera.noise.sigma_per_m2, survey.gaussian->growth_per_m.value, 1e-6);
  EXPECT_EQ(camera.width, 640);
  EXPECT_NEAR(camera.horizontal_fov_deg, 62.7, 0.01);
  EXPECT_EQ(camera.field.shape, survey.missing_share < 0.25 ? "rectangle" : "hexagon");
  survey.time_of_flight->misfit = 0.5 * survey.gaussian->misfit;
  read_config_text(noise_yaml(survey, 2), "noise.yaml", [&](Fields& f) { camera.visit(f); });
  EXPECT_EQ(camera.depth_model, "time_of_flight");
  EXPECT_NEAR(camera.time_of_flight.noise_m, survey.time_of_flight->noise_m.value, 1e-6);
}

TEST(NoiseSurvey, SaysWhyThereIsNothingToMeasure) {
  const cv::Mat rays = pinhole_rays();
  NoiseSurveyor empty(rays, 0.3, 6.0, NoiseConfig());
  empty.add(cv::Mat(rays.size(), CV_32FC1, cv::Scalar(0)));
  EXPECT_ERROR(empty.result(), "no planes were found in 2120 patches", "2120 with too few readings");
  NoiseSurveyor few(rays, 0.3, 6.0, NoiseConfig());
  cv::Mat corner(rays.size(), CV_32FC1, cv::Scalar(0));
  gaussian_image({1.0, 0.0}, rays, 0.001, 0.001, 1)(cv::Rect(0, 0, 36, 36)).copyTo(corner(cv::Rect(0, 0, 36, 36)));
  few.add(corner);
  EXPECT_ERROR(few.result(), "only 9 planar patches", "--frames");
}

class OnePatch : public ::testing::Test {
 protected:
  // As a survey of independent errors takes it.
  PlanePatch measure() const {
    PlanePatch patch = measure_patch(depth_, rays_, area_, NoiseConfig());
    if (patch.verdict == PatchVerdict::kPlane && patch.structure > structure_limit(patch.readings, 0.0, NoiseConfig())) {
      patch.verdict = PatchVerdict::kStructured;
    }
    return patch;
  }
  void add_noise(double sigma) {
    const RandomStream random(3, "test", "patch");
    for (int v = 0; v < 12; ++v) {
      for (int u = 0; u < 12; ++u) {
        depth_.at<float>(area_.y + v, area_.x + u) += static_cast<float>(sigma * random.normal(static_cast<std::uint64_t>(12 * v + u)));
      }
    }
  }
  void set(const Plane& plane) {
    for (int i = 0; i < static_cast<int>(rays_.total()); ++i) {
      depth_.ptr<float>()[i] = static_cast<float>(plane.depth(rays_.ptr<cv::Vec3f>()[i]));
    }
  }
  cv::Mat rays_ = pinhole_rays();
  cv::Mat depth_{rays_.size(), CV_32FC1, cv::Scalar(2.0)};
  cv::Rect area_{400, 300, 12, 12};
};

TEST_F(OnePatch, KnowsWhereThePlaneIs) {
  for (const double tilt : {-50.0, 0.0, 30.0, 65.0}) {
    const Plane plane{0.8, tilt};
    set(plane);
    const PlanePatch patch = measure();
    ASSERT_EQ(patch.verdict, PatchVerdict::kPlane) << tilt;
    const cv::Vec3f ray = rays_.at<cv::Vec3f>(305, 405);
    const double range = plane.depth(ray) * cv::norm(ray);
    EXPECT_NEAR(patch.range_m, range, 0.02 * range);
    EXPECT_NEAR(patch.cosine, plane.distance / range, 0.01);
    // Nothing scatters: what is left is the rounding that was not there, on top of that of 32-bit floats.
    EXPECT_NEAR(patch.variance_z, -1e-6 / 12.0, 1e-10);
    EXPECT_NEAR(patch.variance_r, -1e-6 / 12.0 * (patch.range_m / patch.depth_m) * (patch.range_m / patch.depth_m), 1e-10);
  }
}

// The fit against the plainest one: the plane in space through all points, by the smallest singular value.
TEST_F(OnePatch, AgreesWithAPlaneInSpace) {
  set({1.7, 40.0});
  add_noise(0.004);
  const PlanePatch patch = measure();
  ASSERT_EQ(patch.verdict, PatchVerdict::kPlane);
  Eigen::MatrixXd points(144, 3);
  for (int i = 0; i < 144; ++i) {
    const cv::Vec3f ray = rays_.at<cv::Vec3f>(area_.y + i / 12, area_.x + i % 12);
    const auto z = static_cast<double>(depth_.at<float>(area_.y + i / 12, area_.x + i % 12));
    points.row(i) = z * Eigen::Vector3d(ray[0], ray[1], 1.0).transpose();
  }
  const Eigen::RowVector3d mean = points.colwise().mean();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(points.rowwise() - mean, Eigen::ComputeThinV);
  const Eigen::Vector3d n = svd.matrixV().col(2);
  double squares = 0.0;
  for (int i = 0; i < 144; ++i) {
    const cv::Vec3f ray = rays_.at<cv::Vec3f>(area_.y + i / 12, area_.x + i % 12);
    const double on_plane = mean.dot(n) / n.dot(Eigen::Vector3d(ray[0], ray[1], 1.0));
    squares += std::pow(static_cast<double>(depth_.at<float>(area_.y + i / 12, area_.x + i % 12)) - on_plane, 2);
  }
  // That plane has the least distances across itself; along the optical axis the patch's own can only be nearer.
  const double variance = patch.variance_z + 1e-6 / 12.0;
  EXPECT_LE(variance, squares / 141.0);
  EXPECT_GE(variance, 0.95 * squares / 141.0);
}

TEST_F(OnePatch, RefusesEdgesCurvesHolesAndFlatViews) {
  add_noise(0.003);
  EXPECT_EQ(measure().verdict, PatchVerdict::kPlane);
  const cv::Mat plain = depth_.clone();
  for (int column = 1; column < 12; ++column) {
    depth_ = plain.clone();
    depth_(cv::Rect(area_.x + column, area_.y, 12 - column, 12)) += cv::Scalar(0.05);
    EXPECT_EQ(measure().verdict, PatchVerdict::kStructured) << "an edge at column " << column;
  }
  for (int sum = 3; sum < 20; ++sum) {
    depth_ = plain.clone();
    for (int v = 0; v < 12; ++v) {
      for (int u = 0; u < 12; ++u) depth_.at<float>(area_.y + v, area_.x + u) += u + v > sum ? 0.05f : 0.0f;
    }
    EXPECT_EQ(measure().verdict, PatchVerdict::kStructured) << "a slanting edge at " << sum;
  }
  depth_ = plain.clone();
  depth_.at<float>(305, 405) += 0.05f;
  EXPECT_EQ(measure().verdict, PatchVerdict::kStructured) << "a flying pixel";
  // A pipe of 3 cm.
  for (int u = 0; u < 12; ++u) {
    const double side = (u - 5.5) * 2.0 / 525.0;
    depth_.col(area_.x + u) = plain.col(area_.x + u) + cv::Scalar(0.03 - std::sqrt(0.03 * 0.03 - side * side));
  }
  EXPECT_EQ(measure().verdict, PatchVerdict::kStructured) << "a pipe";
  depth_ = plain.clone();
  depth_(cv::Rect(area_.x, area_.y, 12, 3)).setTo(0);
  EXPECT_EQ(measure().verdict, PatchVerdict::kFewReadings);
  EXPECT_EQ(measure().readings, 108);
  set({0.3, 70.0});
  EXPECT_EQ(measure().verdict, PatchVerdict::kPlane) << "this side of the image sees it less flat";
  area_.x = 200;
  EXPECT_EQ(measure().verdict, PatchVerdict::kGrazing);
}

TEST_F(OnePatch, TellsCorrelatedNeighbours) {
  add_noise(0.003);
  EXPECT_NEAR(measure().correlation, 0.0, 0.25);
  const double independent = structure_limit(144, 0.0, NoiseConfig());
  EXPECT_LT(measure().structure, independent);
  // Each reading twice, as in an image that was made larger.
  for (int u = 1; u < 12; u += 2) depth_.col(area_.x + u - 1).copyTo(depth_.col(area_.x + u));
  EXPECT_GT(measure().correlation, 0.3);
  // Such an image has structure by itself: as much as one of a quarter of the readings has.
  EXPECT_GT(structure_limit(144, 0.5, NoiseConfig()), 2.0 * independent);
}

NoiseCell cell_at(double depth, double sigma, double share = 0.01) {
  NoiseCell cell;
  cell.depth_m = depth;
  cell.shape = depth;
  cell.sigma_z = cell.sigma_r = {sigma, sigma * (1 - share), sigma * (1 + share)};
  return cell;
}

TEST(NoiseLaws, AreExactOnExactCells) {
  std::vector<NoiseCell> cells;
  for (const double z : {0.5, 1.0, 2.0, 3.0, 4.0}) cells.push_back(cell_at(z, 0.001 + 0.0004 * z * z));
  const auto law = fit_gaussian_law(cells);
  ASSERT_TRUE(law);
  EXPECT_NEAR(law->base_m.value, 0.001, 1e-12);
  EXPECT_NEAR(law->growth_per_m.value, 0.0004, 1e-12);
  EXPECT_NEAR(law->misfit, 0.0, 1e-12);
  EXPECT_FALSE(law->at_limit);
  for (NoiseCell& cell : cells) cell.sigma_r = {0.002 * cell.shape, 0.0019 * cell.shape, 0.0021 * cell.shape};
  const auto light = fit_time_of_flight_law(cells);
  ASSERT_TRUE(light);
  EXPECT_NEAR(light->noise_m.value, 0.002, 1e-12);
}

TEST(NoiseLaws, KeepNumbersThatAScenarioTakes) {
  std::vector<NoiseCell> cells;
  for (const double z : {1.0, 2.0, 3.0, 4.0}) cells.push_back(cell_at(z, 0.001 * z * z * z));
  const auto law = fit_gaussian_law(cells);
  ASSERT_TRUE(law);
  EXPECT_TRUE(law->at_limit);
  EXPECT_EQ(law->base_m.value, 0.0);
  EXPECT_GT(law->growth_per_m.value, 0.001);
  cells.clear();
  for (const double z : {1.0, 2.0, 3.0, 4.0}) cells.push_back(cell_at(z, 0.01 - 0.0005 * z * z));
  const auto falling = fit_gaussian_law(cells);
  ASSERT_TRUE(falling);
  EXPECT_TRUE(falling->at_limit);
  EXPECT_EQ(falling->growth_per_m.value, 0.0);
}

TEST(NoiseLaws, AreNotMadeUp) {
  EXPECT_FALSE(fit_gaussian_law({cell_at(1, 0.001), cell_at(2, 0.002)}));
  EXPECT_FALSE(fit_gaussian_law({cell_at(2, 0.001), cell_at(2, 0.002), cell_at(2, 0.003)}));
  EXPECT_FALSE(fit_gaussian_law({cell_at(1, 0.0), cell_at(2, 0.0), cell_at(3, 0.001)})) << "drowned in the rounding";
  EXPECT_FALSE(fit_time_of_flight_law({cell_at(1, 0.001)}));
}

// In 95 of 100 worlds the interval holds the truth; cells are trusted a little less than they could be (2 %), so it may be a few more.
TEST(NoiseLaws, IntervalsHoldTheTruthAsOftenAsTheySay) {
  constexpr int kWorlds = 1000;
  int base_held = 0, growth_held = 0, light_held = 0;
  for (int world = 0; world < kWorlds; ++world) {
    const RandomStream random(17, "test", "world", world);
    std::vector<NoiseCell> cells;
    for (int i = 0; i < 12; ++i) {
      const double z = 0.6 + 0.3 * i, sigma = 0.001 + 0.0008 * z * z, error = 0.06;
      NoiseCell cell = cell_at(z, sigma * (1.0 + error * random.normal(static_cast<std::uint64_t>(i))), 1.96 * error);
      const double light = 0.002 * z * (1.0 + error * random.normal(static_cast<std::uint64_t>(i), 1));
      cell.sigma_r = {light, light * (1 - 1.96 * error), light * (1 + 1.96 * error)};
      cells.push_back(cell);
    }
    const auto law = fit_gaussian_law(cells);
    const auto tof = fit_time_of_flight_law(cells);
    ASSERT_TRUE(law && tof);
    base_held += holds(law->base_m, 0.001);
    growth_held += holds(law->growth_per_m, 0.0008);
    light_held += holds(tof->noise_m, 0.002);
  }
  // Three standard deviations of a share of 0.95 are 0.021.
  for (const int held : {base_held, growth_held, light_held}) {
    EXPECT_GE(held, 929);
    EXPECT_LE(held, 993);
  }
}

TEST(NoiseLaws, MediansOfVariancesAreUnbiasedAndTheirIntervalsHold) {
  constexpr int kWorlds = 400, kPatches = 60, kReadings = 20;
  int held = 0;
  double sum = 0.0;
  for (int world = 0; world < kWorlds; ++world) {
    const RandomStream random(23, "test", "variances", world);
    std::vector<double> variances;
    for (int patch = 0; patch < kPatches; ++patch) {
      double squares = 0.0;
      for (int i = 0; i < kReadings; ++i) squares += std::pow(random.normal(static_cast<std::uint64_t>(patch * kReadings + i)), 2);
      variances.push_back(9.0 * squares / kReadings);
    }
    const Estimate sigma = sigma_of_variances(variances, kReadings);
    sum += sigma.value;
    held += holds(sigma, 3.0);
  }
  // A patch's deviation scatters by 3 / sqrt(40), the median of 60 by 1.25 / sqrt(60) of that: 0.077 a world, 0.0038 on average.
  EXPECT_NEAR(sum / kWorlds, 3.0, 0.015);
  EXPECT_GE(held, static_cast<int>(kWorlds * (0.95 - 3 * 0.011)));
  const Estimate rounded = sigma_of_variances({-1.0, -0.5, 4.0}, 100);
  EXPECT_EQ(rounded.value, 0.0);
  EXPECT_EQ(rounded.low, 0.0);
}

TEST(NoiseLaws, StudentsTable) {
  for (const auto& [freedom, value] : {std::pair{1.0, 12.706}, {2.0, 4.303}, {3.0, 3.182}, {5.0, 2.571}, {10.0, 2.228}, {30.0, 2.042}}) {
    EXPECT_NEAR(student_95(freedom), value, 0.01 * value) << freedom;
  }
}

TEST(RealNoise, OfSevenScenesGrowsWithTheSquareOfTheDepth) {
  WARETWIN_NEED_DATA("rgbd_7scenes");
  const auto recording = open_recording(test::shared_data("rgbd_7scenes"));
  const NoiseSurvey survey = survey_noise(*recording, NoiseConfig());
  ASSERT_TRUE(survey.gaussian);
  // Structured light: nearly all of it grows with the square of the depth, and more steeply than the Azure Kinect's preset.
  EXPECT_GT(survey.gaussian->growth_per_m.low, DepthNoise().sigma_per_m2);
  EXPECT_LT(survey.gaussian->base_m.value, 0.001);
  EXPECT_EQ(better_law(survey), "gaussian");
  EXPECT_GT(survey.correlation, 0.1) << "its readings are steps of disparity";
}

}  // namespace
}  // namespace waretwin

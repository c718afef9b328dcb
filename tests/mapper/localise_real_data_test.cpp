// Localisation on real scans: a CARMEN log of an office floor, and a pair of scans that traps naive ICP.
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "mapper/localise/local_map_localiser.h"
#include "mapper/localise/scan_matcher.h"
#include "mapper/localise/simple_localisers.h"
#include "sensors/recordings/recording.h"
#include "tests/support/test_data.h"

namespace waretwin {
namespace {

// The pair of data/laser_csm: JSON, a scan a line.
struct CsmScan {
  LaserScan scan;
  PlanarMotion X_OB;
};

std::vector<CsmScan> read_csm(const std::filesystem::path& file) {
  std::vector<CsmScan> scans;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    const auto json = nlohmann::json::parse(line);
    CsmScan entry;
    entry.scan.stamp = static_cast<Stamp>(scans.size()) * 100'000'000;
    entry.scan.sensor = "laser";
    entry.scan.angle_min = json["min_theta"];
    const auto beams = json["nrays"].get<int>();
    entry.scan.angle_increment = (json["max_theta"].get<double>() - entry.scan.angle_min) / (beams - 1);
    entry.scan.range_min = 0.01;
    entry.scan.range_max = 10.0;
    for (int i = 0; i < beams; ++i) {
      const bool valid = json["valid"][i].get<int>() == 1 && !json["readings"][i].is_null();
      entry.scan.ranges.push_back(valid ? json["readings"][i].get<float>() : 0.0f);
    }
    const auto& o = json["odometry"];
    entry.X_OB = {{o[0].get<double>(), o[1].get<double>()}, o[2].get<double>()};
    scans.push_back(std::move(entry));
  }
  return scans;
}

std::vector<ScanPoint> points_of(const LaserScan& scan) { return scan_points(scan, Pose::Identity(), {}, {}, ScanPointsConfig{}); }

// A scan as a map of its own.
LocalMap map_of(const std::vector<ScanPoint>& points) {
  LocalMap map(0.05);
  map.add(points, {}, 0.0, 0);
  map.finish();
  return map;
}

// Share of the points within `near` metres of a point of the reference, by looking at all pairs.
double agreement(const std::vector<ScanPoint>& reference, const std::vector<ScanPoint>& points, const PlanarMotion& X, double near) {
  int count = 0;
  for (const ScanPoint& point : points) {
    const Eigen::Vector2d p = X * point.p;
    count +=
        std::any_of(reference.begin(), reference.end(), [&](const ScanPoint& other) { return (other.p - p).squaredNorm() < near * near; })
            ? 1
            : 0;
  }
  return static_cast<double>(count) / static_cast<double>(points.size());
}

// The vehicle has moved by 0.2 m between walls 0.1 to 1 m away, and a third of what either scan sees is hidden from the other. There is no
// truth: the answer is that of most agreement among all poses near, and all starts must lead to it.
TEST(RealScans, ThePairThatTrapsNaiveIcp) {
  WARETWIN_NEED_DATA("laser_csm");
  const std::vector<CsmScan> scans = read_csm(test::shared_data("laser_csm") / "stallo2.log");
  ASSERT_EQ(scans.size(), 2u);
  const std::vector<ScanPoint> first = points_of(scans[0].scan), second = points_of(scans[1].scan);
  const LocalMap map = map_of(first);
  const PlanarMotion odometry = scans[0].X_OB.inverse() * scans[1].X_OB;
  const MapMatch best = match_to_map(map, second, {odometry, Eigen::Matrix3d::Zero()}, odometry, 0.0, {});
  EXPECT_TRUE(best.believable);
  const double agreed = agreement(first, second, best.X_SB, 0.01);
  std::cout << "moved by " << best.X_SB.translation.transpose() << " m, " << to_degrees(best.X_SB.yaw) << " deg; residual "
            << 1e3 * best.residual_m << " mm, agreement " << agreed << "\n";
  for (int x = -10; x <= 10; ++x) {
    for (int y = -10; y <= 10; y += 2) {
      for (int turn = -10; turn <= 10; turn += 5) {
        if (x == 0 && y == 0 && turn == 0) continue;
        const PlanarMotion other = best.X_SB * PlanarMotion{{0.03 * x, 0.03 * y}, to_radians(turn)};
        ASSERT_LT(agreement(first, second, other, 0.01), agreed) << x << " " << y << " " << turn;
      }
    }
  }
  // Starts as bad as a vehicle without odometry may have them, and worse. Point-to-line ICP against single scans loses its way from some
  // of them.
  std::vector<Eigen::Vector2d> first_p, second_p;
  for (const ScanPoint& point : first) first_p.push_back(point.p);
  for (const ScanPoint& point : second) second_p.push_back(point.p);
  const ReferenceScan reference(first_p, {});
  int trapped = 0;
  for (const double x : {-0.1, 0.0, 0.1, 0.3, 0.4}) {
    for (const double turn : {-20.0, 0.0, 20.0}) {
      const PlanarMotion start{{x, 0.0}, to_radians(turn)};
      const MapMatch match = match_to_map(map, second, {start, Eigen::Matrix3d::Zero()}, start, 0.0, {});
      EXPECT_TRUE(match.believable) << x << " " << turn;
      EXPECT_LT((match.X_SB.translation - best.X_SB.translation).norm(), 0.001) << x << " " << turn;
      EXPECT_LT(std::abs(to_degrees(match.X_SB.yaw - best.X_SB.yaw)), 0.1) << x << " " << turn;
      const ScanMatch icp = match_scans(reference, second_p, start, {});
      trapped += (icp.X_RS.translation - best.X_SB.translation).norm() > 0.02 ? 1 : 0;
    }
  }
  std::cout << "keyframe ICP was trapped from " << trapped << " of 15 starts\n";
  EXPECT_GT(trapped, 0) << "the pair must be a hard one";

  // And as a drive of two scans without any odometry.
  StreamInfo info;
  info.source = "stallo2";
  info.lasers["laser"] = {};
  LocalMapLocaliser localiser({}, info);
  for (const CsmScan& scan : scans) localiser.add(scan.scan);
  EXPECT_LT((localiser.current_pose()->translation().head<2>() - best.X_SB.translation).norm(), 0.01);
}

struct Window {
  double metres, degrees;
};

double at_share(std::vector<double> values, double share) {
  const auto at = static_cast<std::size_t>(share * static_cast<double>(values.size()));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
}

// The corrected pose at the end of each FLASER line.
std::vector<PlanarMotion> corrected_poses(const std::filesystem::path& file) {
  std::vector<PlanarMotion> poses;
  gzFile in = gzopen(file.c_str(), "rb");
  std::string line(1 << 16, '\0');
  while (gzgets(in, line.data(), static_cast<int>(line.size())) != nullptr) {
    std::istringstream words(line.c_str());
    std::string word;
    std::size_t count = 0;
    if (!(words >> word) || word != "FLASER") continue;
    words >> count;
    for (std::size_t i = 0; i < count; ++i) words >> word;
    PlanarMotion X;
    words >> X.translation.x() >> X.translation.y() >> X.yaw;
    poses.push_back(X);
  }
  gzclose(in);
  return poses;
}

// 212 m through an office floor. What the log's own SLAM made of it is no exact truth: its path shakes by 13 mm from scan to scan, and the
// scans themselves agree better with the poses found here. The whole way, loops included, must fit it.
TEST(RealScans, AnOfficeFloorFromACarmenLog) {
  WARETWIN_NEED_DATA("laser_carmen");
  const std::filesystem::path file = test::shared_data("laser_carmen") / "freiburg-079-first-half.log.gz";
  const auto stream = open_recording(file);
  const std::vector<PlanarMotion> corrected = corrected_poses(file);
  LocalMapLocaliser localiser({}, stream->info());
  OdometryLocaliser wheels(stream->info());
  std::vector<LaserScan> scans;
  std::vector<PlanarMotion> ours, reckoned;
  const PlanarMotion X_BL = planar(stream->info().lasers.begin()->second.X_BL);
  double milliseconds = 0.0;
  while (auto event = stream->next()) {
    const std::clock_t start = std::clock();
    if (const auto* reading = std::get_if<OdometryReading>(&*event)) {
      localiser.add(*reading);
      wheels.add(*reading);
    }
    if (const auto* scan = std::get_if<LaserScan>(&*event)) {
      localiser.add(*scan);
      milliseconds += 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
      ours.push_back(planar(*localiser.current_pose()) * X_BL);
      reckoned.push_back(planar(*wheels.current_pose()) * X_BL);
      scans.push_back(*scan);
    }
  }
  ASSERT_EQ(ours.size(), 2400u);
  ASSERT_EQ(corrected.size(), ours.size());
  const auto windows = [&](const std::vector<PlanarMotion>& path, std::size_t length) {
    std::vector<double> metres, degrees;
    for (std::size_t i = 0; i + length < path.size(); ++i) {
      const PlanarMotion off = (corrected[i].inverse() * corrected[i + length]).inverse() * (path[i].inverse() * path[i + length]);
      metres.push_back(off.translation.norm());
      degrees.push_back(to_degrees(std::abs(off.yaw)));
    }
    return std::pair<Window, Window>{{at_share(metres, 0.5), at_share(degrees, 0.5)}, {at_share(metres, 0.95), at_share(degrees, 0.95)}};
  };
  for (const auto& [name, path] : {std::pair{"laser", &ours}, std::pair{"wheels", &reckoned}}) {
    for (const std::size_t length : {std::size_t{1}, std::size_t{10}}) {
      const auto [median, most] = windows(*path, length);
      std::cout << name << ", " << length << " scans: median " << median.metres << " m " << median.degrees << " deg, 95 % " << most.metres
                << " m " << most.degrees << " deg\n";
    }
  }
  const auto [median, most] = windows(ours, 10);
  EXPECT_LT(median.metres, 0.027);
  EXPECT_LT(median.degrees, 0.48);
  EXPECT_LT(most.metres, 0.085);
  EXPECT_LT(most.degrees, 2.0);
  const PlanarMotion end = (corrected.front().inverse() * corrected.back()).inverse() * (ours.front().inverse() * ours.back());
  EXPECT_LT(end.translation.norm(), 0.1);
  EXPECT_LT(to_degrees(std::abs(end.yaw)), 1.5);
  const LocalMapLocaliser::Counts& counts = localiser.counts();
  std::cout << "at the end " << end.translation.norm() << " m and " << to_degrees(end.yaw) << " deg apart; " << milliseconds / counts.scans
            << " ms a scan, not matched " << counts.not_matched << ", in corridors " << counts.degenerate << ", odometry doubted "
            << counts.odometry_doubted << ", loops " << counts.loops << "\n";
  EXPECT_LT(counts.not_matched, 24);

  // Which of the two poses lays scan i + 10 on scan i better, by the median distance of its points from the other's surfaces.
  std::vector<double> residual_ours, residual_corrected;
  for (std::size_t i = 0; i + 10 < scans.size(); i += 10) {
    const LocalMap map = map_of(points_of(scans[i]));
    const std::vector<ScanPoint> points = points_of(scans[i + 10]);
    for (const auto& [path, residuals] : {std::pair{&std::as_const(ours), &residual_ours}, std::pair{&corrected, &residual_corrected}}) {
      const PlanarMotion X = (*path)[i].inverse() * (*path)[i + 10];
      std::vector<double> distances;
      for (const ScanPoint& point : points) {
        const Eigen::Vector2d p = X * point.p;
        const int nearest = map.nearest(p, X.rotation() * point.normal, 0.3, 0.7);
        if (nearest < 0) continue;
        const MapPoint& there = map.points()[static_cast<std::size_t>(nearest)];
        distances.push_back(std::abs(there.normal.dot(p - there.p)));
      }
      if (distances.size() > 100) residuals->push_back(at_share(distances, 0.5));
    }
  }
  std::cout << "scans ten apart lie on each other to " << at_share(residual_ours, 0.5) << " m with our poses, to "
            << at_share(residual_corrected, 0.5) << " m with the corrected ones\n";
  EXPECT_LT(1.2 * at_share(residual_ours, 0.5), at_share(residual_corrected, 0.5));
}

}  // namespace
}  // namespace waretwin

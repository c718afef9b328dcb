// Localisation on real scans: a CARMEN log of an office floor, and a pair of scans that traps naive ICP.
#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/statistics.h"
#include "mapper/localise/local_map_localiser.h"
#include "mapper/localise/map_search.h"
#include "mapper/localise/scan_matcher.h"
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

std::vector<Eigen::Vector2d> raw_points(const LaserScan& scan) {
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const double angle = scan.angle_min + static_cast<double>(i) * scan.angle_increment, range = scan.ranges[i];
    if (range > 0.0) points.emplace_back(range * std::cos(angle), range * std::sin(angle));
  }
  return points;
}

TEST(Debug, Csm) {
  WARETWIN_NEED_DATA("laser_csm");
  const auto scans = read_csm(test::shared_data("laser_csm") / "stallo2.log");
  const auto a = raw_points(scans[0].scan), b = raw_points(scans[1].scan);
  const PlanarMotion odo = scans[0].X_OB.inverse() * scans[1].X_OB;
  std::cout << "odometry " << odo.translation.transpose() << " " << to_degrees(odo.yaw) << "\n";
  const auto agreement = [&](const PlanarMotion& X) {
    int near = 0;
    for (const auto& p : b) {
      const Eigen::Vector2d q = X * p;
      for (const auto& r : a) {
        if ((r - q).squaredNorm() < 0.02 * 0.02) {
          ++near;
          break;
        }
      }
    }
    return static_cast<double>(near) / static_cast<double>(b.size());
  };
  for (const char* lines : {"fitted", "two_points"}) {
    ScanMatchConfig config;
    config.lines = lines;
    const ScanMatch m = match_scans(ReferenceScan(a, config), b, odo, config);
    std::cout << lines << " " << m.X_RS.translation.transpose() << " " << to_degrees(m.X_RS.yaw) << " matched " << m.matched_fraction
              << " res " << m.residual_m << " agreement " << agreement(m.X_RS) << "\n";
  }
  LocalMapConfig config;
  for (const double radius : {0.25, 0.1}) {
  config.scan.line_radius_m = radius;
  const auto pa = scan_points(scans[0].scan, Pose::Identity(), {}, {}, config.scan);
  const auto pb = scan_points(scans[1].scan, Pose::Identity(), {}, {}, config.scan);
  std::cout << a.size() << " " << b.size() << " points, kept " << pa.size() << " " << pb.size() << "\n";
  LocalMap map(config.map_cell_m);
  map.add(pa, {}, 0.0, 0);
  map.finish();
  MapMatch m = match_to_map(map, pb, {odo, Eigen::Matrix3d::Zero()}, odo, 0.0, config.match);
  std::cout << "local_map " << m.X_SB.translation.transpose() << " " << to_degrees(m.X_SB.yaw) << " matched " << m.matched_fraction << " res "
            << m.residual_m << " believable " << m.believable << " degenerate " << m.degenerate << " agreement " << agreement(m.X_SB) << "\n";
  config.search.min_score = 0.3;
  const auto found = search_map(map, pb, {odo, 0.6, 180}, 0.0, config.search);
  if (found) {
    m = match_to_map(map, pb, {found->X_SB, Eigen::Matrix3d::Zero()}, found->X_SB, 0.0, config.match);
    std::cout << "search " << found->X_SB.translation.transpose() << " " << to_degrees(found->X_SB.yaw) << " score " << found->score << "; then "
              << m.X_SB.translation.transpose() << " " << to_degrees(m.X_SB.yaw) << " matched " << m.matched_fraction << " res "
              << m.residual_m << " believable " << m.believable << " agreement " << agreement(m.X_SB) << "\n";
  }
  }
  for (double gx : {-0.1, 0.0, 0.05, 0.1, 0.3, 0.4}) for (double gyaw : {-20., 0., 20.}) {
    const PlanarMotion g{{gx, 0}, to_radians(gyaw)};
    config.scan.line_radius_m = 0.25;
    const auto pa = scan_points(scans[0].scan, Pose::Identity(), {}, {}, config.scan);
    const auto pb = scan_points(scans[1].scan, Pose::Identity(), {}, {}, config.scan);
    LocalMap map(config.map_cell_m);
    map.add(pa, {}, 0.0, 0);
    map.finish();
    ScanMatchConfig sc;
    const ScanMatch m = match_scans(ReferenceScan(a, sc), b, g, sc);
    const MapMatch k = match_to_map(map, pb, {g, Eigen::Matrix3d::Zero()}, g, 0.0, config.match);
    std::cout << "from " << gx << " " << gyaw << ": icp " << m.X_RS.translation.transpose() << " " << to_degrees(m.X_RS.yaw) << " matched " << m.matched_fraction << " bel " << m.believable << "; map "
              << k.X_SB.translation.transpose() << " " << to_degrees(k.X_SB.yaw) << " matched " << k.matched_fraction << " res " << k.residual_m << " bel " << k.believable << "\n";
  }
}

TEST(Debug, Carmen) {
  WARETWIN_NEED_DATA("laser_carmen");
  const auto stream = open_recording(test::shared_data("laser_carmen") / "freiburg-079-first-half.log.gz");
  LocalMapLocaliser localiser({}, stream->info());
  const std::clock_t start = std::clock();
  while (auto event = stream->next()) {
    if (auto* o = std::get_if<OdometryReading>(&*event)) localiser.add(*o);
    if (auto* s = std::get_if<LaserScan>(&*event)) localiser.add(*s);
  }
  const auto& c = localiser.counts();
  std::cout << c.scans << " scans, not matched " << c.not_matched << ", degenerate " << c.degenerate << ", doubted " << c.odometry_doubted
            << ", found again " << c.found_again << ", keyframes " << c.keyframes << ", loops " << c.loops << ", bias " << localiser.range_bias_m()
            << ", ms " << 1e3 * double(std::clock() - start) / CLOCKS_PER_SEC / c.scans << "\n";
}

}  // namespace
}  // namespace waretwin

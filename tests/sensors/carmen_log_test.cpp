#include "sensors/recordings/carmen_log.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <numbers>

#include "core/files.h"
#include "sensors/recordings/recording.h"
#include "tests/support/expect_error.h"
#include "tests/support/test_data.h"

namespace waretwin {
namespace {

namespace fs = std::filesystem;

class CarmenLogTest : public ::testing::Test {
 protected:
  fs::path write(const std::string& name, const std::string& text) {
    write_file(folder_.path() / name, text);
    return folder_.path() / name;
  }
  fs::path write_packed(const std::string& name, const std::string& text) {
    const fs::path file = folder_.path() / name;
    gzFile out = gzopen(file.c_str(), "wb");
    gzwrite(out, text.data(), static_cast<unsigned>(text.size()));
    gzclose(out);
    return file;
  }
  test::TemporaryFolder folder_;
};

const std::string kLog =
    "# a comment\n"
    "PARAM robot_front_laser_max 20.5 0 host 0\n"
    "PARAM robot_frontlaser_offset 0.25 0 host 0\n"
    "ODOM 1 2 0 0.5 0 0 10.0 host 10.0\n"
    "FLASER 4 1 2.5 20.5 81.91 7 7 7 8 8 8 10.1 host 10.1\n"
    "\n"
    "NEFF 3\n"
    "ODOM 1.5 2 0.1 0.5 0 0 10.5 host 10.5\n"
    "FLASER 4 1.1 2 3 4 7 7 7 8 8 8 10.6 host 10.6\n";

struct Readings {
  std::vector<LaserScan> scans;
  std::vector<OdometryReading> odometry;
};

Readings readings_of(const fs::path& file) {
  Readings readings;
  const auto stream = open_recording(file);
  while (auto event = stream->next()) {
    if (auto* scan = std::get_if<LaserScan>(&*event)) readings.scans.push_back(*scan);
    if (auto* reading = std::get_if<OdometryReading>(&*event)) readings.odometry.push_back(*reading);
  }
  return readings;
}

TEST_F(CarmenLogTest, ReadsScansAndOdometryPackedOrNot) {
  for (const fs::path& file : {write("drive.log", kLog), write_packed("drive.log.gz", kLog), write_packed("drive.clf.gz", kLog)}) {
    const auto stream = open_recording(file);
    EXPECT_EQ(stream->info().source, file.filename().string());
    EXPECT_TRUE(stream->info().has_odometry);
    EXPECT_FALSE(stream->info().has_recorded_poses) << "corrected poses are nobody's business";
    EXPECT_TRUE(stream->info().cameras.empty());
    EXPECT_TRUE(stream->info().lasers.at("laser").X_BL.translation().isApprox(Eigen::Vector3d(0.25, 0, 0)));
    EXPECT_NEAR(stream->info().lasers.at("laser").rate_hz, 2.0, 1e-9);
    const Readings readings = readings_of(file);
    ASSERT_EQ(readings.scans.size(), 2u);
    ASSERT_EQ(readings.odometry.size(), 2u);
    const LaserScan& scan = readings.scans[0];
    EXPECT_EQ(scan.stamp, from_seconds(10.1));
    EXPECT_EQ(scan.ranges, (std::vector<float>{1.0f, 2.5f, 0.0f, 0.0f})) << "from the laser's largest range on, readings are error codes";
    EXPECT_NEAR(scan.angle_min, -std::numbers::pi / 2, 1e-12);
    EXPECT_NEAR(scan.angle_increment, std::numbers::pi / 4, 1e-12);
    EXPECT_EQ(scan.range_max, 20.5);
    const Pose moved = readings.odometry[0].X_OB.inverse() * readings.odometry[1].X_OB;
    EXPECT_TRUE(moved.isApprox(make_upright_pose(0.5, 0.0, 0.0, 0.1), 1e-12));
  }
}

TEST_F(CarmenLogTest, AnOddNumberOfBeamsReachesBothEnds) {
  const Readings readings = readings_of(write("odd.log", "FLASER 3 1 1 1 0 0 0 0 0 0 1 host 1\n"));
  EXPECT_NEAR(readings.scans[0].angle_min + 2 * readings.scans[0].angle_increment, std::numbers::pi / 2, 1e-12);
  EXPECT_TRUE(readings.odometry.empty());
}

// Two logs of one drive, which somebody's SLAM has corrected in different ways: what is read must be the same.
TEST_F(CarmenLogTest, NothingOfTheCorrectedPosesGetsThrough) {
  const auto log = [](const std::vector<Pose>& corrections) {
    std::string text;
    Pose X = Pose::Identity();
    char line[400];
    for (std::size_t i = 0; i < corrections.size(); ++i) {
      X = X * make_upright_pose(0.3, 0.02, 0.0, 0.2);  // what the wheels measured since
      std::snprintf(line, sizeof line, "ODOM %.12f %.12f %.12f 0 0 0 %zu.5 host 1\n", X.translation().x(), X.translation().y(), yaw_of(X),
                    i);
      text += line;
      X = corrections[i];
      std::snprintf(line, sizeof line,
                    "FLASER 2 1 2 %.12f %.12f %.12f %.12f %.12f %.12f %zu.5 host 1\nODOM %.12f %.12f %.12f 0 0 0 0 host 0\n",
                    X.translation().x(), X.translation().y(), yaw_of(X), X.translation().x(), X.translation().y(), yaw_of(X), i,
                    X.translation().x(), X.translation().y(), yaw_of(X));
      text += line;
    }
    return text;
  };
  const Readings one = readings_of(
      write("one.log", log({make_upright_pose(0.1, 0.2, 0, 0.3), make_upright_pose(5, -2, 0, 3), make_upright_pose(0, 0, 0, 1)})));
  const Readings two =
      readings_of(write("two.log", log({make_upright_pose(-3, 0.7, 0, -2), make_upright_pose(1, 1, 0, 1), make_upright_pose(9, 9, 0, 0)})));
  ASSERT_EQ(one.odometry.size(), 3u);
  ASSERT_EQ(two.odometry.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(one.odometry[i].stamp, two.odometry[i].stamp);
    EXPECT_TRUE(one.odometry[i].X_OB.isApprox(two.odometry[i].X_OB, 1e-9)) << i;
  }
  EXPECT_TRUE((one.odometry[1].X_OB.inverse() * one.odometry[2].X_OB).isApprox(make_upright_pose(0.3, 0.02, 0.0, 0.2), 1e-9));
}

TEST_F(CarmenLogTest, SaysWhatIsWrongAndWhere) {
  const std::string good = "FLASER 2 1 2 0 0 0 0 0 0 1.5 host 1.5\n";
  EXPECT_ERROR(open_recording(write("a.log", "")), "a.log", "no FLASER line");
  EXPECT_ERROR(open_recording(write("a.log", good + good)), "a.log: all 2 FLASER lines have the stamp");
  EXPECT_ERROR(open_recording(write("a.log", good + "FLASER 3 1 2 0 0 0 0 0 0 1 host 1\n")), "a.log:2:", "has 13 words; expected 14");
  EXPECT_ERROR(open_recording(write("a.log", good + "FLASER\n")), "a.log:2:", "count from 1 to 100000");
  EXPECT_ERROR(open_recording(write("a.log", good + "FLASER -1 1\n")), "a.log:2:", "count from 1 to 100000");
  EXPECT_ERROR(open_recording(write("a.log", good + "FLASER 1e9 1\n")), "a.log:2:", "count from 1 to 100000");
  EXPECT_ERROR(open_recording(write("a.log", good + "FLASER 2 1 x 0 0 0 0 0 0 1 host 1\n")), "a.log:2:", "'x' is not a number");
  EXPECT_ERROR(open_recording(write("a.log", good + "FLASER 2 1 nan 0 0 0 0 0 0 1 host 1\n")), "a.log:2:", "not finite");
  EXPECT_ERROR(open_recording(write("a.log", good + "FLASER 2 1 -2 0 0 0 0 0 0 1 host 1\n")), "a.log:2:", "'-2' is not a range");
  EXPECT_ERROR(open_recording(write("a.log", good + "ODOM 1 2 3\n")), "a.log:2:", "an ODOM line has 4 words; expected 10");
  EXPECT_ERROR(open_recording(write("a.log", good + "ODOM 1 2 3 0 0 0 soon host 1\n")), "a.log:2:", "soon");
  EXPECT_ERROR(open_recording(write("a.log", good + "ODOM 1 -2e9 3 0 0 0 1 host 1\n")), "a.log:2:", "'-2e9' is no place");
  EXPECT_ERROR(open_recording(write("a.log", good + "ODOM 1 2 3 0 0 0 4500000001 host 1\n")), "a.log:2:", "is no time");
  EXPECT_ERROR(open_recording(write("a.log", "PARAM robot_front_laser_max 0\n" + good)), "a.log:1:", "above 0");
  EXPECT_ERROR(open_recording(write("a.txt", good)), "a.txt", "CARMEN log (.log, .log.gz)");
  // A packed log that breaks off.
  std::string many;
  for (int i = 0; i < 2000; ++i)
    many += "FLASER 2 1 2." + std::to_string(i * 7919 % 10007) + " 0 0 0 0 0 0 " + std::to_string(i) + " host 1\n";
  const std::string packed = read_file(write_packed("b.log.gz", many));
  EXPECT_ERROR(open_recording(write("c.log.gz", packed.substr(0, packed.size() / 2))), "c.log.gz");
}

// Stamps so far apart that a difference of larger ones would not fit into 64 bits.
TEST_F(CarmenLogTest, TakesTheLargestStampsAndPlaces) {
  const fs::path file = write("far.log",
                              "FLASER 1 1 0 0 0 0 0 0 -4500000000 host 1\nFLASER 1 1 0 0 0 0 0 0 4500000000 host 1\n"
                              "ODOM 1e9 -1e9 1e300 0 0 0 1 host 1\nODOM -1e9 1e9 0 0 0 0 2 host 1\n");
  const auto stream = open_recording(file);
  EXPECT_EQ(stream->info().duration_s, 9e9);
  EXPECT_NEAR(stream->info().lasers.at("laser").rate_hz, 1.0 / 9e9, 1e-15);
  for (const OdometryReading& reading : readings_of(file).odometry) EXPECT_TRUE(reading.X_OB.matrix().allFinite());
}

TEST_F(CarmenLogTest, ARealLog) {
  WARETWIN_NEED_DATA("laser_carmen");
  const Readings readings = readings_of(test::shared_data("laser_carmen") / "freiburg-079-first-half.log.gz");
  EXPECT_EQ(readings.scans.size(), 2400u);
  EXPECT_EQ(readings.odometry.size(), 2460u) << "those without a stamp are corrected poses";
  for (const LaserScan& scan : readings.scans) EXPECT_EQ(scan.ranges.size(), 360u);
}

}  // namespace
}  // namespace waretwin

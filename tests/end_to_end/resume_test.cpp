// One drive mapped at once and in two halves, the second going on from the first one's map.
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

#include "core/cuboid.h"
#include "tests/end_to_end/program.h"

namespace waretwin {
namespace {

using test::agiprobot;
using test::in_quotes;
using test::TemporaryFolder;
using Json = nlohmann::json;
namespace fs = std::filesystem;

struct Object {
  std::string class_name;
  Cuboid cuboid;
};

std::map<int, Object> objects_in(const fs::path& folder) {
  std::map<int, Object> objects;
  const Json json = Json::parse(read_file(folder / "cuboids.json"));
  for (const Json& entry : json["objects"]) {
    Object object;
    object.class_name = entry["class"];
    for (int k = 0; k < 3; ++k) {
      object.cuboid.centre[k] = entry["centre"][static_cast<std::size_t>(k)];
      object.cuboid.size[k] = entry["size"][static_cast<std::size_t>(k)];
    }
    object.cuboid.yaw = entry["yaw"];
    const bool fresh = objects.emplace(entry["id"].get<int>(), object).second;
    EXPECT_TRUE(fresh) << "an id occurs twice";
  }
  return objects;
}

// Past station 1, which is looked at from two sides, and to station 2; the pictures are small and few.
void record_drive(const fs::path& out, int frames) {
  const auto result =
      test::waretwin("record " + agiprobot() + " --quiet --frames " + std::to_string(frames) + " --out " + in_quotes(out) +
                     " --set sensors.cameras.camera.preset=azure_kinect_gaussian --set sensors.cameras.camera.rate_hz=3"
                     " --set sensors.cameras.camera.width=480 --set sensors.cameras.camera.height=270 --set robot.speed_mps=1"
                     " --set robot.acceleration_mps2=1 --set robot.turn_rate_deg_s=90 --set robot.turn_acceleration_deg_s2=180");
  ASSERT_EQ(result.exit_code, 0) << result.err;
}

// Takes the first pictures out of a recording. Scans and odometry stay, so that the later poses are those of the whole drive.
void drop_pictures(const fs::path& drive, int count) {
  std::string list = read_file(drive / "rgb.txt");
  auto from = list.find('\n') + 1;  // after the comment
  for (int i = 0; i < count; ++i) list.erase(from, list.find('\n', from) + 1 - from);
  write_file(drive / "rgb.txt", list);
}

TEST(Resume, ADriveInHalvesMapsAsTheWholeOne) {
  constexpr int kFrames = 60, kFirst = 26;  // between the two looks at station 1
  const TemporaryFolder folder;
  const fs::path drive = folder.path() / "drive", whole = folder.path() / "whole", halves = folder.path() / "halves";
  record_drive(drive, kFrames);
  const std::string map =
      "map " + in_quotes(drive) + " --quiet --profile best --detector " + in_quotes(drive / "truth_boxes.json") + " --out ";
  const auto at_once = test::waretwin(map + in_quotes(whole));
  ASSERT_EQ(at_once.exit_code, 0) << at_once.err;
  const auto first = test::waretwin(map + in_quotes(halves) + " --frames " + std::to_string(kFirst));
  ASSERT_EQ(first.exit_code, 0) << first.err;
  const std::map<int, Object> before = objects_in(halves);
  drop_pictures(drive, kFirst);
  // Into the folder that the map comes from.
  const auto second = test::waretwin(map + in_quotes(halves) + " --resume " + in_quotes(halves / "map.waretwin"));
  ASSERT_EQ(second.exit_code, 0) << second.err;
  EXPECT_NE(second.out.find(std::to_string(kFrames - kFirst) + " frames mapped"), std::string::npos) << second.out;

  const std::map<int, Object> expected = objects_in(whole), after = objects_in(halves);
  ASSERT_EQ(before.size(), 1u) << "the first half sees one conveyor";
  ASSERT_EQ(expected.size(), 2u);
  EXPECT_EQ(after.size(), expected.size()) << "nothing is lost and nothing is there twice";
  for (const auto& [id, object] : before) EXPECT_TRUE(after.contains(id)) << "object " << id << " lost its id";
  for (const auto& [id, object] : after) {
    SCOPED_TRACE(id);
    ASSERT_TRUE(expected.contains(id)) << "ids are counted on, from 1";
    const Object& other = expected.at(id);
    EXPECT_EQ(object.class_name, other.class_name);
    EXPECT_LT((object.cuboid.centre - other.cuboid.centre).norm(), 0.015);
    EXPECT_LT((object.cuboid.size - other.cuboid.size).cwiseAbs().maxCoeff(), 0.02);
    EXPECT_GT(iou_3d(object.cuboid, other.cuboid), 0.9);
  }
  // Object 2 was seen in the second half alone: nothing of the first tells on it.
  EXPECT_EQ(after.at(2).cuboid.centre, expected.at(2).cuboid.centre);

  // The same poses and the same frames: the same surface and the same space, byte for byte.
  for (const char* name : {"trajectory.tum", "map.ply", "esdf.nrrd", "occupancy.pgm"}) {
    EXPECT_EQ(read_file(whole / name), read_file(halves / name)) << name;
  }
  const std::string timing = read_file(halves / "timing.csv");
  EXPECT_NE(timing.find("\n" + std::to_string(kFirst) + ","), std::string::npos) << "frames count on";
  EXPECT_NE(timing.find("\n" + std::to_string(kFrames - 1) + ","), std::string::npos);
  EXPECT_EQ(timing.find("\n" + std::to_string(kFirst - 1) + ","), std::string::npos);

  // What a later drive does not see stays as it is.
  const auto later = test::waretwin("run " + agiprobot() + " --quiet --frames 2 --set simulation.colour=false --out " +
                                    in_quotes(folder.path() / "later") + " --resume " + in_quotes(whole / "map.waretwin"));
  ASSERT_EQ(later.exit_code, 0) << later.err;
  EXPECT_EQ(read_file(folder.path() / "later/cuboids.json"), read_file(whole / "cuboids.json"));
}

TEST(Resume, RefusesWhatItCannotGoOnFrom) {
  const TemporaryFolder folder;
  const fs::path drive = folder.path() / "drive", first = folder.path() / "first", out = folder.path() / "out";
  record_drive(drive, 2);
  const std::string map = "map " + in_quotes(drive) + " --quiet --out ";
  const auto mapped = test::waretwin(map + in_quotes(first));
  ASSERT_EQ(mapped.exit_code, 0) << mapped.err;
  const fs::path archive = first / "map.waretwin";
  const std::string whole = read_file(archive), resume = " --resume " + in_quotes(archive);
  for (const std::string& command : {map, "run " + agiprobot() + " --quiet --frames 2 --out "}) {
    SCOPED_TRACE(command);
    const auto voxels = test::waretwin(command + in_quotes(out) + resume + " --set mapper.integrate.voxel_m=0.05");
    EXPECT_ONE_LINE(voxels, "map.waretwin");
    EXPECT_ONE_LINE(voxels, "voxel_m and truncation_voxels are 0.05");
    EXPECT_ONE_LINE(test::waretwin(command + in_quotes(out) + resume + " --set mapper.integrate.truncation_voxels=5"), "truncation");
    EXPECT_ONE_LINE(test::waretwin(command + in_quotes(out) + " --resume nowhere.waretwin"), "nowhere.waretwin");
    EXPECT_ONE_LINE(test::waretwin(command + in_quotes(out) + " --resume " + in_quotes(first / "cuboids.json")), "not a map");
  }
  write_file(archive, whole.substr(0, whole.size() / 2));
  EXPECT_ONE_LINE(test::waretwin(map + in_quotes(out) + resume), "cut short");
  EXPECT_FALSE(fs::exists(out)) << "bad input leaves nothing behind";
  EXPECT_ONE_LINE(test::waretwin(map + in_quotes(first) + resume), "cut short");
  EXPECT_TRUE(fs::exists(first / "report.html")) << "an earlier run's results outlive a mistake";
}

}  // namespace
}  // namespace waretwin

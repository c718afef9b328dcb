// Distances for planners against brute force.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/files.h"
#include "core/random.h"
#include "mapper/integrate/distance_field.h"
#include "mapper/integrate/projective_integrator.h"
#include "mapper/output/map_files.h"
#include "tests/mapper/integrate_scene.h"
#include "tests/support/test_data.h"

namespace waretwin {
namespace {

TEST(SquaredDistances, AreThoseOfBruteForce) {
  const RandomStream random(5, "cells", "test");
  for (std::uint64_t round = 0; round < 8; ++round) {
    const int w = 3 + static_cast<int>(round) * 2, d = 17 - static_cast<int>(round), h = 1 + static_cast<int>(round);
    const double share = round % 2 == 0 ? 0.01 : 0.3;
    std::vector<std::uint8_t> set(static_cast<std::size_t>(w * d * h));
    for (std::size_t i = 0; i < set.size(); ++i) set[i] = random.uniform(10000 * round + i) < share;
    const std::vector<std::int32_t> squares = squared_distances(set, w, d, h);
    for (int i = 0; i < w * d * h; ++i) {
      int nearest = 1 << 29;
      for (int j = 0; j < w * d * h; ++j) {
        if (!set[static_cast<std::size_t>(j)]) continue;
        const int x = i % w - j % w, y = i / w % d - j / w % d, z = i / (w * d) - j / (w * d);
        nearest = std::min(nearest, x * x + y * y + z * z);
      }
      ASSERT_EQ(squares[static_cast<std::size_t>(i)], nearest) << "round " << round << " cell " << i;
    }
  }
}

TEST(DistanceField, TellsAPlannerHowFarObstaclesAre) {
  const Intrinsics camera = Intrinsics::from_field_of_view(160, 120, to_radians(80), to_radians(64));
  TsdfConfig config;
  config.method = "projection";
  config.voxel_m = 0.04;
  TsdfVolume volume(config);
  const test::BoxScene scene;
  for (int i = 0; i < 5; ++i) {
    const Pose X_WC = test::look_at({-0.8 + 0.4 * i, -1.3, 1.2}, {0.0, 1.0, 0.3});
    ProjectiveIntegrator(config).integrate(test::view(scene, camera, X_WC, false).frame, camera, {}, X_WC, volume);
  }
  const DistanceField field = make_distance_field(volume, {});
  ASSERT_GT(field.width * field.depth * field.height, 1000);
  int free = 0, unknown = 0;
  for (int z = 0; z < field.height; ++z) {
    for (int y = 0; y < field.depth; ++y) {
      for (int x = 0; x < field.width; ++x) {
        const float distance = field.at(x, y, z);
        const Eigen::Vector3d p = field.origin + (Eigen::Vector3d(x, y, z).array() + 0.5).matrix() * field.resolution_m;
        unknown += std::isnan(distance);
        if (!(distance > 0.3f && distance < 0.8f)) continue;
        // The nearest surface of all may not have been seen; no obstacle is nearer than the truth but by the cells' size.
        ASSERT_GT(distance, scene.distance(p) - 3.0 * field.resolution_m);
        ++free;
      }
    }
  }
  EXPECT_GT(free, 1000);
  EXPECT_GT(unknown, 100);
  // Before a box's front, looking at it.
  const Eigen::Vector3d p(-0.55, 0.2, 0.5);
  const Eigen::Vector3i cell = ((p - field.origin) / field.resolution_m).cast<int>();
  EXPECT_NEAR(field.at(cell.x(), cell.y(), cell.z()), 0.3, 1.5 * field.resolution_m);
}

TEST(DistanceField, IsWrittenAsNrrd) {
  DistanceField field;
  field.resolution_m = 0.04;
  field.origin = {1.0, -2.0, 0.5};
  field.width = 2;
  field.depth = 1;
  field.height = 2;
  field.distances = {0.1f, -0.04f, std::numeric_limits<float>::quiet_NaN(), 2.0f};
  const test::TemporaryFolder folder;
  write_distance_field(folder.path() / "esdf.nrrd", field);
  const std::string bytes = read_file(folder.path() / "esdf.nrrd");
  EXPECT_EQ(bytes.substr(0, 8), "NRRD0004");
  EXPECT_NE(bytes.find("sizes: 2 1 2\n"), std::string::npos) << bytes;
  EXPECT_NE(bytes.find("space origin: (1.02,-1.98,0.52)\n"), std::string::npos) << bytes;
  const std::size_t data = bytes.find("\n\n") + 2;
  ASSERT_EQ(bytes.size() - data, 8u);
  std::array<std::int16_t, 4> values{};
  std::memcpy(values.data(), bytes.data() + data, 8);
  EXPECT_EQ(values, (std::array<std::int16_t, 4>{100, -40, -32768, 2000}));
}

}  // namespace
}  // namespace waretwin

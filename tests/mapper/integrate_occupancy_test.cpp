#include <gtest/gtest.h>

#include "mapper/integrate/grouped_ray_integrator.h"
#include "mapper/integrate/occupancy.h"
#include "tests/mapper/integrate_scene.h"

namespace waretwin {
namespace {

using test::look_at;

TEST(Occupancy, PlanOfARoomWithBoxes) {
  const Intrinsics camera = Intrinsics::from_field_of_view(320, 240, to_radians(90), to_radians(74));
  const test::BoxScene scene;
  TsdfConfig config;
  TsdfVolume volume(config);
  GroupedRayIntegrator integrator(config);
  int stamp = 0;
  const std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> views = {
      {{-1.5, -1.5, 1.3}, {0.5, 0.9, 0.2}}, {{1.5, -1.5, 1.3}, {-0.5, 0.9, 0.2}}, {{0.0, -1.6, 1.3}, {0.0, 1.0, 0.2}}};
  for (const auto& [eye, target] : views) {
    const Pose X_WC = look_at(eye, target);
    const test::LabelledFrame in = test::view(scene, camera, X_WC, true, ++stamp);
    integrator.integrate(in.frame, camera, in.labels, X_WC, volume);
  }
  const OccupancyGrid grid = make_occupancy_grid(volume, OccupancyConfig());
  const auto at = [&](double x, double y) {
    return grid.at(static_cast<int>((x - grid.origin.x()) / grid.resolution_m),
                   static_cast<int>((y - grid.origin.y()) / grid.resolution_m));
  };
  EXPECT_EQ(at(-0.5, 0.51), VoxelState::occupied);  // front of box 1
  EXPECT_EQ(at(0.6, 0.71), VoxelState::occupied);   // front of box 2
  EXPECT_EQ(at(0.0, 1.99), VoxelState::occupied);   // back wall
  EXPECT_EQ(at(0.0, 0.0), VoxelState::free);
  EXPECT_EQ(at(0.05, 0.9), VoxelState::free);       // between the boxes
  EXPECT_EQ(at(-0.55, 0.8), VoxelState::occupied);  // the top of box 1, seen from above
  // The floor itself is below the band: free cells are many.
  std::size_t free = 0, occupied = 0;
  for (const VoxelState s : grid.cells) {
    free += s == VoxelState::free;
    occupied += s == VoxelState::occupied;
  }
  EXPECT_GT(free, 8000u);
  EXPECT_LT(occupied, free / 2);
  // Each cell against its column, voxel by voxel.
  const OccupancyConfig band;
  for (int y = 0; y < grid.height; y += 3) {
    for (int x = 0; x < grid.width; x += 3) {
      int free_voxels = 0, occupied_voxels = 0, all = 0;
      for (int z = 0; z < 100; ++z) {
        const double height = (z + 0.5) * volume.voxel_m();
        if (height < band.min_z_m || height > band.max_z_m) continue;
        const Eigen::Vector3d p(grid.origin.x() + (x + 0.5) * grid.resolution_m, grid.origin.y() + (y + 0.5) * grid.resolution_m, height);
        const VoxelState state = volume.state_at(p);
        free_voxels += state == VoxelState::free;
        occupied_voxels += state == VoxelState::occupied;
        ++all;
      }
      const VoxelState expected = occupied_voxels > 0                       ? VoxelState::occupied
                                  : free_voxels >= std::max(1.0, 0.1 * all) ? VoxelState::free
                                                                            : VoxelState::unknown;
      ASSERT_EQ(grid.at(x, y), expected) << x << " " << y;
    }
  }
}

TEST(Occupancy, AnEmptyVolumeHasNoCells) {
  const TsdfVolume volume{TsdfConfig()};
  const OccupancyGrid grid = make_occupancy_grid(volume, OccupancyConfig());
  EXPECT_EQ(grid.width, 0);
  EXPECT_TRUE(grid.cells.empty());
}

}  // namespace
}  // namespace waretwin

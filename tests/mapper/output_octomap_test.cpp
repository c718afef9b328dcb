#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <random>

#include "core/config.h"
#include "mapper/output/octomap_file.h"
#include "mapper/output/output_config.h"
#include "tests/support/expect_error.h"
#include "tests/support/test_data.h"

#ifdef WARETWIN_OCTOMAP
#include <octomap/OcTree.h>
#endif

namespace waretwin {
namespace {

#ifdef WARETWIN_OCTOMAP

void set(TsdfBlock& block, SurfaceVoxels& surface, int offset, VoxelState state) {
  const auto i = static_cast<std::size_t>(offset);
  if (state == VoxelState::occupied) surface.voxels[i] = {.distance = 0.0f, .weight = 1.0f, .colour = {}, .surface_frames = 1};
  if (state == VoxelState::free) block.free_frames[i] = 1;
}

void fill_block(TsdfVolume& volume, const Eigen::Vector3i& index, const std::function<VoxelState()>& state) {
  const std::size_t position = volume.ensure_block(index);
  SurfaceVoxels& surface = volume.ensure_surface(position);
  for (int offset = 0; offset < TsdfVolume::kVoxels; ++offset) set(volume.block(position), surface, offset, state());
}

// Blocks of one state and blocks of a mixture, on both sides of the origin.
TsdfVolume made_up(double voxel_m) {
  TsdfConfig config;
  config.voxel_m = voxel_m;
  TsdfVolume volume(config);
  std::mt19937 random(7);
  for (int x = -2; x < 0; ++x) {
    for (int y = 0; y < 2; ++y) {
      for (int z = 0; z < 2; ++z) fill_block(volume, {x, y, z}, [] { return VoxelState::free; });  // one node of 16 voxels
    }
  }
  fill_block(volume, {1, -2, 0}, [] { return VoxelState::occupied; });
  fill_block(volume, {1, 1, 1}, [] { return VoxelState::unknown; });
  for (const Eigen::Vector3i& index : {Eigen::Vector3i(0, 0, 0), Eigen::Vector3i(-1, -1, -1), Eigen::Vector3i(2, -2, 1)}) {
    fill_block(volume, index, [&] { return static_cast<VoxelState>(random() % 3); });
  }
  return volume;
}

VoxelState state_in(const octomap::OcTree& tree, const Eigen::Vector3d& p) {
  const octomap::OcTreeNode* node = tree.search(p.x(), p.y(), p.z());
  if (node == nullptr) return VoxelState::unknown;
  return tree.isNodeOccupied(node) ? VoxelState::occupied : VoxelState::free;
}

TEST(Octomap, HoldsTheVolumeVoxelByVoxel) {
  const test::TemporaryFolder folder;
  const std::string file = (folder.path() / "octomap.bt").string();
  for (const double voxel_m : {0.02, 0.05, 1.0 / 30.0}) {
    SCOPED_TRACE(voxel_m);
    const TsdfVolume volume = made_up(voxel_m);
    write_octomap(file, volume);
    octomap::OcTree tree(1.0);
    ASSERT_TRUE(tree.readBinary(file));
    EXPECT_NEAR(tree.getResolution(), voxel_m, 1e-12);
    double known = 0.0;
    std::array<int, 3> counts{};
    for (int x = -30; x < 40; ++x) {
      for (int y = -30; y < 40; ++y) {
        for (int z = -30; z < 40; ++z) {
          const Eigen::Vector3i voxel(x, y, z);
          const VoxelState expected = volume.state(voxel);
          ASSERT_EQ(state_in(tree, volume.voxel_centre(voxel)), expected) << voxel.transpose();
          ++counts[static_cast<std::size_t>(expected)];
          known += expected != VoxelState::unknown;
        }
      }
    }
    for (const int count : counts) EXPECT_GT(count, 900);
    double in_tree = 0.0;
    bool large = false;
    for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
      in_tree += std::pow(leaf.getSize() / voxel_m, 3);
      large = large || leaf.getDepth() == tree.getTreeDepth() - 4;
    }
    EXPECT_NEAR(in_tree, known, 1e-3) << "nothing is known anywhere else";
    EXPECT_TRUE(large) << "equal neighbours are one node, across blocks too";
  }
}

TEST(Octomap, ReachesAsFarAsItsKeys) {
  const test::TemporaryFolder folder;
  const std::string file = (folder.path() / "octomap.bt").string();
  TsdfVolume volume{TsdfConfig()};
  const int last = (1 << 15) / TsdfVolume::kSide - 1;
  for (const int x : {-last - 2, -last - 1, last, last + 1}) fill_block(volume, {x, 0, 0}, [] { return VoxelState::free; });
  write_octomap(file, volume);
  octomap::OcTree tree(1.0);
  ASSERT_TRUE(tree.readBinary(file));
  EXPECT_EQ(tree.getNumLeafNodes(), 2u);
  for (const int x : {-last - 1, last}) {
    EXPECT_EQ(state_in(tree, volume.voxel_centre({8 * x + 3, 3, 3})), VoxelState::free) << x;
  }
}

TEST(Octomap, OfAnEmptyVolumeIsEmpty) {
  const test::TemporaryFolder folder;
  const std::string file = (folder.path() / "octomap.bt").string();
  TsdfVolume volume{TsdfConfig()};
  for (int block = 0; block < 2; ++block) {
    write_octomap(file, volume);
    octomap::OcTree tree(1.0);
    ASSERT_TRUE(tree.readBinary(file));
    EXPECT_EQ(tree.size(), 0u);
    EXPECT_EQ(tree.getResolution(), volume.voxel_m());
    volume.ensure_block({0, 0, 0});  // a block that nothing is known of
  }
}

TEST(Octomap, SaysWhereItCannotBeWritten) {
  const test::TemporaryFolder folder;
  EXPECT_ERROR(write_octomap(folder.path() / "no/octomap.bt", TsdfVolume{TsdfConfig()}), "octomap.bt");
}

#else

TEST(Octomap, HoldsTheVolumeVoxelByVoxel) { GTEST_SKIP() << "built without OctoMap (liboctomap-dev)"; }

TEST(Octomap, NamesThePackageThatIsMissing) {
  const test::TemporaryFolder folder;
  EXPECT_ERROR(write_octomap(folder.path() / "octomap.bt", TsdfVolume{TsdfConfig()}), "octomap.bt", "liboctomap-dev");
}

#endif

TEST(Octomap, IsWrittenWhereItCanBeUnlessConfiguredOtherwise) {
  OutputConfig config;
  EXPECT_EQ(config.wants_octomap(), octomap_available());
  const auto visit = [&](Fields& f) { config.visit(f); };
  apply_settings({{"octomap", "never"}}, visit);
  EXPECT_FALSE(config.wants_octomap());
  EXPECT_ERROR(apply_settings({{"octomap", "sometimes"}}, visit), "sometimes", "auto");
  if (octomap_available()) {
    apply_settings({{"octomap", "always"}}, visit);
    EXPECT_TRUE(config.wants_octomap());
  } else {
    EXPECT_ERROR(apply_settings({{"octomap", "always"}}, visit), "octomap", "liboctomap-dev");
  }
}

}  // namespace
}  // namespace waretwin

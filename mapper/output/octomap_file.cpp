#include "mapper/output/octomap_file.h"

#include "core/error.h"

#ifdef WARETWIN_OCTOMAP
#include <octomap/OcTree.h>

#include <array>
#include <sstream>
#include <string>

#include "core/files.h"
#endif

namespace waretwin {

#ifdef WARETWIN_OCTOMAP

namespace {

// Made a block at once and pruned within it: by OctoMap's own updates free space, which is most of a hall, would stand in memory voxel by
// voxel before it is pruned.
class Tree : public octomap::OcTree {
 public:
  explicit Tree(double voxel_m) : OcTree(voxel_m) {}

  void add(const TsdfVolume& volume, const TsdfBlock& block) {
    std::array<VoxelState, TsdfVolume::kVoxels> states;
    bool known = false;
    for (int offset = 0; offset < TsdfVolume::kVoxels; ++offset) {
      const VoxelState state = volume.state(block, offset);
      states[static_cast<std::size_t>(offset)] = state;
      known = known || state != VoxelState::unknown;
    }
    if (!known) return;  // a node without children would claim the whole block
    fill(block_node(block.index), states, Eigen::Vector3i::Zero(), TsdfVolume::kSide);
  }

  // Joins equal blocks. OctoMap's own pruning stops at the first level that has nothing to join, and that is the voxels'.
  void join_blocks() {
    if (root != nullptr) join_below(root, 0);
  }

  // What OctoMap's own writeBinary writes; that one prints to stderr.
  std::string bytes() const {
    std::ostringstream out;
    out.precision(15);  // for the resolution
    out << "# Octomap OcTree binary file\n# by waretwin\nid " << getTreeType() << "\nsize " << size() << "\nres " << getResolution()
        << "\ndata\n";
    if (root != nullptr) writeBinaryNode(out, root);
    return out.str();
  }

  static bool reaches(const Eigen::Vector3i& block) {
    constexpr int kBlocks = kReach / TsdfVolume::kSide;
    return block.minCoeff() >= -kBlocks && block.maxCoeff() < kBlocks;
  }

 private:
  using States = std::array<VoxelState, TsdfVolume::kVoxels>;
  static constexpr int kReach = 1 << 15;     // voxels from the origin to the end of OctoMap's 16-bit keys
  static constexpr unsigned kBlockBits = 3;  // of a key, within a block

  octomap::OcTreeNode* block_node(const Eigen::Vector3i& index) {
    if (root == nullptr) {
      root = new octomap::OcTreeNode;
      ++tree_size;
      size_changed = true;
    }
    octomap::OcTreeNode* node = root;
    const Eigen::Vector3i key = index * TsdfVolume::kSide + Eigen::Vector3i::Constant(kReach);
    for (unsigned bit = tree_depth; bit-- > kBlockBits;) {
      const auto part = [&](int axis) { return static_cast<unsigned>(key[axis]) >> bit & 1u; };
      const unsigned child = part(0) | part(1) << 1 | part(2) << 2;
      node = nodeChildExists(node, child) ? getNodeChild(node, child) : createNodeChild(node, child);
    }
    return node;
  }

  void join_below(octomap::OcTreeNode* node, unsigned depth) {
    if (depth + kBlockBits >= tree_depth) return;
    for (unsigned child = 0; child < 8; ++child) {
      if (nodeChildExists(node, child)) join_below(getNodeChild(node, child), depth + 1);
    }
    pruneNode(node);
  }

  // The cube of voxels that begins at `corner` of a block; one of them at least is known.
  void fill(octomap::OcTreeNode* node, const States& states, const Eigen::Vector3i& corner, int side) {
    if (side == 1) {
      node->setLogOdds(state_at(states, corner) == VoxelState::occupied ? clamping_thres_max : clamping_thres_min);
      return;
    }
    const int half = side / 2;
    for (unsigned child = 0; child < 8; ++child) {
      const Eigen::Vector3i at =
          corner + half * Eigen::Vector3i(static_cast<int>(child & 1u), static_cast<int>(child >> 1 & 1u), static_cast<int>(child >> 2));
      if (any_known(states, at, half)) fill(createNodeChild(node, child), states, at, half);
    }
    pruneNode(node);
  }

  static VoxelState state_at(const States& states, const Eigen::Vector3i& at) {
    return states[static_cast<std::size_t>(TsdfVolume::offset(at.x(), at.y(), at.z()))];
  }

  static bool any_known(const States& states, const Eigen::Vector3i& corner, int side) {
    for (int z = 0; z < side; ++z) {
      for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
          if (state_at(states, corner + Eigen::Vector3i(x, y, z)) != VoxelState::unknown) return true;
        }
      }
    }
    return false;
  }
};

}  // namespace

bool octomap_available() { return true; }

void write_octomap(const std::filesystem::path& file, const TsdfVolume& volume) {
  Tree tree(volume.voxel_m());
  for (const std::size_t b : volume.sorted_positions()) {
    const TsdfBlock& block = volume.block(b);
    if (Tree::reaches(block.index)) tree.add(volume, block);
  }
  tree.join_blocks();
  write_file(file, tree.bytes());
}

#else

bool octomap_available() { return false; }

void write_octomap(const std::filesystem::path& file, const TsdfVolume&) {
  throw Error(file, "cannot be written: the program was built without OctoMap; install liboctomap-dev and build again");
}

#endif

}  // namespace waretwin

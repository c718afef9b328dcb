// How often each label was counted in each voxel of one block: psi(v, l) of eq. (6), and its argmax, eq. (7).
//
// Most voxels see one label. That one stands in a fixed slot; all further ones stand in one list a block, sorted by voxel and label,
// which has no upper bound: no label is ever dropped.
#pragma once

#include <array>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

namespace waretwin {

class LabelCounts {
 public:
  static constexpr int kVoxels = 512;

  // psi(v, label) += times. voxel in [0, 512), label >= 0 (0 = background). Counts stop at 2^32 - 1.
  void add(int voxel, std::int32_t label, std::uint32_t times = 1);

  // Forgets all labels of a voxel.
  void clear(int voxel);

  // psi(v, label); 0 where it was never counted.
  std::uint32_t count(int voxel, std::int32_t label) const;

  // L(v), eq. (7): the label with the largest count; of equal ones the smallest, so that the background keeps a voxel until an object
  // has more counts. 0 where nothing was counted.
  std::int32_t best(int voxel) const;

  // All labels of a voxel with their counts, ascending by label.
  std::vector<std::pair<std::int32_t, std::uint32_t>> all(int voxel) const;

  // All labels of all voxels.
  std::set<std::int32_t> labels() const;

  // Adds the counts of label `from` to those of `to`, and forgets `from`.
  void merge(std::int32_t from, std::int32_t to);

  std::size_t bytes() const { return sizeof *this + further_.capacity() * sizeof(Entry); }

 private:
  struct Slot {
    std::int32_t label = 0;
    std::uint32_t count = 0;  // 0: the slot is empty, and so is the voxel
  };
  struct Entry {
    std::uint16_t voxel;
    std::int32_t label;
    std::uint32_t count;
  };
  std::vector<Entry>::const_iterator position(int voxel, std::int32_t label) const;

  std::array<Slot, kVoxels> first_{};
  std::vector<Entry> further_;
};

}  // namespace waretwin

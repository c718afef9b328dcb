#include "mapper/integrate/label_counts.h"

#include <algorithm>
#include <limits>
#include <tuple>

#include "core/error.h"

namespace waretwin {

namespace {

std::uint32_t saturated_sum(std::uint32_t a, std::uint32_t b) {
  const std::uint64_t sum = std::uint64_t{a} + b;
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(sum, std::numeric_limits<std::uint32_t>::max()));
}

}  // namespace

std::vector<LabelCounts::Entry>::const_iterator LabelCounts::position(int voxel, std::int32_t label) const {
  return std::lower_bound(
      further_.begin(), further_.end(), std::make_tuple(voxel, label),
      [](const Entry& e, const std::tuple<int, std::int32_t>& key) { return std::make_tuple(static_cast<int>(e.voxel), e.label) < key; });
}

void LabelCounts::add(int voxel, std::int32_t label, std::uint32_t times) {
  WARETWIN_CHECK(voxel >= 0 && voxel < kVoxels && label >= 0, "no such voxel or label");
  if (times == 0) return;
  Slot& slot = first_[static_cast<std::size_t>(voxel)];
  if (slot.count == 0) {
    slot = {label, times};
    return;
  }
  if (slot.label == label) {
    slot.count = saturated_sum(slot.count, times);
    return;
  }
  const auto at = position(voxel, label);
  if (at != further_.end() && at->voxel == voxel && at->label == label) {
    Entry& entry = further_[static_cast<std::size_t>(at - further_.begin())];
    entry.count = saturated_sum(entry.count, times);
  } else {
    further_.insert(at, Entry{static_cast<std::uint16_t>(voxel), label, times});
  }
}

void LabelCounts::clear(int voxel) {
  first_[static_cast<std::size_t>(voxel)] = {};
  if (!further_.empty()) std::erase_if(further_, [voxel](const Entry& e) { return e.voxel == voxel; });
}

std::uint32_t LabelCounts::count(int voxel, std::int32_t label) const {
  const Slot& slot = first_[static_cast<std::size_t>(voxel)];
  if (slot.count == 0) return 0;
  if (slot.label == label) return slot.count;
  const auto at = position(voxel, label);
  return at != further_.end() && at->voxel == voxel && at->label == label ? at->count : 0;
}

std::int32_t LabelCounts::best(int voxel) const {
  const Slot& slot = first_[static_cast<std::size_t>(voxel)];
  if (slot.count == 0) return 0;
  std::int32_t label = slot.label;
  std::uint32_t count = slot.count;
  if (further_.empty()) return label;
  for (auto e = position(voxel, 0); e != further_.end() && e->voxel == voxel; ++e) {
    if (e->count > count || (e->count == count && e->label < label)) {
      label = e->label;
      count = e->count;
    }
  }
  return label;
}

std::vector<std::pair<std::int32_t, std::uint32_t>> LabelCounts::all(int voxel) const {
  std::vector<std::pair<std::int32_t, std::uint32_t>> counts;
  const Slot& slot = first_[static_cast<std::size_t>(voxel)];
  if (slot.count == 0) return counts;
  counts.emplace_back(slot.label, slot.count);
  for (auto e = position(voxel, 0); e != further_.end() && e->voxel == voxel; ++e) counts.emplace_back(e->label, e->count);
  std::sort(counts.begin(), counts.end());
  return counts;
}

std::set<std::int32_t> LabelCounts::labels() const {
  std::set<std::int32_t> found;
  std::int32_t last = -1;
  for (const Slot& slot : first_) {
    if (slot.count == 0 || slot.label == last) continue;
    last = slot.label;
    found.insert(last);
  }
  for (const Entry& e : further_) found.insert(e.label);
  return found;
}

void LabelCounts::merge(std::int32_t from, std::int32_t to) {
  WARETWIN_CHECK(from >= 0 && to >= 0, "no such label");
  if (from == to) return;
  std::vector<std::pair<int, std::uint32_t>> moved;
  for (auto e = further_.begin(); e != further_.end();) {
    if (e->label == from) {
      moved.emplace_back(e->voxel, e->count);
      e = further_.erase(e);
    } else {
      ++e;
    }
  }
  for (int voxel = 0; voxel < kVoxels; ++voxel) {
    Slot& slot = first_[static_cast<std::size_t>(voxel)];
    if (slot.count == 0 || slot.label != from) continue;
    const auto at = position(voxel, to);
    if (at != further_.end() && at->voxel == voxel && at->label == to) {
      slot.count = saturated_sum(slot.count, at->count);
      further_.erase(at);
    }
    slot.label = to;
  }
  for (const auto& [voxel, count] : moved) add(voxel, to, count);
}

}  // namespace waretwin

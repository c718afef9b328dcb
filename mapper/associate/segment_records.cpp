#include "mapper/associate/segment_records.h"

#include <algorithm>
#include <set>
#include <tuple>

namespace waretwin {

std::vector<int> SegmentRecords::match_instances(const std::vector<std::pair<int, std::size_t>>& members, std::size_t instances) const {
  std::vector<std::tuple<int, std::size_t, int>> pairs;  // -frames, thing, instance
  for (const auto& [segment, thing] : members) {
    const auto record = records_.find(segment);
    if (record == records_.end()) continue;
    for (const auto& [instance, frames] : record->second.instances) pairs.emplace_back(-frames, thing, instance);
  }
  std::sort(pairs.begin(), pairs.end());
  std::vector<int> matched(instances, 0);
  std::set<int> used;
  for (const auto& [negative, thing, instance] : pairs) {
    if (matched[thing] == 0 && used.insert(instance).second) matched[thing] = instance;
  }
  return matched;
}

void SegmentRecords::see(int segment, int instance, const std::string& class_name, int frames) {
  Record& record = records_[segment];
  record.frames += frames;
  if (instance == 0) return;
  record.instances[instance] += frames;
  record.classes[class_name] += frames;
}

void SegmentRecords::merge(int from, int to) {
  const auto gone = records_.find(from);
  if (from == to || gone == records_.end()) return;
  Record& stays = records_[to];
  stays.frames += gone->second.frames;
  for (const auto& [instance, frames] : gone->second.instances) stays.instances[instance] += frames;
  for (const auto& [name, frames] : gone->second.classes) stays.classes[name] += frames;
  records_.erase(gone);
}

int SegmentRecords::instance_of(int segment) const {
  const auto record = records_.find(segment);
  if (record == records_.end()) return 0;
  int best = 0, most = 0;
  for (const auto& [instance, frames] : record->second.instances) {
    if (frames > most && frames > background_factor_ * (record->second.frames - frames)) {
      best = instance;
      most = frames;
    }
  }
  return best;
}

std::map<int, std::vector<int>> SegmentRecords::instances() const {
  std::map<int, std::vector<int>> found;
  for (const auto& [segment, record] : records_) {
    const int instance = instance_of(segment);
    if (instance != 0) found[instance].push_back(segment);
  }
  return found;
}

std::string SegmentRecords::class_of(const std::vector<int>& segments) const {
  std::map<std::string, int> sums;
  for (const int segment : segments) {
    const auto record = records_.find(segment);
    if (record == records_.end()) continue;
    for (const auto& [name, frames] : record->second.classes) sums[name] += frames;
  }
  std::string best;
  int most = 0;
  for (const auto& [name, frames] : sums) {
    if (frames > most) {
      best = name;
      most = frames;
    }
  }
  return best;
}

std::vector<int> SegmentRecords::segments() const {
  std::vector<int> all;
  for (const auto& [segment, record] : records_) all.push_back(segment);
  return all;
}

}  // namespace waretwin

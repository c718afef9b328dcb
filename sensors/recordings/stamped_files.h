// Lists of files by stamp, and which of two lists belong together. Internal to sensors/recordings.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/stamp.h"
#include "sensors/recordings/contents.h"

namespace waretwin {

struct StampedFile {
  Stamp stamp = 0;
  std::filesystem::path file;
};

// Lines "seconds file", sorted by stamp; files relative to the list. Throws Error with file and line for a malformed line, and for a file
// that is missing or outside the list's folder, and where all have one stamp.
std::vector<StampedFile> read_file_list(const std::filesystem::path& list);

template <class T>
void sort_by_stamp(std::vector<T>& values) {
  std::stable_sort(values.begin(), values.end(), [](const T& a, const T& b) { return a.stamp < b.stamp; });
}

// Throws Error that `count` readings of `what` in the file all have one stamp, and says what is `expected` beside times ("", or "or ..").
[[noreturn]] void refuse_one_stamp(const std::filesystem::path& file, std::size_t count, const std::string& what, Stamp stamp,
                                   const std::string& expected);

// Of readings that all have one stamp (0, of a driver that sets none) nobody knows when they were taken: two or more are refused.
template <class T>
void expect_times(const std::vector<T>& values, const std::filesystem::path& file, const std::string& what,
                  const std::string& expected = "") {
  const auto same = [&](const T& value) { return value.stamp == values.front().stamp; };
  if (values.size() < 2 || !std::all_of(values.begin(), values.end(), same)) return;
  refuse_one_stamp(file, values.size(), what, values.front().stamp, expected);
}

// Readings a second, by the median time between two: recordings have gaps. 0 where that is not known.
template <class T>
double median_rate_hz(const std::vector<T>& values) {
  std::vector<Stamp> steps;
  for (std::size_t i = 1; i < values.size(); ++i) steps.push_back(std::abs(values[i].stamp - values[i - 1].stamp));
  if (steps.empty()) return 0.0;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle > 0 ? 1.0 / to_seconds(*middle) : 0.0;
}

// Index of the nearest stamp; `sorted` is not empty.
template <class T>
std::size_t nearest_stamp(const std::vector<T>& sorted, Stamp stamp) {
  const auto after = std::lower_bound(sorted.begin(), sorted.end(), stamp, [](const T& value, Stamp s) { return value.stamp < s; });
  if (after == sorted.begin()) return 0;
  const auto before = after - 1;
  if (after == sorted.end() || stamp - before->stamp <= after->stamp - stamp) return static_cast<std::size_t>(before - sorted.begin());
  return static_cast<std::size_t>(after - sorted.begin());
}

// Indices of what belongs together: each is the other's nearest, at most `tolerance` apart. Cameras of unequal rates leave the rest out.
template <class A, class B>
std::vector<std::pair<std::size_t, std::size_t>> pairs_by_stamp(const std::vector<A>& a, const std::vector<B>& b, Stamp tolerance) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < a.size() && !b.empty(); ++i) {
    const std::size_t k = nearest_stamp(b, a[i].stamp);
    const Stamp apart = b[k].stamp < a[i].stamp ? a[i].stamp - b[k].stamp : b[k].stamp - a[i].stamp;
    if (apart <= tolerance && nearest_stamp(a, b[k].stamp) == i) pairs.emplace_back(i, k);
  }
  return pairs;
}

// What is added to stamps of depth images before they are paired: only what the clocks differ by matters there, for the frame as a whole is
// shifted later, by the colour picture's.
inline Stamp depth_delay(const RecordingConfig& config) { return from_seconds(config.clock.depth_s - config.clock.colour_s); }

// Says how many pictures stayed without a partner.
void remark_unpaired(RecordingContents& contents, std::size_t colours, std::size_t depths, double tolerance_s);

// Says how many frames stayed without a pose: those of whose time the `poses` (tf, or a file) say nothing, and those in gaps of them.
void remark_without_pose(RecordingContents& contents, std::size_t unknown, std::size_t in_gaps, const std::string& poses, double max_gap_s);

}  // namespace waretwin

// Which pixels an instance has, as run lengths, in memory and as COCO writes them.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

namespace waretwin {

inline constexpr std::int64_t kMostMaskPixels = 1'000'000'000;

struct MaskRuns {
  cv::Size size;          // of the whole picture, pixels
  std::vector<int> runs;  // pixels column by column: counts of others and of the instance's in turn, others first; together width x height
  bool empty() const { return runs.empty(); }  // no mask is known
};

// The runs of a mask (CV_8UC1, not 0 = the instance) that stands at `place` in a picture of size `size` that is 0 elsewhere.
std::vector<int> run_lengths(const cv::Mat& mask, const cv::Rect& place, const cv::Size& size);

// The same numbers as COCO's compressed text: six bits a letter, from the third on as differences to the last but one.
std::string compressed_runs(const std::vector<int>& runs);
// Throws Error, a sentence without its subject, for what is no such text.
std::vector<int> read_compressed_runs(const std::string& text);

// Throws Error, a sentence without its subject, where runs do not fill the picture.
void expect_whole(const MaskRuns& mask);
// CV_8UC1 of the whole picture, 255 = the instance. `mask` is whole.
cv::Mat mask_picture(const MaskRuns& mask);

}  // namespace waretwin

#include "mapper/detect/mask_runs.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>

#include "core/error.h"

namespace waretwin {

namespace {

// The byte itself only where it cannot break a line or a terminal.
std::string shown_letter(const std::string& text, std::size_t at) {
  const char letter = text[at];
  const std::string place = "letter " + std::to_string(at + 1);
  return letter >= ' ' && letter <= '~' ? place + ", '" + letter + "'," : place;
}

}  // namespace

std::vector<int> run_lengths(const cv::Mat& mask, const cv::Rect& place, const cv::Size& size) {
  WARETWIN_CHECK(mask.type() == CV_8UC1 && mask.size() == place.size() && (place & cv::Rect(cv::Point(), size)) == place,
                 "a mask inside its picture");
  std::vector<int> runs = {0};
  bool ones = false;
  const auto add = [&](bool value, int count) {
    if (count == 0) return;
    if (value != ones) {
      runs.push_back(0);
      ones = value;
    }
    runs.back() += count;
  };
  add(false, place.x * size.height);
  for (int u = 0; u < place.width; ++u) {
    add(false, place.y);
    for (int v = 0; v < place.height; ++v) add(mask.at<std::uint8_t>(v, u) != 0, 1);
    add(false, size.height - place.y - place.height);
  }
  add(false, (size.width - place.x - place.width) * size.height);
  return runs;
}

std::string compressed_runs(const std::vector<int>& runs) {
  std::string text;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    long value = runs[i];
    if (i > 2) value -= runs[i - 2];
    bool more = true;
    while (more) {
      long letter = value & 0x1f;
      value >>= 5;
      more = (letter & 0x10) != 0 ? value != -1 : value != 0;
      if (more) letter |= 0x20;
      text += static_cast<char>(letter + 48);
    }
  }
  return text;
}

std::vector<int> read_compressed_runs(const std::string& text) {
  constexpr int kBits = 5, kMostBits = 30;
  std::vector<int> runs;
  std::size_t at = 0;
  while (at < text.size()) {
    std::int64_t value = 0;
    int shift = 0;
    bool more = true;
    while (more) {
      if (at == text.size() || shift > kMostBits) throw Error("ends within a number, or one is too long");
      const int letter = text[at++] - 48;
      if (letter < 0 || letter > 63) throw Error("has " + shown_letter(text, at - 1) + " that stands for no six bits");
      value |= static_cast<std::int64_t>(letter & 0x1f) << shift;
      shift += kBits;
      more = (letter & 0x20) != 0;
      if (!more && (letter & 0x10) != 0) value -= std::int64_t{1} << shift;
    }
    if (runs.size() > 2) value += runs[runs.size() - 2];
    if (value < 0 || value > kMostMaskPixels) throw Error("has a run of " + std::to_string(value) + " pixels");
    runs.push_back(static_cast<int>(value));
  }
  return runs;
}

void expect_whole(const MaskRuns& mask) {
  const std::int64_t pixels = static_cast<std::int64_t>(mask.size.width) * mask.size.height;
  std::int64_t sum = 0;
  for (const int run : mask.runs) {
    if (run < 0) throw Error("has a run of " + std::to_string(run) + " pixels");
    sum += run;
  }
  if (sum != pixels) {
    throw Error("has runs of " + std::to_string(sum) + " pixels together; expected width x height = " + std::to_string(pixels));
  }
}

cv::Mat mask_picture(const MaskRuns& mask) {
  cv::Mat columns = cv::Mat::zeros(mask.size.width, mask.size.height, CV_8UC1);  // transposed: a column of the picture is a row
  auto* at = columns.ptr<std::uint8_t>();
  std::uint8_t value = 0;
  for (const int run : mask.runs) {
    std::fill_n(at, run, value);
    at += run;
    value = static_cast<std::uint8_t>(255 - value);
  }
  return columns.t();
}

}  // namespace waretwin

// The reader's side of COCO's masks and their comparison, straight from the definitions.
#pragma once

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace waretwin::test {

inline bool same(const cv::Mat& a, const cv::Mat& b) { return a.size() == b.size() && cv::countNonZero(a != b) == 0; }

// Even-odd at the pixels' centres, straight from the definition.
inline cv::Mat filled(const std::vector<std::vector<double>>& polygons, const cv::Size& size) {
  cv::Mat mask = cv::Mat::zeros(size, CV_8UC1);
  for (const std::vector<double>& polygon : polygons) {
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        const double u = x + 0.5, v = y + 0.5;
        bool inside = false;
        for (std::size_t i = 0, j = polygon.size() - 2; i < polygon.size(); j = i, i += 2) {
          const double xi = polygon[i], yi = polygon[i + 1], xj = polygon[j], yj = polygon[j + 1];
          if ((yi > v) != (yj > v) && u < (xj - xi) * (v - yi) / (yj - yi) + xi) inside = !inside;
        }
        if (inside) mask.at<std::uint8_t>(y, x) = 255;
      }
    }
  }
  return mask;
}

// COCO's compressed text: letters from '0' on, five bits and one that says whether more follow, the fifth
// bit of the last is the sign.
inline std::vector<int> read_runs(const std::string& text) {
  std::vector<int> runs;
  for (std::size_t at = 0; at < text.size();) {
    long value = 0;
    int shift = 0;
    for (bool more = true; more; ++at, shift += 5) {
      const long letter = text[at] - 48;
      value |= (letter & 0x1f) << shift;
      more = (letter & 0x20) != 0;
      if (!more && (letter & 0x10) != 0) value |= -1L << (shift + 5);
    }
    if (runs.size() > 2) value += runs[runs.size() - 2];
    runs.push_back(static_cast<int>(value));
  }
  return runs;
}

inline cv::Mat from_runs(const std::vector<int>& runs, const cv::Size& size) {
  cv::Mat mask = cv::Mat::zeros(size, CV_8UC1);
  int at = 0;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    for (int k = 0; k < runs[i]; ++k, ++at) {
      if (i % 2 == 1) mask.at<std::uint8_t>(at % size.height, at / size.height) = 255;
    }
  }
  EXPECT_EQ(at, size.area());
  return mask;
}

}  // namespace waretwin::test

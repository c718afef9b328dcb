// Smallest and largest depth in square tiles of a depth image, 4 x 4, 8 x 8, 16 x 16 ... pixels: what a part of the picture can show.
#pragma once

#include <cstddef>
#include <limits>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace waretwin {

class DepthPyramid {
 public:
  // `depth`: CV_32FC1, metres, invalid where not > 0. A tile of which less than half is valid has smallest depth 0: nothing behind it
  // counts as seen.
  explicit DepthPyramid(const cv::Mat& depth);

  struct Range {
    float smallest = std::numeric_limits<float>::infinity();
    float largest = 0.0f;  // 0: no valid depth
  };
  // Over all tiles that touch the square of half-width `radius` around (u, v), all in pixels.
  Range range(float u, float v, float radius) const;
  // The same for a rectangle, over smaller tiles: tighter, and slower.
  Range range(float u0, float v0, float u1, float v1) const;
  float largest() const { return levels_.back().largest[0]; }

  // For each tile of a level the smallest depth of it and its eight neighbours: a lower limit for every square with its middle in the
  // tile and a half-width of at most one tile.
  struct Surroundings {
    int width = 0, height = 0;        // tiles
    float per_pixel = 0.0f;           // tiles
    const float* smallest = nullptr;  // row by row
  };
  // Of the finest level at which `radius` pixels are no more than a tile (the coarsest level where none is).
  Surroundings surroundings(float radius) const;

 private:
  struct Level {
    int width = 0, height = 0;
    std::vector<float> smallest, largest, around;
    std::size_t at(int x, int y) const {
      return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
    void allocate();
  };
  Range range_at(int level, float u0, float v0, float u1, float v1) const;
  static void base_row(const cv::Mat& depth, int row, Level& base);
  static void look_around(Level& level);

  std::vector<Level> levels_;
};

}  // namespace waretwin

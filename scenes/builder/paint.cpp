#include "scenes/builder/paint.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace waretwin::builder {
namespace {

double smooth(double t) { return t * t * (3 - 2 * t); }

void shift_pixel(cv::Vec3b& pixel, double by) {
  for (int c = 0; c < 3; ++c) pixel[c] = static_cast<std::uint8_t>(std::clamp(pixel[c] + by, 0.0, 255.0) + 0.5 - 1e-9);
}

}  // namespace

cv::Mat tiling_noise(int width, int height, int cells, int octaves, const std::string& key) {
  cv::Mat noise(height, width, CV_32F, cv::Scalar(0));
  double weight = 0.5, total = 0;
  for (int octave = 0; octave < octaves; ++octave, weight *= 0.5) {
    const int nx = std::min(cells << octave, width), ny = std::max(1, std::min(nx * height / width, height));
    const RandomStream random(0, key, "noise", octave);
    std::vector<double> grid(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny));
    for (std::size_t i = 0; i < grid.size(); ++i) grid[i] = random.uniform(i);
    const auto at = [&](int x, int y) {
      return grid[static_cast<std::size_t>(y % ny) * static_cast<std::size_t>(nx) + static_cast<std::size_t>(x % nx)];
    };
    for (int y = 0; y < height; ++y) {
      const double gy = static_cast<double>(y) * ny / height;
      const int iy = static_cast<int>(gy);
      const double ty = smooth(gy - iy);
      auto* row = noise.ptr<float>(y);
      for (int x = 0; x < width; ++x) {
        const double gx = static_cast<double>(x) * nx / width;
        const int ix = static_cast<int>(gx);
        const double tx = smooth(gx - ix);
        const double top = at(ix, iy) + tx * (at(ix + 1, iy) - at(ix, iy));
        const double bottom = at(ix, iy + 1) + tx * (at(ix + 1, iy + 1) - at(ix, iy + 1));
        row[x] += static_cast<float>(weight * (top + ty * (bottom - top)));
      }
    }
    total += weight;
  }
  for (int y = 0; y < height; ++y) {
    auto* row = noise.ptr<float>(y);
    for (int x = 0; x < width; ++x) row[x] = static_cast<float>(row[x] / total);
  }
  return noise;
}

cv::Mat mottled(int width, int height, const cv::Scalar& bgr, double coarse, double fine, const std::string& key) {
  cv::Mat picture(height, width, CV_8UC3, bgr);
  const cv::Mat slow = tiling_noise(width, height, 4, 4, key + " slow");
  const RandomStream grain(0, key, "grain");
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const auto index = static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(width) + static_cast<std::uint64_t>(x);
      const double g = fine > 0 ? 2 * grain.uniform(index) - 1 : 0;
      shift_pixel(picture.at<cv::Vec3b>(y, x), coarse * (2 * static_cast<double>(slow.at<float>(y, x)) - 1) + fine * g);
    }
  }
  return picture;
}

void add_stains(cv::Mat& picture, double amount, double threshold, int cells, const std::string& key) {
  const cv::Mat noise = tiling_noise(picture.cols, picture.rows, cells, 4, key + " stains");
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      const double over = (static_cast<double>(noise.at<float>(y, x)) - threshold) / (1 - threshold);
      if (over > 0) shift_pixel(picture.at<cv::Vec3b>(y, x), amount * std::min(1.0, 2.5 * over));
    }
  }
}

void add_scratches(cv::Mat& picture, int count, double length_px, const cv::Scalar& bgr, double opacity, const std::string& key) {
  const RandomStream random(0, key, "scratches");
  for (int i = 0; i < count; ++i) {
    const auto n = static_cast<std::uint64_t>(i);
    const double x = random.uniform(n, 0) * picture.cols, y = random.uniform(n, 1) * picture.rows;
    const double dx = 2 * random.uniform(n, 2) - 1, dy = 2 * random.uniform(n, 3) - 1;
    const double length = length_px * (0.3 + random.uniform(n, 4)), norm = std::sqrt(dx * dx + dy * dy) + 1e-6;
    const double strength = opacity * (0.4 + 0.6 * random.uniform(n, 5));
    for (int k = 0; k < static_cast<int>(length); ++k) {
      const int px = (static_cast<int>(x + dx / norm * k) % picture.cols + picture.cols) % picture.cols;
      const int py = (static_cast<int>(y + dy / norm * k) % picture.rows + picture.rows) % picture.rows;
      auto& pixel = picture.at<cv::Vec3b>(py, px);
      for (int c = 0; c < 3; ++c) pixel[c] = static_cast<std::uint8_t>(pixel[c] + strength * (bgr[c] - pixel[c]));
    }
  }
}

void add_streaks(cv::Mat& picture, double amount, int stretch, const std::string& key) {
  const RandomStream random(0, key, "streaks");
  const int across = std::max(1, picture.cols / stretch);
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      const double g = static_cast<double>(x) * across / picture.cols;
      const int cell = static_cast<int>(g);
      const auto value = [&](int k) {
        return random.uniform(static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(across) + static_cast<std::uint64_t>(k % across));
      };
      const double v = value(cell) + smooth(g - cell) * (value(cell + 1) - value(cell));
      shift_pixel(picture.at<cv::Vec3b>(y, x), amount * (2 * v - 1));
    }
  }
}

void put_text(cv::Mat& picture, const std::string& text, int x, int baseline_y, double height_px, const cv::Scalar& colour, int thickness) {
  // Hershey capitals are 21 units high at scale 1.
  cv::putText(picture, text, {x, baseline_y}, cv::FONT_HERSHEY_SIMPLEX, height_px / 21.0, colour, thickness, cv::LINE_AA);
}

void draw_barcode(cv::Mat& picture, const cv::Rect& area, const std::string& key) {
  const RandomStream random(0, key, "barcode");
  int x = area.x;
  for (std::uint64_t i = 0; x < area.x + area.width; ++i) {
    const int bar = 1 + static_cast<int>(random.uniform(2 * i) * 4), gap = 1 + static_cast<int>(random.uniform(2 * i + 1) * 4);
    cv::rectangle(picture, {x, area.y}, {std::min(x + bar, area.x + area.width) - 1, area.y + area.height - 1}, {20, 20, 20}, cv::FILLED);
    x += bar + gap;
  }
}

}  // namespace waretwin::builder

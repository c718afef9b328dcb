#include "sim/motion_blur.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"

namespace waretwin {

namespace {

// Shorter ways change nothing.
constexpr float kShortest = 1.0f;
// No way is followed farther, in pixels.
constexpr float kLongest = 256.0f;

// How far, during a row's exposure, the picture of a point moves on the plane z = 1. To first order in the turn, which is milliradians.
struct Motion {
  Motion(const Pose& X_WC_begin, const Pose& X_WC, const Pose& X_WC_end) {
    const Pose first = X_WC_begin.inverse() * X_WC, last = X_WC_end.inverse() * X_WC;
    R = (last.linear() - first.linear()).cast<float>();
    p = (last.translation() - first.translation()).cast<float>();
  }
  Eigen::Matrix3f R;  // of a point in the middle's frame: from where it is at first to where it is at last
  Eigen::Vector3f p;
};

using Linear = Eigen::Array4f;
using LinearAt = Eigen::Map<const Linear, Eigen::Aligned16>;

// A pixel's way over the picture, from half of it before the pixel to half of it behind. Strides are in floats: `step` along the way's
// longer part, `side` across.
struct Walk {
  const float* pixel;
  std::ptrdiff_t step, side;
  int before, behind;   // pixels in the picture along the longer part
  int left, right;      // and across
  float length, slope;  // of the longer part, and how far across for each pixel of it

  Linear mean() const {
    const float half = 0.5f * length;
    const auto reach = static_cast<int>(half + 0.5f), wide = static_cast<int>(half * std::abs(slope)) + 1;
    if (reach <= std::min(before, behind) && wide <= std::min(left, right)) return mean(reach, [](int k, int, int) { return k; });
    return mean(reach, [](int k, int low, int high) { return std::clamp(k, low, high); });
  }

 private:
  // `kept` keeps places within the picture.
  template <class Kept>
  Linear mean(int reach, const Kept& kept) const {
    const float half = 0.5f * length;
    Linear sum = Linear::Zero();
    for (int k = -reach; k <= reach; ++k) {
      // The part of the way that lies over this pixel.
      const float from = std::max(static_cast<float>(k) - 0.5f, -half), to = std::min(static_cast<float>(k) + 0.5f, half);
      const float weight = to - from;
      const float offset = 0.5f * (from + to) * slope, floor = std::floor(offset), part = offset - floor;
      const auto whole = static_cast<int>(floor);
      const float* line = pixel + step * kept(k, -before, behind);
      sum += (weight * (1.0f - part)) * LinearAt(line + side * kept(whole, -left, right)) +
             (weight * part) * LinearAt(line + side * kept(whole + 1, -left, right));
    }
    return sum / length;
  }
};

// Ways of one row's pixels, in pixels.
void ways(const cv::Mat& depth, const cv::Mat& directions, const PixelRays::Row& row, int y, float row_time, float* across, float* along) {
  const int width = depth.cols, up = std::max(y - 1, 0), down = std::min(y + 1, depth.rows - 1);
  const Motion motion(row.X_WC_begin, row.X_WC, row.X_WC_end);
  const Eigen::Matrix3f& R = motion.R;
  const Eigen::Vector3f& p = motion.p;
  const float rows_apart = 1.0f / static_cast<float>(down - up);
  const auto* z = depth.ptr<float>(y);
  const auto *here = directions.ptr<float>(y), *above = directions.ptr<float>(up), *below = directions.ptr<float>(down);
  for (int x = 0; x < width; ++x) {
    const float a = here[2 * x], b = here[2 * x + 1], near = z[x] > 0.0f ? 1.0f / z[x] : 0.0f;
    const float dx = R(0, 0) * a + R(0, 1) * b + R(0, 2) + near * p.x();
    const float dy = R(1, 0) * a + R(1, 1) * b + R(1, 2) + near * p.y();
    const float dz = R(2, 0) * a + R(2, 1) * b + R(2, 2) + near * p.z();
    const float way_x = dx - a * dz, way_y = dy - b * dz;
    // The lens: by how much directions change from pixel to pixel.
    const int left = std::max(x - 1, 0), right = std::min(x + 1, width - 1);
    const float apart = 1.0f / static_cast<float>(right - left);
    const float xu = (here[2 * right] - here[2 * left]) * apart, yu = (here[2 * right + 1] - here[2 * left + 1]) * apart;
    const float xv = (below[2 * x] - above[2 * x]) * rows_apart, yv = (below[2 * x + 1] - above[2 * x + 1]) * rows_apart;
    const float area = 1.0f / (xu * yv - yu * xv);
    const float u = (yv * way_x - xv * way_y) * area, v = (xu * way_y - yu * way_x) * area;
    // A point that moves along the columns meets later or earlier rows: the sharp picture shows its way stretched by the same factor.
    const float stretch = 1.0f / std::max(1.0f - v * row_time, 0.1f);
    across[x] = u * stretch;
    along[x] = v * stretch;
  }
}

}  // namespace

cv::Mat motion_blurred(const cv::Mat& radiance, const cv::Mat& depth, const cv::Mat& directions, const std::vector<PixelRays::Row>& rows,
                       double row_time) {
  WARETWIN_CHECK(radiance.type() == CV_32FC4 && radiance.isContinuous(), "radiance is a continuous image of four floats a pixel");
  WARETWIN_CHECK(depth.type() == CV_32FC1 && depth.size() == radiance.size(), "depth of the radiance's size");
  WARETWIN_CHECK(directions.type() == CV_32FC2 && directions.size() == radiance.size(), "directions of the radiance's size");
  const int width = radiance.cols, height = radiance.rows;
  cv::Mat out(radiance.size(), CV_32FC4);
  const std::ptrdiff_t line = std::ptrdiff_t{4} * width;
  parallel_for(static_cast<std::size_t>(height), 8, [&](std::size_t begin, std::size_t end) {
    std::vector<float> across(static_cast<std::size_t>(width)), along(across);  // pixels of the way
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      ways(depth, directions, rows[static_cast<std::size_t>(y)], y, static_cast<float>(row_time), across.data(), along.data());
      const auto* in = radiance.ptr<float>(y);
      auto* pixels = out.ptr<float>(y);
      for (int x = 0; x < width; ++x) {
        const float u = across[static_cast<std::size_t>(x)], v = along[static_cast<std::size_t>(x)];
        const float longer = std::max(std::abs(u), std::abs(v));
        Linear light = LinearAt(in + 4 * x);
        if (longer > kShortest) {
          const float length = std::min(longer, kLongest);
          const Walk walk = std::abs(u) >= std::abs(v) ? Walk{in + 4 * x, 4, line, x, width - 1 - x, y, height - 1 - y, length, v / u}
                                                       : Walk{in + 4 * x, line, 4, y, height - 1 - y, x, width - 1 - x, length, u / v};
          light = walk.mean();
        }
        Eigen::Map<Linear, Eigen::Aligned16>(pixels + 4 * x) = light;
      }
    }
  });
  return out;
}

}  // namespace waretwin

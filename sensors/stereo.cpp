#include "sensors/stereo.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"
#include "sensors/bulk_normals.h"
#include "sensors/depth_field.h"

namespace waretwin {

namespace {

constexpr std::size_t kRowsAtOnce = 16;
// Disparities of neighbours that differ by more belong to two surfaces: along a plane they change evenly, by baseline over its distance
// from the camera's axis.
constexpr float kJump_px = 1.0f;

// Sums of `count` neighbours down the columns: (rows) x (cols) from (rows + count - 1) x (cols). Every sum is added up by itself, from the
// top, so that it does not depend on how the rows are shared out.
cv::Mat sums_down(const cv::Mat& image, int count) {
  cv::Mat out(image.rows - count + 1, image.cols, CV_64FC1, cv::Scalar(0));
  parallel_for(static_cast<std::size_t>(out.rows), kRowsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      auto* sums = out.ptr<double>(y);
      for (int k = 0; k < count; ++k) {
        const auto* row = image.ptr<double>(y + k);
        for (int x = 0; x < out.cols; ++x) sums[x] += row[x];
      }
    }
  });
  return out;
}

// sums[x] = values[x] + ... + values[x + count - 1].
void sum_across(const float* values, int cols, int count, double* sums) {
  std::fill_n(sums, cols, 0.0);
  for (int k = 0; k < count; ++k) {
    for (int x = 0; x < cols; ++x) sums[x] += static_cast<double>(values[x + k]);
  }
}

// One standard normal a pixel; neighbours share what their windows share: correlation (1 - |dx| / window) (1 - |dy| / window).
cv::Mat window_noise(const RandomStream& random, cv::Size size, int window) {
  const int cols = size.width + window - 1, rows = size.height + window - 1;
  cv::Mat across(rows, size.width, CV_64FC1);
  const auto width = static_cast<std::uint64_t>((cols + 3) / 4);  // calls of the generator in a row, each for four pixels
  parallel_for(static_cast<std::size_t>(rows), kRowsAtOnce, [&](std::size_t begin, std::size_t end) {
    std::vector<float> row(4 * width);
    std::vector<std::array<std::uint32_t, 4>> words(width);
    std::vector<std::uint32_t> flat(4 * width);
    for (std::size_t y = begin; y < end; ++y) {
      random.fill(y * width, width, words.data());
      for (std::size_t i = 0; i < row.size(); ++i) flat[i] = words[i / 4][i % 4];
      for (std::size_t first = 0; first < row.size(); first += kNormalBlock) {
        normals_of_words(&flat[first], std::min(kNormalBlock, row.size() - first), &row[first]);
      }
      sum_across(row.data(), size.width, window, across.ptr<double>(static_cast<int>(y)));
    }
  });
  cv::Mat out = sums_down(across, window);
  out *= 1.0 / window;
  return out;
}

// Where a foreground begins within `reach` of a pixel, matching its window finds the foreground. `seen` goes with the disparity.
struct Matched {
  cv::Mat disparity, seen;
};

// A shadow next to a step of less than a pixel is narrower than a pixel itself: windows reach over it.
void bridge_narrow_shadows(Matched& matched) {
  parallel_for(static_cast<std::size_t>(matched.seen.rows), kRowsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      auto* seen = matched.seen.ptr<std::uint8_t>(y);
      const auto* disparity = matched.disparity.ptr<float>(y);
      // From the left, so that a pixel that was filled does not fill the next.
      for (int x = 0; x + 1 < matched.seen.cols; ++x) {
        if (seen[x] == 0 && seen[x + 1] != 0 && std::abs(disparity[x + 1] - disparity[x]) <= kJump_px) seen[x] = 1;
      }
    }
  });
}

// Along rows (dx = 1, dy = 0) or columns.
Matched fattened(const Matched& from, int reach, int dx, int dy) {
  Matched out = {from.disparity.clone(), from.seen.clone()};
  const int rows = from.disparity.rows, cols = from.disparity.cols;
  parallel_for(static_cast<std::size_t>(rows), kRowsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      for (int x = 0; x < cols; ++x) {
        float& best = out.disparity.at<float>(y, x);
        for (const int side : {-1, 1}) {
          float before = from.disparity.at<float>(y, x);
          for (int k = 1; k <= reach; ++k) {
            const int v = y + side * k * dy, u = x + side * k * dx;
            if (v < 0 || u < 0 || v >= rows || u >= cols) break;
            const float here = from.disparity.at<float>(v, u);
            if (here > before + kJump_px && here > best + kJump_px) {
              best = here;
              out.seen.at<std::uint8_t>(y, x) = from.seen.at<std::uint8_t>(v, u);
            }
            before = here;
          }
        }
      }
    }
  });
  return out;
}

}  // namespace

StereoModel::StereoModel(const CameraConfig& camera, std::uint64_t seed, const std::string& sensor)
    : camera_(camera), seed_(seed), sensor_(sensor), rays_(depth_rays(camera)) {
  if (camera.stereo.calibration) {
    calibration_error_px_ = camera.stereo.calibration_px * (2.0 * RandomStream(seed, sensor, "calibration").uniform(0) - 1.0);
  }
}

cv::Mat StereoModel::texture(const StereoSignal& signal) const {
  const StereoConfig& config = camera_.stereo;
  const int window = config.window_px, reach = window / 2, cols = signal.depth.cols;
  const double power = config.projector ? config.projector_power : 0.0;
  cv::Mat ambient, dots;
  cv::copyMakeBorder(signal.ambient, ambient, reach, reach, reach, reach, cv::BORDER_REPLICATE);
  cv::copyMakeBorder(signal.dots, dots, reach, reach, reach, reach, cv::BORDER_REPLICATE);
  // Of the window's rows: mean and mean square deviation of the ambient brightness, mean of the dots'.
  cv::Mat mean(ambient.rows, cols, CV_64FC1), square(ambient.rows, cols, CV_64FC1), dot_mean(ambient.rows, cols, CV_64FC1);
  parallel_for(static_cast<std::size_t>(ambient.rows), kRowsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      const auto* row = ambient.ptr<float>(y);
      auto *m = mean.ptr<double>(y), *s = square.ptr<double>(y), *d = dot_mean.ptr<double>(y);
      sum_across(row, cols, window, m);
      sum_across(dots.ptr<float>(y), cols, window, d);
      std::fill_n(s, cols, 0.0);
      for (int k = 0; k < window; ++k) {
        for (int x = 0; x < cols; ++x) s[x] += static_cast<double>(row[x + k]) * static_cast<double>(row[x + k]);
      }
      for (int x = 0; x < cols; ++x) {
        m[x] /= window;
        s[x] = std::max(s[x] / window - m[x] * m[x], 0.0);
        d[x] /= window;
      }
    }
  });
  const cv::Mat means = sums_down(mean, window), squares = sums_down(square, window), dot_means = sums_down(dot_mean, window);
  cv::Mat out(signal.depth.size(), CV_32FC1);
  parallel_for(static_cast<std::size_t>(out.rows), kRowsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      const auto *m = means.ptr<double>(y), *s = squares.ptr<double>(y), *d = dot_means.ptr<double>(y);
      for (int x = 0; x < cols; ++x) {
        out.at<float>(y, x) = static_cast<float>(
            config.texture_of(config.ambient * std::sqrt(s[x] / window), config.ambient * m[x] / window, power * d[x] / window));
      }
    }
  });
  return out;
}

cv::Mat StereoModel::read(const StereoSignal& signal, Stamp stamp) const {
  const auto fits = [this](const cv::Mat& image, int type) {
    return image.type() == type && image.isContinuous() && image.size() == rays_.size();
  };
  WARETWIN_CHECK(
      fits(signal.depth, CV_32FC1) && fits(signal.ambient, CV_32FC1) && fits(signal.dots, CV_32FC1) && fits(signal.seen, CV_8UC1),
      "signals are continuous images of the left camera's size");
  const StereoConfig& config = camera_.stereo;
  const auto scale = static_cast<float>(config.depth_times_disparity());
  Matched matched = {cv::Mat(rays_.size(), CV_32FC1), signal.seen};
  for (std::size_t p = 0; p < signal.depth.total(); ++p) {
    const float z = signal.depth.ptr<float>()[p];
    matched.disparity.ptr<float>()[p] = z > 0.0f && std::isfinite(z) ? scale / z : 0.0f;
  }
  if (config.fattening) {
    matched = fattened(matched, config.window_px / 2, 1, 0);
    matched = fattened(matched, config.window_px / 2, 0, 1);
    bridge_narrow_shadows(matched);
  }
  const cv::Mat textures = config.texture ? texture(signal) : cv::Mat();
  const RandomStream random(seed_, sensor_, "disparity_noise", stamp);
  const cv::Mat noise = config.noise ? window_noise(random, rays_.size(), config.correlation ? config.window_px : 1) : cv::Mat();
  const auto bias = static_cast<float>(calibration_error_px_);
  const auto steps = static_cast<float>(config.steps_per_px);
  const auto least = static_cast<float>(config.disparity_shift_px);
  const auto most = static_cast<float>(config.disparity_shift_px + config.max_disparity_px);
  const auto shortest = static_cast<float>(std::ceil(camera_.depth_min_m * 1000.0 - 1e-6));
  const auto longest = static_cast<float>(std::min(std::floor(camera_.depth_max_m * 1000.0 + 1e-6), 65535.0));
  const auto ambient = static_cast<float>(config.ambient);
  const auto power = static_cast<float>(config.projector ? config.projector_power : 0.0);
  const auto white = static_cast<float>(config.white());

  cv::Mat depth(rays_.size(), CV_32FC1, cv::Scalar(0));
  parallel_for(static_cast<std::size_t>(depth.rows), kRowsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      const auto* rays = rays_.ptr<cv::Vec3f>(y);
      auto* out = depth.ptr<float>(y);
      for (int x = 0; x < depth.cols; ++x) {
        float disparity = matched.disparity.at<float>(y, x);
        if (rays[x][2] == 0.0f || !(disparity > 0.0f)) continue;
        if (config.occlusion && matched.seen.at<std::uint8_t>(y, x) == 0) continue;
        float contrast = 0.0f;
        if (config.texture) {
          contrast = textures.at<float>(y, x);
          const float brightness = ambient * signal.ambient.at<float>(y, x) + power * signal.dots.at<float>(y, x);
          if (!(contrast >= static_cast<float>(config.min_texture)) || brightness > white) continue;
        }
        disparity += bias;
        if (config.noise) disparity += static_cast<float>(config.disparity_deviation(contrast) * noise.at<double>(y, x));
        if (config.quantisation && disparity > 0.0f) disparity = nearest_whole(disparity * steps) / steps;
        if (!(disparity > 0.0f) || disparity < least || disparity > most) continue;
        const float z = scale / disparity * 1000.0f;
        if (!(z >= shortest - 0.5f && z <= longest + 0.5f)) continue;
        const float reading = nearest_whole(z);
        if (reading >= shortest && reading <= longest) out[x] = reading * 0.001f;
      }
    }
  });
  return depth;
}

}  // namespace waretwin

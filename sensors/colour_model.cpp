#include "sensors/colour_model.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"
#include "sensors/bulk_normals.h"
#include "sensors/tone_curve.h"

namespace waretwin {

namespace {

// Pixels are worked on in blocks whose three colours use up whole calls of the generator: four words, two values each.
constexpr std::size_t kBlock = 168;
constexpr std::size_t kValues = 3 * kBlock, kCalls = kValues / 8;
static_assert(kValues % 8 == 0);
constexpr std::size_t kPiece = 48 * kBlock;

// Standard normals by 12 random bits: the middles of 4096 equally likely intervals, scaled to variance 1. Beyond 3.7 deviations there is
// none, and steps are finer than a picture's 8 bits can show; in return the table stays in the first-level cache.
constexpr int kNormalBits = 12;
using NormalTable = std::array<float, std::size_t{1} << kNormalBits>;

NormalTable make_normals() {
  NormalTable table{};
  std::vector<std::uint32_t> words;
  for (std::uint32_t i = 0; i < table.size(); ++i) words.push_back((2 * i + 1) << (31 - kNormalBits));
  for (std::size_t i = 0; i < table.size(); i += kNormalBlock) normals_of_words(&words[i], kNormalBlock, &table[i]);
  double squares = 0.0;
  for (const float x : table) squares += static_cast<double>(x) * static_cast<double>(x);
  const auto scale = static_cast<float>(std::sqrt(static_cast<double>(table.size()) / squares));
  for (float& x : table) x *= scale;
  return table;
}

cv::Mat rays_of(const Lens& lens) {
  cv::Mat rays(lens.intrinsics().height, lens.intrinsics().width, CV_32FC2);
  parallel_for(static_cast<std::size_t>(rays.rows), 8, [&](std::size_t begin, std::size_t end) {
    for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v) {
      for (int u = 0; u < rays.cols; ++u) {
        const auto ray = lens.ray(u, v);
        if (!ray)
          throw Error("colour.lens: pixel (" + std::to_string(u) + ", " + std::to_string(v) + ") sees nothing; expected another lens");
        rays.at<cv::Vec2f>(v, u) = {static_cast<float>(ray->x()), static_cast<float>(ray->y())};
      }
    }
  });
  return rays;
}

}  // namespace

ColourModel::ColourModel(const CameraConfig& camera, std::uint64_t seed, const std::string& sensor)
    : config_(camera.colour), seed_(seed), sensor_(sensor), rays_(rays_of(camera.colour_lens())) {
  if (config_.vignetting) {
    falloff_.resize(rays_.total());
    const auto* ray = rays_.ptr<cv::Vec2f>();
    for (float& value : falloff_) {
      value = static_cast<float>(config_.falloff(static_cast<double>((*ray)[0] * (*ray)[0] + (*ray)[1] * (*ray)[1])));
      ++ray;
    }
  }
  if (config_.white_balance) {
    const RandomStream random(seed, sensor, "white_balance");
    for (const std::uint64_t c : {0, 2}) {
      gain_[c] = static_cast<float>(1.0 + config_.white_balance_error * (2.0 * random.uniform(c) - 1.0));
    }
  }
}

// Calls sink(first pixel, count, values), three values a pixel.
template <class Sink>
void ColourModel::sense(const cv::Mat& radiance, Stamp stamp, const Sink& sink) const {
  WARETWIN_CHECK(radiance.type() == CV_32FC4 && radiance.isContinuous() && radiance.size() == rays_.size(),
                 "radiance is a continuous image of four floats a pixel, of the camera's size");
  const RandomStream random(seed_, sensor_, "colour_noise", stamp);
  const auto white = static_cast<float>(config_.electrons_at_white()), well = static_cast<float>(config_.full_well_e);
  const auto read_variance = static_cast<float>(config_.read_noise_e * config_.read_noise_e);
  const float to_radiance = 1.0f / white;
  static const NormalTable normals = make_normals();
  const auto* const in = radiance.ptr<float>();
  parallel_for(radiance.total(), kPiece, [&](std::size_t begin, std::size_t end) {
    std::array<std::array<std::uint32_t, 4>, kCalls> words;
    std::array<float, kValues> value, normal;
    for (std::size_t first = begin; first < end; first += kBlock) {
      const std::size_t count = std::min(kBlock, end - first), values = 3 * count;
      const float* pixel = in + 4 * first;
      for (std::size_t i = 0; i < count; ++i, pixel += 4) {
        const float arrives = falloff_.empty() ? 1.0f : falloff_[first + i];
        for (std::size_t c = 0; c < 3; ++c) value[3 * i + c] = pixel[c] * (arrives * gain_[c]);
      }
      if (config_.noise) {
        const std::size_t calls = (values + 7) / 8;
        random.fill(3 * first / 8, calls, words.data());
        for (std::size_t i = 0; i < calls; ++i) {
          for (std::size_t k = 0; k < 4; ++k) {
            normal[8 * i + 2 * k] = normals[words[i][k] >> (32 - kNormalBits)];
            normal[8 * i + 2 * k + 1] = normals[words[i][k] >> (16 - kNormalBits) & (normals.size() - 1)];
          }
        }
        for (std::size_t i = 0; i < values; ++i) {
          const float electrons = value[i] * white;
          const float counted = electrons + std::sqrt(std::max(electrons, 0.0f) + read_variance) * normal[i];
          value[i] = std::min(counted, well) * to_radiance;
        }
      }
      sink(first, count, value.data());
    }
  });
}

cv::Mat ColourModel::picture(const cv::Mat& radiance, Stamp stamp) const {
  cv::Mat out(rays_.size(), CV_8UC3);
  auto* const bytes = out.ptr<std::uint8_t>();
  sense(radiance, stamp, [bytes](std::size_t first, std::size_t count, const float* values) {
    std::array<std::uint8_t, kValues> toned;
    tone_mapped(values, 3 * count, toned.data());
    std::uint8_t* pixel = bytes + 3 * first;
    for (std::size_t i = 0; i < 3 * count; i += 3, pixel += 3) {
      pixel[0] = toned[i + 2];
      pixel[1] = toned[i + 1];
      pixel[2] = toned[i];
    }
  });
  return out;
}

cv::Mat ColourModel::sensed(const cv::Mat& radiance, Stamp stamp) const {
  cv::Mat out(rays_.size(), CV_32FC3);
  auto* const floats = out.ptr<float>();
  sense(radiance, stamp,
        [floats](std::size_t first, std::size_t count, const float* values) { std::copy_n(values, 3 * count, floats + 3 * first); });
  return out;
}

}  // namespace waretwin

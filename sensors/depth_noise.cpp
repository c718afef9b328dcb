#include "sensors/depth_noise.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"
#include "sensors/bulk_normals.h"
#include "sensors/depth_field.h"

namespace waretwin {

namespace {

constexpr std::size_t kBlock = kNormalBlock;
constexpr std::size_t kPiece = 32 * kBlock;

}  // namespace

DepthNoiseModel::DepthNoiseModel(const CameraConfig& camera, std::uint64_t seed, const std::string& sensor)
    : camera_(camera), seed_(seed), sensor_(sensor), field_(depth_field_mask(camera)) {}

void DepthNoiseModel::apply(cv::Mat& depth, Stamp stamp) const {
  WARETWIN_CHECK(depth.type() == CV_32FC1 && depth.isContinuous(), "depth is a continuous image of 32-bit floats");
  WARETWIN_CHECK(depth.size() == field_.size(), "depth has the size of the camera's image");
  const RandomStream random(seed_, sensor_, "depth_noise", stamp);
  auto* const pixels = depth.ptr<float>();
  const auto* const field = field_.ptr<std::uint8_t>();
  const bool noisy = camera_.noise.enabled;
  const auto base = static_cast<float>(camera_.noise.sigma_base_m);
  const auto growth = static_cast<float>(camera_.noise.sigma_per_m2);
  const auto dropped_below = static_cast<std::uint64_t>(std::ldexp(noisy ? camera_.noise.dropout_share : 0.0, 32));
  const auto shortest = static_cast<float>(std::ceil(camera_.depth_min_m * 1000.0 - 1e-6));
  const auto longest = static_cast<float>(std::min(std::floor(camera_.depth_max_m * 1000.0 + 1e-6), 65535.0));

  parallel_for(depth.total(), kPiece, [&](std::size_t begin, std::size_t end) {
    std::array<std::array<std::uint32_t, 4>, kBlock / 2> words;
    std::array<std::uint32_t, kBlock> normal_words;
    std::array<std::uint32_t, kBlock> dropout_words{};
    std::array<float, kBlock> normal{};
    for (std::size_t first = begin; first < end; first += kBlock) {
      const std::size_t count = std::min(kBlock, end - first);
      if (noisy) {
        // One call of the generator serves two neighbouring pixels. Blocks begin at even pixels.
        random.fill(first / 2, (count + 1) / 2, words.data());
        for (std::size_t i = 0; i < count; ++i) {
          normal_words[i] = words[i / 2][i % 2];
          dropout_words[i] = words[i / 2][2 + i % 2];
        }
        normals_of_words(normal_words.data(), count, normal.data());
      }
      for (std::size_t i = 0; i < count; ++i) {
        const float z = pixels[first + i];
        // A sum of this size rounds without loss; NaN and infinity fail the comparisons.
        const float sigma = noisy ? base + growth * z * z : 0.0f;
        const float reading = nearest_whole((z + sigma * normal[i]) * 1000.0f);
        const bool valid =
            (z > 0.0f) & (reading >= shortest) & (reading <= longest) & (field[first + i] != 0) & (dropout_words[i] >= dropped_below);
        pixels[first + i] = valid ? reading * 0.001f : 0.0f;
      }
    }
  });
}

}  // namespace waretwin

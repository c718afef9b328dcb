#include "sensors/time_of_flight.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"
#include "sensors/bulk_normals.h"
#include "sensors/depth_field.h"

namespace waretwin {

namespace {

// Waves of the systematic error: share of the mean square, and how many fit into the farthest range.
constexpr double kWaveShare[2] = {0.7, 0.3};
constexpr double kWaves[2] = {4.0, 8.0};
// Steps in which the systematic error is tabulated; linear in between, to a hundredth of a millimetre.
constexpr double kWiggleStep_m = 0.005;

}  // namespace

TimeOfFlightModel::TimeOfFlightModel(const CameraConfig& camera, std::uint64_t seed, const std::string& sensor)
    : camera_(camera), seed_(seed), sensor_(sensor), rays_(depth_rays(camera)) {
  const RandomStream random(seed, sensor, "wiggle_phase");
  for (std::uint64_t i = 0; i < 2; ++i) wiggle_phase_[i] = 2.0 * std::numbers::pi * random.uniform(i);
}

double TimeOfFlightModel::wiggle(double range) const {
  double sum = 0.0;
  for (int i = 0; i < 2; ++i) {
    const double angle = 2.0 * std::numbers::pi * kWaves[i] * range / camera_.depth_max_m + wiggle_phase_[i];
    sum += std::sqrt(2.0 * kWaveShare[i]) * std::sin(angle);
  }
  return camera_.time_of_flight.wiggle_rms_m * sum;
}

cv::Mat TimeOfFlightModel::read(const TimeOfFlightSignal& signal, Stamp stamp) const {
  const auto fits = [this](const cv::Mat& image) {
    return image.type() == CV_32FC1 && image.isContinuous() && image.size() == rays_.size();
  };
  WARETWIN_CHECK(fits(signal.range) && fits(signal.signal) && fits(signal.coherence) && fits(signal.indirect),
                 "signals are continuous images of 32-bit floats of the depth camera's size");
  const TimeOfFlightConfig& config = camera_.time_of_flight;
  const RandomStream random(seed_, sensor_, "range_noise", stamp);
  std::vector<float> wiggles;
  if (config.wiggle) {
    // Rays in the corners are longer than the depth they lead to.
    const auto steps = static_cast<std::size_t>(std::ceil(3.0 * camera_.depth_max_m / kWiggleStep_m)) + 2;
    for (std::size_t i = 0; i < steps; ++i) wiggles.push_back(static_cast<float>(wiggle(static_cast<double>(i) * kWiggleStep_m)));
  }
  const auto noise = static_cast<float>(config.noise_m), background = static_cast<float>(config.background);
  const auto shortest = static_cast<float>(std::ceil(camera_.depth_min_m * 1000.0 - 1e-6));
  const auto longest = static_cast<float>(std::min(std::floor(camera_.depth_max_m * 1000.0 + 1e-6), 65535.0));
  const bool strict = config.invalidation;
  const float low = strict ? static_cast<float>(config.min_signal) : 0.0f;
  const float high = strict ? static_cast<float>(config.max_signal) : std::numeric_limits<float>::infinity();
  const float most_indirect = strict ? static_cast<float>(config.max_indirect) : std::numeric_limits<float>::infinity();
  const float agreeing = strict ? static_cast<float>(config.min_coherence) : 0.0f;

  cv::Mat depth(rays_.size(), CV_32FC1);
  const auto* const ranges = signal.range.ptr<float>();
  const auto* const signals = signal.signal.ptr<float>();
  const auto* const coherences = signal.coherence.ptr<float>();
  const auto* const indirect = signal.indirect.ptr<float>();
  const auto* const rays = rays_.ptr<cv::Vec3f>();
  auto* const out = depth.ptr<float>();
  parallel_for(depth.total(), 16 * kNormalBlock, [&](std::size_t begin, std::size_t end) {
    std::array<std::array<std::uint32_t, 4>, kNormalBlock / 4> words;
    std::array<std::uint32_t, kNormalBlock> flat;
    std::array<float, kNormalBlock> normal{};
    for (std::size_t first = begin; first < end; first += kNormalBlock) {
      const std::size_t count = std::min(kNormalBlock, end - first);
      if (config.noise) {
        // One call of the generator serves four neighbouring pixels. Blocks begin at multiples of four.
        random.fill(first / 4, (count + 3) / 4, words.data());
        for (std::size_t i = 0; i < count; ++i) flat[i] = words[i / 4][i % 4];
        normals_of_words(flat.data(), count, normal.data());
      }
      for (std::size_t i = 0; i < count; ++i) {
        const std::size_t p = first + i;
        out[p] = 0.0f;
        float range = ranges[p];
        const float s = signals[p];
        if (!(range > 0.0f) || !std::isfinite(range) || rays[p][2] == 0.0f) continue;
        if (!(s > low) || s > high || coherences[p] < agreeing || indirect[p] > most_indirect) continue;
        if (!wiggles.empty()) {
          const float at = range * static_cast<float>(1.0 / kWiggleStep_m);
          const auto step = std::min(static_cast<std::size_t>(at), wiggles.size() - 2);
          range += wiggles[step] + (wiggles[step + 1] - wiggles[step]) * std::min(at - static_cast<float>(step), 1.0f);
        }
        if (config.noise) range += noise * std::sqrt(s + background) / s * normal[i];
        const float length = std::sqrt(rays[p][0] * rays[p][0] + rays[p][1] * rays[p][1] + 1.0f);
        const float z = range / length * 1000.0f;
        if (!(z >= shortest - 0.5f && z <= longest + 0.5f)) continue;
        const float reading = nearest_whole(z);
        if (reading >= shortest && reading <= longest) out[p] = reading * 0.001f;
      }
    }
  });
  if (strict) remove_outliers(depth);
  return depth;
}

void TimeOfFlightModel::remove_outliers(cv::Mat& depth) const {
  const cv::Mat before = depth.clone();
  const auto near = static_cast<float>(camera_.time_of_flight.outlier_m);
  parallel_for(static_cast<std::size_t>(depth.rows), 16, [&](std::size_t begin, std::size_t end) {
    for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v) {
      const int above = std::max(v - 1, 0), below = std::min(v + 1, depth.rows - 1);
      const float* rows[3] = {before.ptr<float>(above), before.ptr<float>(v), before.ptr<float>(below)};
      auto* out = depth.ptr<float>(v);
      for (int u = 0; u < depth.cols; ++u) {
        const float z = rows[1][u];
        if (z == 0.0f) continue;
        const float limit = near + 0.02f * z;
        const int left = std::max(u - 1, 0), right = std::min(u + 1, depth.cols - 1);
        int agree = -1;  // the pixel agrees with itself
        for (const float* row : rows) {
          for (int x = left; x <= right; ++x) agree += row[x] != 0.0f && std::abs(row[x] - z) <= limit;
        }
        if (agree < 2) out[u] = 0.0f;
      }
    }
  });
}

}  // namespace waretwin

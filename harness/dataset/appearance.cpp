#include "harness/dataset/appearance.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace waretwin {

namespace {

constexpr int kDrawn = 256;  // texels along a drawn texture
constexpr int kLargest = 1024;

// Smooth blots: a few octaves of random values, 0 to 1.
cv::Mat blots(int size, Dice& dice) {
  cv::Mat sum = cv::Mat::zeros(size, size, CV_32FC1);
  float weight = 0.5f;
  for (int cells = dice.whole(3, 8); cells < size && weight > 0.03f; cells *= 2, weight *= 0.5f) {
    cv::Mat coarse(cells, cells, CV_32FC1), fine;
    for (int y = 0; y < cells; ++y) {
      for (int x = 0; x < cells; ++x) coarse.at<float>(y, x) = static_cast<float>(dice.unit());
    }
    cv::resize(coarse, fine, sum.size(), 0, 0, cv::INTER_CUBIC);
    sum += weight * fine;
  }
  return cv::min(cv::max(sum, 0.0), 1.0);
}

cv::Vec3f colour(Dice& dice) {
  // Most of what stands in a hall is grey or nearly so.
  const double value = dice.between(0.03, 0.95), strength = dice.chance(0.5) ? dice.between(0.0, 0.15) : dice.between(0.2, 1.0);
  const double hue = dice.between(0.0, 6.0);
  cv::Vec3f out;
  for (int k = 0; k < 3; ++k) {
    const double distance = std::abs(std::remainder(hue - 2.0 * k, 6.0));  // from red, green, blue on the circle
    out[k] = static_cast<float>(value * (1.0 - strength * std::clamp(distance - 1.0, 0.0, 1.0)));
  }
  return out;
}

// Values 0 to 255, red, green, blue.
using Texels = cv::Mat_<cv::Vec4b>;

Texels pattern(Dice& dice) {
  const cv::Vec3f one = colour(dice), other = colour(dice);
  const int kind = dice.whole(0, 3), cells = dice.whole(2, 16);
  const double slant = dice.between(-1.0, 1.0);
  const cv::Mat field = kind == 3 ? blots(kDrawn, dice) : cv::Mat();
  Texels out(kDrawn, kDrawn);
  for (int y = 0; y < kDrawn; ++y) {
    for (int x = 0; x < kDrawn; ++x) {
      const double u = static_cast<double>(x) * cells / kDrawn, v = static_cast<double>(y) * cells / kDrawn;
      float share = 0.0f;
      switch (kind) {
        case 0:
          share = (static_cast<int>(u) + static_cast<int>(v)) % 2 == 0 ? 1.0f : 0.0f;
          break;  // squares
        case 1:
          share = static_cast<int>(std::floor(u + slant * v)) % 2 == 0 ? 1.0f : 0.0f;
          break;  // stripes
        case 2:
          share = std::hypot(u - std::floor(u) - 0.5, v - std::floor(v) - 0.5) < 0.3 ? 1.0f : 0.0f;
          break;  // dots
        default:
          share = std::clamp(4.0f * (field.at<float>(y, x) - 0.45f), 0.0f, 1.0f);  // camouflage
      }
      const cv::Vec3f mixed = 255.0f * (share * one + (1.0f - share) * other);
      out(y, x) = {cv::saturate_cast<std::uint8_t>(mixed[0]), cv::saturate_cast<std::uint8_t>(mixed[1]),
                   cv::saturate_cast<std::uint8_t>(mixed[2]), 255};
    }
  }
  return out;
}

void stain(Texels& texels, Dice& dice) {
  cv::Mat where;
  cv::resize(blots(kDrawn, dice), where, texels.size(), 0, 0, cv::INTER_LINEAR);
  const double threshold = dice.between(0.35, 0.6), strength = dice.between(0.2, 0.7);
  const cv::Vec3f dirt = 255.0f * (dice.chance(0.3) ? cv::Vec3f(0.8f, 0.78f, 0.72f) : cv::Vec3f(0.16f, 0.13f, 0.1f));  // dust or oil
  for (int y = 0; y < texels.rows; ++y) {
    for (int x = 0; x < texels.cols; ++x) {
      const auto share =
          static_cast<float>(strength * std::clamp((static_cast<double>(where.at<float>(y, x)) - threshold) / 0.15, 0.0, 1.0));
      cv::Vec4b& texel = texels(y, x);
      for (int k = 0; k < 3; ++k)
        texel[k] = cv::saturate_cast<std::uint8_t>((1.0f - share) * static_cast<float>(texel[k]) + share * dirt[k]);
    }
  }
}

Texels texels_of(const Texture& texture) {
  const cv::Mat stored(texture.height, texture.width, CV_8UC4, const_cast<std::uint8_t*>(texture.rgba.data()));
  Texels out;
  const double scale = std::min(1.0, static_cast<double>(kLargest) / std::max(texture.width, texture.height));
  if (scale < 1.0) {
    cv::resize(stored, out, {}, scale, scale, cv::INTER_AREA);
  } else {
    stored.copyTo(out);
  }
  return out;
}

int add_texture(Scene& scene, const Texels& texels, const Texture& like) {
  Texture texture;
  texture.name = "varied";
  texture.width = texels.cols;
  texture.height = texels.rows;
  texture.wrap_u = like.wrap_u;
  texture.wrap_v = like.wrap_v;
  texture.rgba.assign(texels.datastart, texels.dataend);
  scene.textures.push_back(std::move(texture));
  return static_cast<int>(scene.textures.size()) - 1;
}

void paint(Material& material, const cv::Vec3f& to) {
  for (int k = 0; k < 3; ++k) material.base_colour[k] = to[k] * to[k];  // about linear
}

}  // namespace

void vary_light(Scene& scene, const LightVariation& config, Dice& dice) {
  std::vector<Light> on;
  for (Light light : scene.lights) {
    const bool off = dice.chance(config.off_share);
    light.intensity *= static_cast<float>(dice.stops(config.strength_stops));
    light.intensity.x() *= static_cast<float>(1.0 + dice.between(-config.tint, config.tint));
    light.intensity.z() *= static_cast<float>(1.0 + dice.between(-config.tint, config.tint));
    if (!off) on.push_back(light);
  }
  if (on.empty() && !scene.lights.empty()) on.push_back(scene.lights.front());
  scene.lights = std::move(on);
  const auto factor = static_cast<float>(dice.stops(config.ambient_stops));
  scene.ambient *= factor;
  scene.background *= factor;
}

void vary_materials(Scene& scene, const MaterialVariation& config, Dice& dice) {
  for (Material& material : scene.materials) {
    const bool tinted = dice.chance(config.tint_share), repainted = dice.chance(config.repaint_share),
               patterned = dice.chance(config.pattern_share), dirty = dice.chance(config.dirt_share);
    const cv::Vec3f paint_colour = colour(dice);
    Eigen::Vector3f tint;
    for (int k = 0; k < 3; ++k) tint[k] = static_cast<float>(1.0 + dice.between(-config.tint, config.tint));
    const auto brighter = static_cast<float>(1.0 + dice.between(-config.tint, config.tint));
    const double rougher = dice.between(-config.roughness, config.roughness);
    if (!material.emissive.isZero(0.0f)) continue;
    material.roughness = static_cast<float>(std::clamp(static_cast<double>(material.roughness) + rougher, 0.05, 1.0));
    if (repainted || patterned) material.metallic = 0.0f;
    Texels texels;
    Texture like;
    if (patterned && !material.alpha_mask) {
      texels = pattern(dice);
      paint(material, {1.0f, 1.0f, 1.0f});
      const auto scale = static_cast<float>(dice.between(0.5, 4.0));
      material.base_colour_texture.uv_transform.leftCols<2>() = scale * Eigen::Matrix2f::Identity();
    } else if (repainted && !material.alpha_mask) {
      paint(material, paint_colour);
      material.base_colour_texture = {};
    } else if (tinted) {
      for (int k = 0; k < 3; ++k) material.base_colour[k] = std::clamp(material.base_colour[k] * tint[k] * brighter, 0.0f, 1.0f);
    }
    if (dirty) {
      if (texels.empty() && material.base_colour_texture.texture >= 0) {
        like = scene.textures[static_cast<std::size_t>(material.base_colour_texture.texture)];
        texels = texels_of(like);
      } else if (texels.empty()) {
        texels = Texels(kDrawn, kDrawn, cv::Vec4b(255, 255, 255, 255));
      }
      stain(texels, dice);
    }
    if (!texels.empty()) material.base_colour_texture.texture = add_texture(scene, texels, like);
  }
}

}  // namespace waretwin

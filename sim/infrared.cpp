#include "sim/infrared.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace waretwin {

float reflectivity_850nm(const Material& material, const SurfacePoint& point) {
  if (!std::isnan(material.reflectivity_850nm)) return material.reflectivity_850nm;
  return std::clamp(point.base_colour.maxCoeff(), 0.03f, 0.95f);
}

InfraredAnswer infrared_answer(const Material& material, const SurfacePoint& point, const Eigen::Vector3f& towards) {
  const float reflectivity = reflectivity_850nm(material, point);
  const float metallic = std::clamp(point.metallic, 0.0f, 1.0f);
  InfraredAnswer answer;
  answer.albedo = reflectivity * (1.0f - 0.8f * metallic);
  const float cosine = std::clamp(point.normal.dot(towards), 0.0f, 1.0f);
  const float roughness = std::clamp(point.roughness, 0.045f, 1.0f);
  const float alpha2 = roughness * roughness * roughness * roughness;
  const float cosine2 = cosine * cosine;
  const float base = cosine2 * (alpha2 - 1.0f) + 1.0f;
  const float distribution = alpha2 / (std::numbers::pi_v<float> * base * base);
  const float head_on = 0.04f * (1.0f - metallic) + 0.8f * metallic * reflectivity;
  const float visibility = 0.25f / std::max(cosine * std::sqrt(cosine2 * (1.0f - alpha2) + alpha2), 1e-4f);
  const float lobe = std::numbers::pi_v<float> * distribution * head_on * visibility;
  answer.backscatter = (answer.albedo + lobe) * cosine;
  if (material.retroreflection > 0.0f) {
    answer.retroreflected = material.retroreflection * cosine2 * cosine2 * cosine2;
    answer.backscatter += answer.retroreflected;
  }
  return answer;
}

}  // namespace waretwin

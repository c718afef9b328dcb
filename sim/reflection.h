// How a surface reflects: glTF's metallic-roughness model (Lambert below, GGX above; glTF 2.0 appendix B).
#pragma once

#include <Eigen/Core>

#include "sim/surfaces.h"

namespace waretwin {

// The material's values in the form in which light is computed.
struct Reflection {
  Eigen::Vector3f diffuse;   // albedo of what enters the surface
  Eigen::Vector3f specular;  // reflectance head-on, F0
  float roughness = 1.0f;    // perceptual, >= 0.045; GGX's alpha is its square
  // Albedo of the glossy layer for the present direction of view: a fit by Karis ("Physically based shading on mobile", 2014).
  Eigen::Vector3f glossy_albedo;
};

Reflection reflection_of(const SurfacePoint& point, float n_dot_v);

// Rec. 709.
inline float luminance(const Eigen::Vector3f& rgb) { return 0.2126f * rgb.x() + 0.7152f * rgb.y() + 0.0722f * rgb.z(); }

}  // namespace waretwin

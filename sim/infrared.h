// How a surface answers the light of a depth camera at 850 nm.
#pragma once

#include "scenes/scene.h"
#include "sim/surfaces.h"

namespace waretwin {

struct InfraredAnswer {
  float albedo = 0.0f;          // share of the light that leaves in all directions alike
  float backscatter = 0.0f;     // light back to a lamp beside the lens: 1 = a white diffuse surface seen straight on
  float retroreflected = 0.0f;  // the part of it that a retroreflector sends back
};

// The share of light that a material reflects at 850 nm: what its extras say; otherwise a guess, the brightest channel of the base colour
// (dyes and pigments that are dark in the visible mostly are not in the near infrared, black rubber and soot stay dark).
float reflectivity_850nm(const Material& material, const SurfacePoint& point);

// Lambert's law for the diffuse part and a GGX lobe (glTF 2.0, appendix B) whose half vector is the direction of view. A metal keeps a
// fifth of its reflectivity as diffuse light: machined and dirty metal is no mirror. A retroreflective sheet adds what its material says
// straight ahead, times the sixth power of the cosine: 42 % at 30 deg (ASTM D4956 asks for 30 of 70), 2 % at 60 deg. `towards`: unit, from
// the point to the camera.
InfraredAnswer infrared_answer(const Material& material, const SurfacePoint& point, const Eigen::Vector3f& towards);

}  // namespace waretwin

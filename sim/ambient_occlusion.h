// How much of the light from all around reaches a picture's surfaces (ambient occlusion).
#pragma once

#include <cstdint>
#include <vector>

#include "sim/lit_picture.h"
#include "sim/ray_caster.h"

namespace waretwin {

// By one ray from every other pixel of the picture's half-size guide, smoothed: 1 in the open, 0 where something near is all around; in the
// order of half_guide. `scratch` is kept by the caller.
void find_openness(const RayCaster& ray_caster, const LitPicture& picture, std::uint32_t seed, std::vector<float>& openness,
                   std::vector<float>& scratch);

}  // namespace waretwin

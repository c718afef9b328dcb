// From radiance to the camera's 8-bit colours.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace waretwin {

// A filmic curve, exposure included: the fit to ACES by K. Narkowicz, "ACES filmic tone mapping curve" (2015), then the sRGB curve.
// Monotonic; 0 -> 0, all from about 12 up -> 255. NaN -> 0.
std::uint8_t tone_mapped(float radiance);

}  // namespace waretwin

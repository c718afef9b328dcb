// From radiance to the camera's 8-bit colours.
#pragma once

#include <cstddef>
#include <cstdint>

namespace waretwin {

// A filmic curve, exposure included: the fit to ACES by K. Narkowicz, "ACES filmic tone mapping curve" (2015), then the sRGB curve.
// Monotonic; 0 -> 0, all from about 12 up -> 255. NaN -> 0.
std::uint8_t tone_mapped(float radiance);
void tone_mapped(const float* radiances, std::size_t count, std::uint8_t* out);

// The sRGB curve alone: [0, 1] -> 0 ... 255, rounded; clamped outside.
std::uint8_t srgb_from_linear(float value);

}  // namespace waretwin

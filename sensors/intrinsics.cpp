#include "sensors/intrinsics.h"

#include <cmath>

#include "core/error.h"

namespace waretwin {

Intrinsics Intrinsics::checked(int width, int height, double fx, double fy, double cx, double cy) {
  constexpr int kLargest = 16384;
  if (width < 1 || width > kLargest || height < 1 || height > kLargest) {
    throw Error("camera size " + std::to_string(width) + " x " + std::to_string(height) + " px; expected 1 to " + std::to_string(kLargest) +
                " each way");
  }
  for (const double focal : {fx, fy}) {
    if (!(focal > 0.0) || !std::isfinite(focal)) {
      throw Error("camera focal length " + std::to_string(focal) + " px; expected a positive number");
    }
  }
  for (const double centre : {cx, cy}) {
    if (!std::isfinite(centre)) throw Error("camera principal point " + std::to_string(centre) + " px; expected a finite number");
  }
  return {width, height, fx, fy, cx, cy};
}

Intrinsics Intrinsics::from_field_of_view(int width, int height, double horizontal, double vertical) {
  // The edges of the image lie half a pixel beyond the centres of its outermost pixels.
  return checked(width, height, 0.5 * width / std::tan(0.5 * horizontal), 0.5 * height / std::tan(0.5 * vertical), 0.5 * (width - 1),
                 0.5 * (height - 1));
}

}  // namespace waretwin

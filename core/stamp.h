// Time: integer nanoseconds since the start of a stream (or since the epoch, in recordings that say so).
#pragma once

#include <cmath>
#include <cstdint>

namespace waretwin {

using Stamp = std::int64_t;

inline constexpr Stamp kNanosecondsPerSecond = 1'000'000'000;

inline double to_seconds(Stamp stamp) { return static_cast<double>(stamp) * 1e-9; }
inline Stamp from_seconds(double seconds) { return static_cast<Stamp>(std::llround(seconds * 1e9)); }

}  // namespace waretwin

// What the CPU can do. Embree, OpenCV and libm choose their kernels by it and differ in last bits, so score.json records it.
#pragma once

#include <string>
#include <vector>

namespace waretwin {

// Names of the vector instruction sets in use, from old to new ("sse2", ..., "avx2", "fma", "avx512f"). Empty on other architectures
// than x86.
std::vector<std::string> cpu_features();

// The maker's name of the CPU; "unknown" where the system does not say.
std::string cpu_model();

}  // namespace waretwin

// The type of number that a training multiplies.
#pragma once

#include <ATen/ATen.h>

#include <string>

namespace waretwin::train {

// Whether this processor multiplies bfloat16 faster than float32 (AVX512_BF16) and libtorch makes use of it.
bool has_fast_bfloat16();

// train.precision with "auto" decided: "bfloat16" where that is faster here, else "float32".
std::string decided_precision(const std::string& precision);
// Of "float32" or "bfloat16". The latter works on any processor, slowly on most.
at::ScalarType type_of(const std::string& decided);

}  // namespace waretwin::train

// The type of number that a training multiplies.
#pragma once

#include <ATen/ATen.h>

#include <string>

namespace waretwin::train {

// Whether this processor multiplies bfloat16 faster than float32 (AVX512_BF16) and libtorch makes use of it.
bool has_fast_bfloat16();

// Of train.precision: "float32", "bfloat16", or "auto" for whatever is faster here. The second works on any processor, slowly on most.
at::ScalarType type_of(const std::string& precision);

}  // namespace waretwin::train

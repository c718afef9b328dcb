#include "harness/train/precision.h"

namespace waretwin::train {

bool has_fast_bfloat16() {
#if defined(__x86_64__)
  return at::globalContext().hasMKLDNN() && __builtin_cpu_supports("avx512bf16");
#else
  return false;
#endif
}

at::ScalarType type_of(const std::string& precision) {
  if (precision == "auto") return has_fast_bfloat16() ? at::kBFloat16 : at::kFloat;
  return precision == "bfloat16" ? at::kBFloat16 : at::kFloat;
}

}  // namespace waretwin::train

#include "harness/train/precision.h"

namespace waretwin::train {

bool has_fast_bfloat16() {
#if defined(__x86_64__)
  return at::globalContext().hasMKLDNN() && __builtin_cpu_supports("avx512bf16");
#else
  return false;
#endif
}

std::string decided_precision(const std::string& precision) {
  if (precision != "auto") return precision;
  return has_fast_bfloat16() ? "bfloat16" : "float32";
}

at::ScalarType type_of(const std::string& decided) { return decided == "bfloat16" ? at::kBFloat16 : at::kFloat; }

}  // namespace waretwin::train

#include "harness/program/freed_memory.h"

#include <malloc.h>

namespace waretwin {

void keep_freed_memory() {
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, -1);
}

}  // namespace waretwin

#include "harness/program/found_units.h"

#include <cstdio>

namespace waretwin {

void print_found(int found, int unwatched, const std::string& out) {
  if (found > 0) std::printf("%d runs were there already, of this program and configuration (%s/units)\n", found, out.c_str());
  if (unwatched > 0)
    std::printf("of these, %d are of another mapper's command, whose own files were not compared: external_mapper.depends names some\n",
                unwatched);
}

}  // namespace waretwin

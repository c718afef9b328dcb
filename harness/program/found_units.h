// What of a suite or study was there already.
#pragma once

#include <string>

namespace waretwin {

// To stdout; nothing where none were. `unwatched` of the `found` are another mapper's that names no files it is made of.
void print_found(int found, int unwatched, const std::string& out);

}  // namespace waretwin

// Files that a result depends on, by contents.
#pragma once

#include <string>
#include <vector>

#include "core/digest.h"

namespace waretwin {

// Adds the bytes of each file, and of a folder all that is in it with the names there; links are followed, below a folder too. Where the
// files lie does not count. Each file is read once by a process, and again where its stamps say that it is another one. Throws Error for
// what is missing or cannot be read.
void add_dependencies(const std::vector<std::string>& files, Digest& digest);

}  // namespace waretwin

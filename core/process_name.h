// What tells this process from all others that may write into the same folder, also from another machine's.
#pragma once

#include <string>

namespace waretwin {

// "4711-1f2e3d4c": the process number and a digest of the machine's name. Letters, digits and '-'.
std::string process_name();

}  // namespace waretwin

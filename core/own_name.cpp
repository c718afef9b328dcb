#include "core/own_name.h"

namespace waretwin {

namespace fs = std::filesystem;

std::string own_name(const fs::path& path) {
  const fs::path whole = fs::absolute(path.empty() ? fs::path(".") : path).lexically_normal();
  return (whole.has_filename() ? whole : whole.parent_path()).filename().string();
}

}  // namespace waretwin

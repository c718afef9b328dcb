#include "core/process_name.h"

#include <unistd.h>

#include <array>

#include "core/digest.h"

namespace waretwin {

std::string process_name() {
  // Containers have process numbers of their own, and each the same ones, but names that differ.
  static const std::string machine = [] {
    std::array<char, 256> name{};
    if (::gethostname(name.data(), name.size() - 1) != 0) name[0] = '\0';
    Digest digest;
    digest.add(std::string_view(name.data()));
    return digest.hex().substr(0, 8);
  }();
  return std::to_string(::getpid()) + "-" + machine;
}

}  // namespace waretwin

#include "core/error.h"

#include <cstdio>
#include <cstdlib>

namespace waretwin {

namespace {

std::string with_place(const std::filesystem::path& file, int line, const std::string& message) {
  std::string text = file.string();
  if (line > 0) text += ":" + std::to_string(line);
  return text + ": " + message;
}

}  // namespace

Error::Error(const std::filesystem::path& file, const std::string& message) : Error(with_place(file, 0, message)) {}

Error::Error(const std::filesystem::path& file, int line, const std::string& message) : Error(with_place(file, line, message)) {}

void check_failed(const char* condition, const char* file, int line, std::string_view message) {
  std::fprintf(stderr, "waretwin: broken invariant at %s:%d: %s (%.*s)\n", file, line, condition, static_cast<int>(message.size()),
               message.data());
  std::abort();
}

}  // namespace waretwin

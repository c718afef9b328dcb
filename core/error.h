// How waretwin fails. Bad input throws Error with one line for the user; a broken invariant of ours aborts.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace waretwin {

// Bad input: a file, key, value or command line that cannot be used. what() is one line that names the place, the value found and
// what was expected. The program prints it and exits with code 2.
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& message) : std::runtime_error(message) {}
  // "FILE: message" and "FILE:LINE: message"; line counts from 1, a line <= 0 is left out.
  Error(const std::filesystem::path& file, const std::string& message);
  Error(const std::filesystem::path& file, int line, const std::string& message);
};

// A fault of ours that was noticed where it can still be reported (exit code 3).
class InternalError : public std::logic_error {
  using std::logic_error::logic_error;
};

[[noreturn]] void check_failed(const char* condition, const char* file, int line, std::string_view message);

}  // namespace waretwin

// Aborts with place and message when an invariant of ours is broken. Never for user input. Armed in all test builds.
#ifdef WARETWIN_CHECKS_ARMED
#define WARETWIN_CHECK(condition, message) \
  (static_cast<bool>(condition) ? void(0) : ::waretwin::check_failed(#condition, __FILE__, __LINE__, message))
#else
#define WARETWIN_CHECK(condition, message) void(0)
#endif

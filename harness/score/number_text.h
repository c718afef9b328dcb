// A score as text, for tables and summaries.
#pragma once

#include <cstdio>
#include <optional>
#include <string>

namespace waretwin {

// By a printf pattern for one double; "-" where there is nothing to say.
inline std::string number(const char* pattern, const std::optional<double>& value) {
  if (!value) return "-";
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, pattern, *value);
  return buffer;
}

}  // namespace waretwin

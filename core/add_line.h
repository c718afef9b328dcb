// Text that people read, line by line.
#pragma once

#include <string>

namespace waretwin {

// Appends a line, by a printf pattern without the line's end.
[[gnu::format(printf, 2, 3)]] void add_line(std::string& text, const char* format, ...);

}  // namespace waretwin

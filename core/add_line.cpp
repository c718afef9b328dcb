#include "core/add_line.h"

#include <cstdarg>
#include <cstdio>
#include <vector>

#include "core/error.h"

namespace waretwin {

void add_line(std::string& text, const char* format, ...) {
  va_list arguments, again;
  va_start(arguments, format);
  va_copy(again, arguments);
  const int length = std::vsnprintf(nullptr, 0, format, arguments);
  va_end(arguments);
  std::vector<char> line(length < 0 ? 0 : static_cast<std::size_t>(length) + 1);
  const int written = std::vsnprintf(line.data(), line.size(), format, again);
  va_end(again);
  WARETWIN_CHECK(length >= 0 && written == length, "a line that printf can write");
  text.append(line.data(), static_cast<std::size_t>(length));
  text += '\n';
}

}  // namespace waretwin

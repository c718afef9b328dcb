#include "core/json_text.h"

#include <algorithm>
#include <cctype>

namespace waretwin {

void refuse_json(const std::filesystem::path& file, const std::string& text, std::size_t byte, const std::string& expected) {
  constexpr std::size_t kShown = 20;
  const std::size_t at = std::min(byte == 0 ? 0 : byte - 1, text.size());
  const auto line = static_cast<int>(1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
  std::string shown;
  for (std::size_t i = at; i < text.size() && shown.size() < kShown && text[i] != '\n' && text[i] != '\r'; ++i) {
    shown += std::isprint(static_cast<unsigned char>(text[i])) != 0 ? text[i] : '?';
  }
  const std::string problem = at == text.size() ? "ends too early" : shown.empty() ? "breaks off" : "goes wrong at '" + shown + "'";
  throw Error(file, line, "is not JSON: it " + problem + "; expected " + expected);
}

}  // namespace waretwin

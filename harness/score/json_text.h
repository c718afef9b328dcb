// JSON that others wrote, with errors in our own words.
#pragma once

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "core/error.h"

namespace waretwin {

// Says where `text` stops being JSON; `byte` counts from 1 and is beyond the text where that ended too early.
[[noreturn]] inline void refuse_json(const std::filesystem::path& file, const std::string& text, std::size_t byte,
                                     const std::string& expected) {
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

// The text of `file` as JSON. Throws Error naming file and line for what is none, and for numbers beyond a double's range; `expected` says
// what the file should hold. What `wanted` (as in nlohmann's parse) returns false for is left out.
template <class Json = nlohmann::json>
Json parse_json(const std::filesystem::path& file, const std::string& text, const std::string& expected,
                const typename Json::parser_callback_t& wanted = nullptr) {
  try {
    return Json::parse(text, wanted);
  } catch (const typename Json::parse_error& error) {
    refuse_json(file, text, error.byte, expected);
  } catch (const typename Json::exception&) {
    throw Error(file, "is not JSON that can be read: it holds a number that is out of range; expected " + expected);
  }
}

}  // namespace waretwin

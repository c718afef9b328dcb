// JSON that others wrote, with errors in our own words. The library that reads it is the caller's: core links none.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "core/error.h"

namespace waretwin {

// Says where `text` stops being JSON; `byte` counts from 1 and is beyond the text where that ended too early.
[[noreturn]] void refuse_json(const std::filesystem::path& file, const std::string& text, std::size_t byte, const std::string& expected);

// The text of `file` as JSON, an nlohmann::basic_json. Throws Error naming file and line for what is none, and for numbers beyond a
// double's range; `expected` says what the file should hold. What `wanted` (as in nlohmann's parse) returns false for is left out.
template <class Json>
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

#include "scenes/gltf_uri.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "core/error.h"

namespace waretwin {

namespace fs = std::filesystem;

namespace {

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::string percent_decoded(std::string_view uri) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] != '%') {
      text += uri[i];
      continue;
    }
    const int high = i + 2 < uri.size() ? hex_digit(uri[i + 1]) : -1;
    const int low = i + 2 < uri.size() ? hex_digit(uri[i + 2]) : -1;
    if (high < 0 || low < 0) throw Error("URI '" + std::string(uri) + "' has a '%' without two hexadecimal digits");
    text += static_cast<char>(high * 16 + low);
    i += 2;
  }
  return text;
}

std::array<int, 256> base64_table() {
  std::array<int, 256> table;
  table.fill(-1);
  const std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < digits.size(); ++i) table[static_cast<unsigned char>(digits[i])] = static_cast<int>(i);
  return table;
}

}  // namespace

bool is_data_uri(std::string_view uri) {
  const std::string_view scheme = "data:";
  return uri.size() >= scheme.size() && std::equal(scheme.begin(), scheme.end(), uri.begin(), [](char a, char b) {
           return a == static_cast<char>(std::tolower(static_cast<unsigned char>(b)));
         });
}

std::string decode_data_uri(std::string_view uri) {
  static const std::array<int, 256> table = base64_table();
  const std::size_t comma = uri.find(',');
  if (comma == std::string_view::npos || !uri.substr(0, comma).ends_with(";base64")) {
    throw Error("data URI is not base64; expected data:...;base64,...");
  }
  std::string_view digits = uri.substr(comma + 1);
  while (!digits.empty() && digits.back() == '=') digits.remove_suffix(1);
  if (digits.size() % 4 == 1) throw Error("data URI is cut off");
  std::string bytes;
  bytes.reserve(digits.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : digits) {
    const int value = table[static_cast<unsigned char>(c)];
    if (value < 0) throw Error("data URI holds a character that is not base64");
    bits = (bits << 6) | static_cast<std::uint32_t>(value);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>((bits >> count) & 0xff);
  }
  return bytes;
}

bool lies_within(const fs::path& path, const fs::path& folder) {
  std::error_code failure;
  const fs::path target = fs::canonical(path, failure);
  if (failure) return false;
  const fs::path base = fs::canonical(folder.empty() ? fs::path(".") : folder, failure);
  if (failure) return false;
  return std::mismatch(base.begin(), base.end(), target.begin(), target.end()).first == base.end();
}

fs::path resolve_uri(const fs::path& folder, std::string_view uri) {
  const std::string name = percent_decoded(uri);
  const std::string quoted = "URI '" + std::string(uri) + "'";
  if (name.empty()) throw Error("has an empty URI");
  if (std::any_of(name.begin(), name.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == '\\'; })) {
    throw Error(quoted + " holds a control character or a backslash");
  }
  // A scheme is letters, digits, '+', '-', '.' before the first ':', with no '/' before it.
  const std::size_t colon = name.find(':');
  if (colon != std::string::npos && name.find('/') > colon) throw Error(quoted + " has a scheme; expected a relative path");
  const fs::path relative(name);
  if (relative.is_absolute()) throw Error(quoted + " is absolute; expected a path relative to the glTF file");
  for (const fs::path& part : relative) {
    if (part == "..") throw Error(quoted + " leaves the folder of the glTF file");
  }
  const fs::path path = folder / relative;
  std::error_code ignored;
  if (!fs::exists(path, ignored)) throw Error(quoted + " names a file that does not exist");
  if (!lies_within(path, folder)) throw Error(quoted + " leaves the folder of the glTF file");
  if (!fs::is_regular_file(path, ignored)) throw Error(quoted + " does not name a regular file");
  return path;
}

}  // namespace waretwin

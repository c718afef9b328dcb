#include "harness/labelled/label_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>

#include "core/error.h"
#include "core/files.h"

namespace waretwin {

namespace {

constexpr std::uintmax_t kLargestText = std::uintmax_t{256} << 20;  // bytes: a list of a million pictures

std::vector<std::string_view> words(std::string_view line) {
  std::vector<std::string_view> found;
  constexpr std::string_view kBlanks = " \t\r\v\f";
  for (std::size_t at = line.find_first_not_of(kBlanks); at != std::string_view::npos; at = line.find_first_not_of(kBlanks, at)) {
    const std::size_t end = std::min(line.find_first_of(kBlanks, at), line.size());
    found.push_back(line.substr(at, end - at));
    at = end;
  }
  return found;
}

template <class T>
std::optional<T> parsed(std::string_view word) {
  T value{};
  const auto [end, status] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (status != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

}  // namespace

std::string trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n\v\f";
  const auto first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return "";
  return std::string(text.substr(first, text.find_last_not_of(kBlanks) - first + 1));
}

std::vector<std::string> read_lines(const std::filesystem::path& file) {
  const std::string text = read_file(file, kLargestText);
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    lines.push_back(trimmed(std::string_view(text).substr(at, end - at)));
    at = end + 1;
  }
  return lines;
}

cv::Rect2d inside_picture(const cv::Rect2d& share) {
  const double left = std::max(0.0, share.x), top = std::max(0.0, share.y);
  // What lies inside keeps its very width: 1 - left would change its last bits.
  const double width = share.x >= 0.0 && share.x + share.width <= 1.0 ? share.width : std::min(1.0, share.x + share.width) - left;
  const double height = share.y >= 0.0 && share.y + share.height <= 1.0 ? share.height : std::min(1.0, share.y + share.height) - top;
  if (!(width > 0.0) || !(height > 0.0)) return {};
  return {left, top, width, height};
}

std::vector<LabelledBox> read_label_text(const std::filesystem::path& file, std::size_t classes) {
  const std::vector<std::string> lines = read_lines(file);
  std::vector<LabelledBox> boxes;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (lines[i].empty()) continue;
    const int number = static_cast<int>(i) + 1;
    const std::vector<std::string_view> parts = words(lines[i]);
    const auto index = parts.size() == 5 ? parsed<int>(parts[0]) : std::nullopt;
    std::array<double, 4> share{};
    bool usable = index.has_value();
    for (std::size_t k = 0; usable && k < 4; ++k) {
      const auto value = parsed<double>(parts[k + 1]);
      usable = value && std::isfinite(*value);
      if (usable) share[k] = *value;
    }
    if (!usable) throw Error(file, number, "'" + lines[i].substr(0, 60) + "'; expected a class number and four numbers: CLASS CX CY W H");
    if (*index < 0 || static_cast<std::size_t>(*index) >= classes) {
      throw Error(file, number, "class " + std::to_string(*index) + " has no name; expected 0 to " + std::to_string(classes - 1));
    }
    const auto [cx, cy, width, height] = share;
    const auto within = [](double value) { return value >= 0.0 && value <= 1.0; };
    LabelledBox box;
    box.class_index = *index;
    box.share = inside_picture({cx - 0.5 * width, cy - 0.5 * height, width, height});
    if (!within(cx) || !within(cy) || !within(width) || !within(height) || box.share.empty()) {
      throw Error(file, number,
                  "'" + lines[i].substr(0, 60) + "' is no box; expected centre and size as shares of the picture, 0 to 1, size above 0");
    }
    boxes.push_back(box);
  }
  return boxes;
}

std::vector<std::string> read_class_list(const std::filesystem::path& file) {
  std::vector<std::string> names = read_lines(file);
  while (!names.empty() && names.back().empty()) names.pop_back();
  if (names.empty()) throw Error(file, "no class names; expected one a line");
  std::set<std::string> seen;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const int line = static_cast<int>(i) + 1;
    if (names[i].empty()) throw Error(file, line, "blank line; expected a class name");
    if (!seen.insert(names[i]).second) throw Error(file, line, "class '" + names[i] + "' stands twice");
  }
  return names;
}

}  // namespace waretwin

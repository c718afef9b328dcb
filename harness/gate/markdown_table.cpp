#include "harness/gate/markdown_table.h"

#include <algorithm>

namespace waretwin {

std::string markdown_table(const std::vector<std::vector<std::string>>& rows, std::size_t words, bool last_is_word) {
  using Row = std::vector<std::string>;
  const std::size_t columns = rows.front().size();
  const auto left = [&](std::size_t i) { return i < words || (last_is_word && i + 1 == columns); };
  std::vector<std::size_t> widths(columns, 3);
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < columns; ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  const auto add = [&](const Row& row) {
    for (std::size_t i = 0; i < columns; ++i) {
      const std::string space(widths[i] - row[i].size(), ' ');
      text += (i == 0 ? "| " : " | ") + (left(i) ? row[i] + space : space + row[i]);
    }
    text += " |\n";
  };
  add(rows.front());
  Row line;
  for (std::size_t i = 0; i < columns; ++i) line.push_back(left(i) ? std::string(widths[i], '-') : std::string(widths[i] - 1, '-') + ":");
  add(line);
  std::for_each(rows.begin() + 1, rows.end(), add);
  return text;
}

}  // namespace waretwin

// A Markdown table that reads as plain text, too.
#pragma once

#include <string>
#include <vector>

namespace waretwin {

// The first row is the head; all have the same number of cells. The first `words` columns and, if `last_is_word`, the last one are flush
// left, the others flush right.
std::string markdown_table(const std::vector<std::vector<std::string>>& rows, std::size_t words, bool last_is_word = false);

}  // namespace waretwin

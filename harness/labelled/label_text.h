// Labels as text, a file a picture, a line a box: class number, then centre, width and height as shares of the picture (Darknet, YOLO).
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "harness/labelled/labelled_set.h"

namespace waretwin {

// Throws Error with file and line for anything but "CLASS CX CY W H", for a class number of `classes` or more, and for shares that are no
// box: centres outside [0, 1], widths outside (0, 1].
std::vector<LabelledBox> read_label_text(const std::filesystem::path& file, std::size_t classes);

// The box cut off at the picture's edges; empty where nothing of it is inside.
cv::Rect2d inside_picture(const cv::Rect2d& share);

// One class name a line; blank lines at the end are left out. Throws Error for an empty file, a blank line between names, and a name that
// stands twice.
std::vector<std::string> read_class_list(const std::filesystem::path& file);

// Without blanks at both ends.
std::string trimmed(std::string_view text);

// Lines of a text file, trimmed. Throws Error when it cannot be read.
std::vector<std::string> read_lines(const std::filesystem::path& file);

}  // namespace waretwin

// Sets whose labels are text files: Darknet's .data file with its lists, and a folder of loose pictures.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "harness/labelled/labelled_set.h"

namespace waretwin {

// The splits that a .data file names.
std::vector<std::string> darknet_splits(const std::filesystem::path& data);
LabelledSet read_darknet_set(const std::filesystem::path& data, const std::string& split);

// The file of class names that makes a folder with pictures a set: in the folder, in its images/ or its labels/. Nothing where there is
// none. Throws Error where there are several.
std::optional<std::filesystem::path> loose_names(const std::filesystem::path& folder);
LabelledSet read_loose_set(const std::filesystem::path& folder, const std::filesystem::path& names);

// Files of a folder with one of these endings (lower case, with the dot; upper case counts as well), by name.
std::vector<std::filesystem::path> files_of(const std::filesystem::path& folder, const std::vector<std::string>& endings);

}  // namespace waretwin

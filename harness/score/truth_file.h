// The true objects that a map is compared with, from whichever file holds them.
#pragma once

#include <filesystem>
#include <vector>

#include "harness/score/cuboid_file.h"

namespace waretwin {

// A truth.json (or any list of objects), a SceneNN annotation (.xml), or a folder with truth.json or else one .xml. Throws Error where
// there is none, or several annotations.
std::filesystem::path truth_file(const std::filesystem::path& path);

// Whether a folder holds any of them.
bool has_truth(const std::filesystem::path& folder);

// Its objects. An annotation is in the recording's world: it is turned into that of the map in `map_folder`, which upright.json tells.
// Throws Error as the readers do.
std::vector<ListedObject> read_truth(const std::filesystem::path& file, const std::filesystem::path& map_folder);

}  // namespace waretwin

// What a file or folder is called, however the path to it was written.
#pragma once

#include <filesystem>
#include <string>

namespace waretwin {

// "drive" of "data/drive/", of "drive/left/.." and, when working in it, of "." or nothing. Links keep their own name. Empty for the root.
std::string own_name(const std::filesystem::path& path);

}  // namespace waretwin

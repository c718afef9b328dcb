// URIs of buffers and pictures in glTF files: embedded data, or a file that lies beside or below the glTF file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace waretwin {

bool is_data_uri(std::string_view uri);

// The bytes of "data:...;base64,...". Throws Error (without a file name) when it is not base64.
std::string decode_data_uri(std::string_view uri);

// The file that a relative URI names, percent-encoding resolved. Throws Error (without a file name) for absolute paths, URIs with a scheme,
// and paths that leave `folder`, be it by ".." or by symbolic links.
std::filesystem::path resolve_uri(const std::filesystem::path& folder, std::string_view uri);

// True where `path` exists and, all symbolic links resolved, lies in `folder` or below it.
bool lies_within(const std::filesystem::path& path, const std::filesystem::path& folder);

}  // namespace waretwin

// Reading whole files, and writing them so that a killed run or a full disk leaves nothing half-written under a final name.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <string_view>

namespace waretwin {

// The bytes of a file. Throws Error when it is missing, is a folder, cannot be read, or is larger than `limit` bytes.
std::string read_file(const std::filesystem::path& path, std::uintmax_t limit = std::uintmax_t{4} << 30);

// Writes the bytes to a temporary name beside `path` and renames it. Throws Error when the disk is full or the folder is missing; the
// old file, if any, is then untouched and the temporary one removed.
void write_file(const std::filesystem::path& path, std::string_view bytes);

// For writers that want a path of their own (image encoders, glTF): calls write(temporary) and renames the result to `path`. The
// temporary name keeps the extension. Whatever write throws is passed on after the temporary file is removed.
void write_file_by(const std::filesystem::path& path, const std::function<void(const std::filesystem::path& temporary)>& write);

// Makes a folder and its parents. Throws Error when that fails or a file is in the way.
void make_folder(const std::filesystem::path& path);

// A text that grows while it is written, for what is too long to be held. Not atomic: for files of a StagedFolder.
class GrowingFile {
 public:
  // Throws Error when the file cannot be made.
  explicit GrowingFile(const std::filesystem::path& path);
  // Throws Error when the disk is full; part of the bytes may wait in memory until close().
  void append(std::string_view bytes);
  // Throws Error when not everything reached the file. Nothing may be appended after it.
  void close();

 private:
  std::filesystem::path path_;
  std::ofstream out_;
};

}  // namespace waretwin

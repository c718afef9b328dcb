#include "harness/units/dependencies.h"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <utility>

#include "core/error.h"

namespace waretwin {

namespace fs = std::filesystem;

namespace {

using FileId = std::pair<std::uint64_t, std::uint64_t>;  // device and inode
using Stamps = std::array<std::int64_t, 5>;              // size, changes of the bytes and of the inode (s, ns)

FileId id_of(const struct stat& file) { return {file.st_dev, file.st_ino}; }

Stamps stamps_of(const struct stat& file) {
  return {file.st_size, file.st_mtim.tv_sec, file.st_mtim.tv_nsec, file.st_ctim.tv_sec, file.st_ctim.tv_nsec};
}

// In pieces: weights may be larger than memory.
std::uint64_t bytes_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw Error(file, "cannot be read: " + std::string(std::strerror(errno)));
  Digest digest;
  std::vector<char> piece(1 << 20);
  while (in) {
    in.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    digest.add_bytes(piece.data(), static_cast<std::size_t>(in.gcount()));
  }
  if (in.bad()) throw Error(file, "cannot be read to its end");
  return digest.value();
}

// Of a study's thousand drives each asks for the same gigabytes.
std::uint64_t bytes_once(const fs::path& file, const struct stat& found) {
  static std::mutex mutex;
  static std::map<FileId, std::pair<Stamps, std::uint64_t>> known;
  const std::lock_guard lock(mutex);
  const Stamps stamps = stamps_of(found);
  const auto before = known.find(id_of(found));
  if (before != known.end() && before->second.first == stamps) return before->second.second;
  const std::uint64_t bytes = bytes_of(file);
  known[id_of(found)] = {stamps, bytes};
  return bytes;
}

// A folder with all that its names lead to. One that was there already, by a link to it or to what it lies in, is named and not gone
// through again: so cycles end.
class FolderWalk {
 public:
  explicit FolderWalk(Digest& digest) : digest_(digest) {}

  void add(const fs::path& folder, const struct stat& found, const fs::path& name) {
    const auto [before, is_new] = met_.emplace(id_of(found), name);
    if (!is_new) {
      digest_.add("as");
      digest_.add(before->second.string());
      return;
    }
    std::vector<fs::path> inside;
    try {
      for (const auto& entry : fs::directory_iterator(folder)) inside.push_back(entry.path().filename());
    } catch (const fs::filesystem_error& error) {
      throw Error(folder, "cannot be read: " + error.code().message());
    }
    std::sort(inside.begin(), inside.end());
    for (const fs::path& part : inside) add_part(folder / part, name / part);
  }

 private:
  // Names within a folder count, for they are what the command knows its files by.
  void add_part(const fs::path& place, const fs::path& name) {
    struct stat found = {};
    const bool leads_somewhere = stat(place.c_str(), &found) == 0;
    if (leads_somewhere && !S_ISREG(found.st_mode) && !S_ISDIR(found.st_mode)) return;  // pipes and the like hold nothing
    digest_.add(name.string());
    if (!leads_somewhere) {
      if (errno == EACCES) throw Error(place, "cannot be read: " + std::string(std::strerror(errno)));
      digest_.add("leads nowhere");
    } else if (S_ISDIR(found.st_mode)) {
      add(place, found, name);
    } else {
      digest_.add(bytes_once(place, found));
    }
  }

  Digest& digest_;
  std::map<FileId, fs::path> met_;
};

}  // namespace

void add_dependencies(const std::vector<std::string>& files, Digest& digest) {
  for (const std::string& file : files) {
    struct stat found = {};
    if (stat(file.c_str(), &found) != 0) throw Error(file, "cannot be read: " + std::string(std::strerror(errno)));
    if (S_ISDIR(found.st_mode)) {
      FolderWalk(digest).add(file, found, "");
    } else if (S_ISREG(found.st_mode)) {
      digest.add(bytes_once(file, found));
    } else {
      throw Error(file, "is neither a file nor a folder");
    }
  }
}

}  // namespace waretwin

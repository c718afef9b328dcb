#include "core/files.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include "core/error.h"
#include "core/process_name.h"

namespace waretwin {

namespace fs = std::filesystem;

namespace {

// Also two threads of this process may write the same file.
fs::path temporary_name(const fs::path& path) {
  static std::atomic<unsigned> count{0};
  fs::path name = path.parent_path() / ("." + path.stem().string() + ".partial-" + process_name() + "-" + std::to_string(count++));
  name += path.extension();
  return name;
}

void rename_into_place(const fs::path& temporary, const fs::path& path) {
  std::error_code failure;
  fs::rename(temporary, path, failure);
  if (failure) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    throw Error(path, "cannot write: " + failure.message());
  }
}

class FileDescriptor {
 public:
  explicit FileDescriptor(int fd) : fd_(fd) {}
  ~FileDescriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  int get() const { return fd_; }
  int close() {
    const int result = ::close(fd_);
    fd_ = -1;
    return result;
  }

 private:
  int fd_;
};

}  // namespace

std::string read_file(const fs::path& path, std::uintmax_t limit) {
  std::error_code failure;
  const fs::file_status status = fs::status(path, failure);
  if (!fs::exists(status)) throw Error(path, "no such file");
  if (fs::is_directory(status)) throw Error(path, "is a folder; expected a file");
  std::ifstream in(path, std::ios::binary);
  if (!in) throw Error(path, std::string("cannot be read: ") + std::strerror(errno));
  const std::uintmax_t size = fs::is_regular_file(status) ? fs::file_size(path, failure) : 0;
  if (size > limit) {
    throw Error(path, "has " + std::to_string(size) + " bytes; expected at most " + std::to_string(limit));
  }
  std::string bytes;
  bytes.reserve(size);
  char piece[1 << 16];
  while (in.read(piece, sizeof piece), in.gcount() > 0) {
    bytes.append(piece, static_cast<std::size_t>(in.gcount()));
    if (bytes.size() > limit) throw Error(path, "is longer than " + std::to_string(limit) + " bytes");
  }
  if (in.bad()) throw Error(path, "cannot be read to its end");
  return bytes;
}

void write_file(const fs::path& path, std::string_view bytes) {
  write_file_by(path, [&](const fs::path& temporary) {
    FileDescriptor file(::open(temporary.c_str(), O_CREAT | O_WRONLY | O_TRUNC | O_CLOEXEC, 0666));
    if (file.get() < 0) throw Error(path, std::string("cannot write: ") + std::strerror(errno));
    std::size_t done = 0;
    while (done < bytes.size()) {
      const ssize_t n = ::write(file.get(), bytes.data() + done, bytes.size() - done);
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) throw Error(path, std::string("cannot write: ") + std::strerror(n < 0 ? errno : ENOSPC));
      done += static_cast<std::size_t>(n);
    }
    if (file.close() != 0) throw Error(path, std::string("cannot write: ") + std::strerror(errno));
  });
}

void write_file_by(const fs::path& path, const std::function<void(const fs::path&)>& write) {
  const fs::path temporary = temporary_name(path);
  try {
    write(temporary);
  } catch (...) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    throw;
  }
  rename_into_place(temporary, path);
}

GrowingFile::GrowingFile(const fs::path& path) : path_(path), out_(path, std::ios::binary | std::ios::trunc) {
  if (!out_) throw Error(path_, std::string("cannot write: ") + std::strerror(errno));
}

void GrowingFile::append(std::string_view bytes) {
  errno = 0;
  out_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!out_) throw Error(path_, std::string("cannot write: ") + std::strerror(errno != 0 ? errno : EIO));
}

void GrowingFile::close() {
  errno = 0;
  out_.close();
  if (!out_) throw Error(path_, std::string("cannot write: ") + std::strerror(errno != 0 ? errno : EIO));
}

void make_folder(const fs::path& path) {
  std::error_code failure;
  fs::create_directories(path, failure);
  if (failure || !fs::is_directory(path)) {
    throw Error(path, "cannot make the folder: " + (failure ? failure.message() : std::string("a file is in the way")));
  }
}

}  // namespace waretwin

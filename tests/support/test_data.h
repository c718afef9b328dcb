// Places that tests read from: the repository itself, and the folder of real recordings that a user's machine does not have.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

namespace waretwin::test {

inline std::filesystem::path repository() { return WARETWIN_SOURCE_DIR; }
inline std::filesystem::path shared_data(const std::string& name) { return std::filesystem::path(WARETWIN_TEST_DATA) / name; }

// A fresh empty folder that is removed at the end of the scope.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "waretwin-test-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make " + name);
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace waretwin::test

// Skips the test, saying so, where the folder of real data is missing.
#define WARETWIN_NEED_DATA(name)                                     \
  if (!std::filesystem::exists(::waretwin::test::shared_data(name))) \
  GTEST_SKIP() << "needs the real data in " << ::waretwin::test::shared_data(name)

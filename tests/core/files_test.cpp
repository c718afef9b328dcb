#include "core/files.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>

#include "core/digest.h"
#include "tests/support/expect_error.h"
#include "tests/support/test_data.h"

namespace waretwin {
namespace {

namespace fs = std::filesystem;

std::size_t entries(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(Files, WriteReplacesWholeFiles) {
  const test::TemporaryFolder folder;
  const fs::path file = folder.path() / "a.txt";
  write_file(file, "first, longer");
  const std::string bytes("second\0\n", 8);
  write_file(file, bytes);
  EXPECT_EQ(read_file(file), bytes);
  write_file(file, "");
  EXPECT_EQ(read_file(file), "");
  EXPECT_EQ(entries(folder.path()), 1u);
}

TEST(Files, MissingPlacesAreNamed) {
  const test::TemporaryFolder folder;
  EXPECT_ERROR(write_file(folder.path() / "none" / "a.txt", "x"), "a.txt: cannot write", "No such file");
  EXPECT_ERROR(read_file(folder.path() / "none.txt"), "none.txt: no such file");
  EXPECT_ERROR(read_file(folder.path()), "is a folder");
  write_file(folder.path() / "big", "12345");
  EXPECT_ERROR(read_file(folder.path() / "big", 4), "has 5 bytes; expected at most 4");
  EXPECT_ERROR(read_file("/dev/zero", 1000), "longer than 1000 bytes");
}

TEST(Files, AFailedWriteLeavesTheOldFile) {
  const test::TemporaryFolder folder;
  const fs::path file = folder.path() / "a.png";
  write_file(file, "old");
  EXPECT_ERROR(write_file_by(file,
                             [&](const fs::path& temporary) {
                               EXPECT_EQ(temporary.extension(), ".png");
                               EXPECT_EQ(temporary.parent_path(), folder.path());
                               write_file(temporary, "half");
                               throw Error("out of ink");
                             }),
               "out of ink");
  EXPECT_EQ(read_file(file), "old");
  EXPECT_EQ(entries(folder.path()), 1u);
}

// A file size limit makes write() fail in its midst, as a full disk does.
TEST(Files, AFullDiskIsNoticed) {
  const test::TemporaryFolder folder;
  const fs::path file = folder.path() / "a.bin";
  write_file(file, "old");
  struct rlimit before {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  struct rlimit small = before;
  small.rlim_cur = 100000;
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  EXPECT_ERROR(write_file(file, std::string(300000, 'x')), "a.bin: cannot write");
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(read_file(file), "old");
  EXPECT_EQ(entries(folder.path()), 1u);
}

TEST(Files, AFolderThatCannotBeWrittenIsNamed) {
  if (::geteuid() == 0) GTEST_SKIP() << "the superuser may write everywhere";
  const test::TemporaryFolder folder;
  fs::permissions(folder.path(), fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_ERROR(write_file(folder.path() / "a.txt", "x"), "cannot write", "Permission denied");
  fs::permissions(folder.path(), fs::perms::owner_all);
}

TEST(Files, FoldersAreMadeWithTheirParents) {
  const test::TemporaryFolder folder;
  make_folder(folder.path() / "a" / "b");
  make_folder(folder.path() / "a" / "b");
  EXPECT_TRUE(fs::is_directory(folder.path() / "a" / "b"));
  write_file(folder.path() / "file", "x");
  EXPECT_ERROR(make_folder(folder.path() / "file"), "cannot make the folder");
  EXPECT_ERROR(make_folder(folder.path() / "file" / "below"), "cannot make the folder");
}

TEST(Digest, EqualForEqualInputAndDifferentForAnyChange) {
  const auto of = [](std::initializer_list<std::string> parts) {
    Digest digest;
    for (const std::string& part : parts) digest.add(part);
    return digest.hex();
  };
  EXPECT_EQ(of({"abc", "d"}), of({"abc", "d"}));
  EXPECT_EQ(of({"abc"}).size(), 16u);
  const std::vector<std::string> all = {
      of({}),           of({""}),         of({"", ""}),      of({"abc", "d"}),      of({"ab", "cd"}),   of({"abcd"}),
      of({"d", "abc"}), of({"abcdefgh"}), of({"abcdefghi"}), of({"abcdefgh", "i"}), of({"abcdefg\x01"})};
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) EXPECT_NE(all[i], all[k]) << i << " " << k;
  }
}

TEST(Digest, SeesEveryBit) {
  std::vector<double> values(40, 1.5);
  Digest whole;
  whole.add(values);
  for (std::size_t bit = 0; bit < 40 * 64; ++bit) {
    std::vector<double> changed = values;
    reinterpret_cast<unsigned char*>(changed.data())[bit / 8] ^= static_cast<unsigned char>(1u << (bit % 8));
    Digest other;
    other.add(changed);
    ASSERT_NE(other.value(), whole.value()) << bit;
  }
}

}  // namespace
}  // namespace waretwin

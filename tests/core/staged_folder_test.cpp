#include "core/staged_folder.h"

#include <gtest/gtest.h>

#include "core/files.h"
#include "tests/support/expect_error.h"
#include "tests/support/test_data.h"

namespace waretwin {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> names(const fs::path& folder) {
  std::vector<std::string> list;
  for (const auto& entry : fs::directory_iterator(folder)) list.push_back(entry.path().filename().string());
  std::sort(list.begin(), list.end());
  return list;
}

TEST(StagedFolder, AppearsWhenItIsComplete) {
  const test::TemporaryFolder folder;
  const fs::path place = folder.path() / "new/result";
  StagedFolder staged(place);
  write_file(staged.path() / "a.txt", "a");
  EXPECT_FALSE(fs::exists(place));
  staged.commit();
  EXPECT_EQ(read_file(place / "a.txt"), "a");
  EXPECT_EQ(names(place.parent_path()), std::vector<std::string>{"result"});
}

TEST(StagedFolder, LeavesTheOldFolderAloneUntilThen) {
  const test::TemporaryFolder folder;
  const fs::path place = folder.path() / "result";
  make_folder(place);
  write_file(place / "old.txt", "old");
  {
    const StagedFolder given_up(place);
    write_file(given_up.path() / "half.txt", "half");
  }
  EXPECT_EQ(names(folder.path()), std::vector<std::string>{"result"});
  EXPECT_EQ(names(place), std::vector<std::string>{"old.txt"});
  // The slash that a shell's completion adds.
  StagedFolder staged(place / "");
  write_file(staged.path() / "new.txt", "new");
  staged.commit();
  EXPECT_EQ(names(folder.path()), std::vector<std::string>{"result"});
  EXPECT_EQ(names(place), std::vector<std::string>{"new.txt"});
}

TEST(StagedFolder, GoesWhereALinkLeads) {
  const test::TemporaryFolder folder;
  make_folder(folder.path() / "disk/result");
  fs::create_directory_symlink(folder.path() / "disk/result", folder.path() / "link");
  StagedFolder staged(folder.path() / "link");
  write_file(staged.path() / "new.txt", "new");
  staged.commit();
  EXPECT_TRUE(fs::is_symlink(folder.path() / "link"));
  EXPECT_EQ(names(folder.path() / "disk/result"), std::vector<std::string>{"new.txt"});
}

TEST(StagedFolder, NamesWhatIsInTheWay) {
  const test::TemporaryFolder folder;
  write_file(folder.path() / "file", "x");
  EXPECT_ERROR(StagedFolder(folder.path() / "file"), "file: is a file");
  EXPECT_ERROR(StagedFolder(folder.path() / "file/below"), "cannot make the folder");
}

TEST(GrowingFile, HoldsWhatWasAppended) {
  const test::TemporaryFolder folder;
  GrowingFile file(folder.path() / "log.txt");
  std::string whole;
  for (int i = 0; i < 5000; ++i) {
    file.append(std::to_string(i) + "\n");
    whole += std::to_string(i) + "\n";
  }
  file.close();
  EXPECT_EQ(read_file(folder.path() / "log.txt"), whole);
}

TEST(GrowingFile, NoticesAFullDisk) {
  EXPECT_ERROR(GrowingFile("/nowhere/log.txt"), "/nowhere/log.txt: cannot write");
  GrowingFile file("/dev/full");
  file.append("waits in memory");
  EXPECT_ERROR(file.close(), "/dev/full: cannot write", "No space");
  GrowingFile another("/dev/full");
  EXPECT_ERROR(another.append(std::string(1 << 20, 'x')), "/dev/full: cannot write", "No space");
}

}  // namespace
}  // namespace waretwin

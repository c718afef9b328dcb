#include <gtest/gtest.h>

#include "core/add_line.h"
#include "core/own_name.h"

namespace waretwin {
namespace {

TEST(AddLine, AppendsLinesOfAnyLength) {
  std::string text = "first\n";
  add_line(text, "%d of %s", 3, "four");
  const std::string long_word(5000, 'x');
  add_line(text, "%s%%", long_word.c_str());
  add_line(text, "%s", "");
  EXPECT_EQ(text, "first\n3 of four\n" + long_word + "%\n\n");
}

TEST(OwnName, IsTheLastPartHoweverThePathWasWritten) {
  for (const char* path : {"data/drive", "data/drive/", "/data/drive/.", "drive/left/..", "./drive", "drive//"}) {
    EXPECT_EQ(own_name(path), "drive") << path;
  }
  EXPECT_EQ(own_name("a/drive.log.gz"), "drive.log.gz");
  const std::string here = std::filesystem::current_path().filename().string();
  for (const char* path : {".", "./", ""}) EXPECT_EQ(own_name(path), here) << path;
  EXPECT_EQ(own_name("/"), "");
}

}  // namespace
}  // namespace waretwin

// Calls the built program and catches what it says.
#pragma once

#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "core/files.h"
#include "tests/support/test_data.h"

namespace waretwin::test {

struct ProgramResult {
  int exit_code = -1;
  std::string out, err;
  long error_lines() const { return std::count(err.begin(), err.end(), '\n'); }
};

// `arguments` as a shell reads them. `prefix` comes before the program's name (limits).
inline ProgramResult waretwin(const std::string& arguments, const std::string& prefix = "") {
  const TemporaryFolder folder;
  const std::string out = (folder.path() / "out").string(), err = (folder.path() / "err").string();
  const int status = std::system((prefix + " '" WARETWIN_PROGRAM "' " + arguments + " >'" + out + "' 2>'" + err + "'").c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_file(out), read_file(err)};
}

// A path as one word of a shell's line.
inline std::string in_quotes(const std::filesystem::path& path) { return "'" + path.string() + "'"; }

inline std::string agiprobot() { return in_quotes(repository() / "scenes/agiprobot/scenario.yaml"); }

}  // namespace waretwin::test

// Bad input: exit code 2 and one line that begins with the program's name and holds `text`.
inline void expect_one_line(const waretwin::test::ProgramResult& result, const std::string& text) {
  EXPECT_EQ(result.exit_code, 2) << result.err;
  EXPECT_EQ(result.error_lines(), 1) << result.err;
  EXPECT_TRUE(result.err.starts_with("waretwin: ")) << result.err;
  EXPECT_NE(result.err.find(text), std::string::npos) << "expected '" << text << "' in: " << result.err;
}

#define EXPECT_ONE_LINE(result, text) \
  do {                                \
    SCOPED_TRACE(#result);            \
    expect_one_line(result, text);    \
  } while (false)

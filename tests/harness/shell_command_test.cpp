#include "harness/run/shell_command.h"

#include <gtest/gtest.h>

#include <csignal>

#include "core/error.h"
#include "core/files.h"
#include "tests/support/expect_error.h"
#include "tests/support/test_data.h"

namespace waretwin {
namespace {

class Shell : public ::testing::Test {
 protected:
  ShellResult run(const std::string& command, double timeout_s = 0.0, const std::function<void(double)>& waiting = {}) {
    return run_shell(command, folder_.path() / "out", folder_.path() / "err", timeout_s, waiting);
  }
  std::string text(const char* name) const { return read_file(folder_.path() / name); }
  test::TemporaryFolder folder_;
};

TEST_F(Shell, KeepsBothOutputsAndTheExitCode) {
  const ShellResult result = run("echo to out; echo to err >&2; cat; exit 3");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_FALSE(result.timed_out);
  EXPECT_EQ(text("out"), "to out\n") << "and its input is empty";
  EXPECT_EQ(text("err"), "to err\n");
  EXPECT_EQ(run("no_such_program_anywhere").exit_code, 127);
  EXPECT_EQ(run("kill -9 $$").exit_code, 128 + 9);
  EXPECT_ERROR(run_shell("true", folder_.path() / "none/out", folder_.path() / "err", 0.0), "none/out", "cannot be written");
}

// Its children end with it, too: one that writes on would be seen.
TEST_F(Shell, EndsWhatTakesTooLongWithAllItsChildren) {
  const ShellResult result = run("(sleep 1; echo late >&2) & sleep 20", 0.1);
  EXPECT_TRUE(result.timed_out);
  EXPECT_EQ(result.exit_code, 128 + 15);
  EXPECT_LT(result.wall_s, 10.0);
  EXPECT_EQ(run("sleep 1.2").exit_code, 0);
  EXPECT_EQ(text("err"), "");
}

// The command's own memory, not that of the program that started it.
TEST_F(Shell, MeasuresTimeAndMemoryOfTheCommand) {
  const std::vector<char> ours(200 << 20, 'x');
  const ShellResult small = run("sleep 0.2");
  EXPECT_GE(small.wall_s, 0.2);
  EXPECT_GT(small.peak_rss_mb, 0.1);
  EXPECT_LT(small.peak_rss_mb, 50.0) << ours.size();
  EXPECT_GT(run("x=$(head -c 60000000 /dev/zero | tr '\\0' a); sleep 0.3").peak_rss_mb, 55.0);
}

TEST_F(Shell, EndsThoughTheSignalOfItsEndIsIgnored) {
  const auto before = std::signal(SIGCHLD, SIG_IGN);
  EXPECT_EQ(run("exit 4").exit_code, 4);
  EXPECT_EQ(std::signal(SIGCHLD, before), SIG_IGN) << "left as it was";
}

TEST_F(Shell, PlaceholdersBecomeWordsInOrOutOfQuotes) {
  const std::map<std::string, std::string> words = {{"{in}", "it's \"a\" $path"}, {"{out}", "b"}};
  EXPECT_EQ(run(with_words("printf '%s|' {in} \"{in}/x\" '{in}' --o={out} \\\"{out}", words)).exit_code, 0);
  EXPECT_EQ(text("out"), "it's \"a\" $path|it's \"a\" $path/x|it's \"a\" $path|--o=b|\"b|");
}

TEST_F(Shell, EndsItWhenTheCallerGivesUp) {
  EXPECT_ERROR(run("sleep 20", 0.0,
                   [](double seconds) {
                     if (seconds > 0.05) throw Error("stopped");
                   }),
               "stopped");
}

// The shell of a pipeline dies of the signal at once; the mapper in it has its time all the same.
TEST_F(Shell, WhatOutlivesTheShellMaySaveItsWork) {
  const std::string ready = shell_word((folder_.path() / "ready").string()), saved = shell_word((folder_.path() / "saved").string());
  const std::string mapper =
      "(trap 'sleep 0.3; echo all >" + saved + "; exit' TERM; echo >" + ready + "; while :; do sleep 0.02; done) | cat";
  const auto stop = [&](double) {
    if (std::filesystem::exists(folder_.path() / "ready")) throw Error("stopped");
  };
  EXPECT_ERROR(run(mapper, 0.0, stop), "stopped");
  EXPECT_EQ(text("saved"), "all\n");
}

TEST_F(Shell, WordsComeThroughWhole) {
  const std::string word = "it's \"a\" $path; `x` \\ * end";
  EXPECT_EQ(run("printf %s " + shell_word(word)).exit_code, 0);
  EXPECT_EQ(text("out"), word);
}

}  // namespace
}  // namespace waretwin

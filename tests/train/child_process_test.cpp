// `waretwin train` as a user calls it: another program does the work, and nobody notices.
#include <gtest/gtest.h>

#include "tests/end_to_end/program.h"
#include "tests/train/rectangles_set.h"

namespace waretwin {
namespace {

namespace fs = std::filesystem;

const std::string kSmall =
    " --set train.width=160 --set train.height=96 --set train.epoch_pictures=24 --set train.anchors=2 --threads 1 --epochs ";

class TrainCommand : public ::testing::Test {
 protected:
  TrainCommand() : set_(folder_.path() / "set of pictures"), out_(folder_.path() / "out") { test::write_rectangles(set_, 24, 8); }

  std::string to_out() const { return " --out " + test::in_quotes(out_); }

  test::TemporaryFolder folder_;
  fs::path set_, out_;
};

TEST_F(TrainCommand, LeavesADetector) {
  const test::ProgramResult result = test::waretwin("train " + test::in_quotes(set_) + to_out() + " --name shapes --seed 3" + kSmall + "1");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("AP50"), std::string::npos);
  EXPECT_NE(result.err.find("images/s"), std::string::npos) << result.err;
  for (const char* name : {"shapes.cfg", "shapes.weights", "shapes.names", "train.yaml", "log.csv", "checkpoint"}) {
    EXPECT_TRUE(fs::exists(out_ / name)) << name;
  }
  EXPECT_NE(read_file(out_ / "train.yaml").find("seed: 3"), std::string::npos);
  const std::string again = "train " + test::in_quotes(set_) + to_out() + " --quiet" + kSmall + "1";
  EXPECT_ONE_LINE(test::waretwin(again), "holds the model 'shapes'");  // a detector is named by its folder
  const test::ProgramResult quiet = test::waretwin(again + " --name shapes");
  EXPECT_EQ(quiet.exit_code, 0);
  EXPECT_EQ(quiet.err, "");
}

TEST_F(TrainCommand, BadInputIsOneLineAndExitCodeTwo) {
  EXPECT_ONE_LINE(test::waretwin("train /nowhere" + to_out()), "/nowhere");
  EXPECT_ONE_LINE(test::waretwin("train " + test::in_quotes(set_)), "--out");
  EXPECT_ONE_LINE(test::waretwin("train " + test::in_quotes(set_) + to_out() + " --minutes 0"), "--minutes");
  EXPECT_ONE_LINE(test::waretwin("train " + test::in_quotes(set_) + to_out() + " --set train.bacth=4"), "train.batch");
  EXPECT_ONE_LINE(test::waretwin("train " + test::in_quotes(set_) + to_out() + " --set train.width=100"), "multiple of 32");
  write_file(set_ / "train.txt", "");
  EXPECT_ONE_LINE(test::waretwin("train " + test::in_quotes(set_) + to_out()), "no pictures");
}

TEST_F(TrainCommand, APoliteKillReachesTheTrainingAndItGoesOn) {
  const std::string training = "train " + test::in_quotes(set_) + to_out() + " --resume" + kSmall;
  // Once the first epoch is saved, however long that takes here.
  const std::string until_saved =
      "sh -c 'saved=$1; shift; \"$@\" & p=$!; while [ ! -e \"$saved\" ] && kill -0 $p; do sleep 0.1; done; "
      "kill -TERM $p; wait $p' sh " +
      test::in_quotes(out_ / "checkpoint");
  const test::ProgramResult killed = test::waretwin(training + "100000", until_saved);
  EXPECT_EQ(killed.exit_code, 2) << killed.err;
  EXPECT_NE(killed.err.find("stopped by signal 15; --resume goes on"), std::string::npos) << killed.err;
  EXPECT_FALSE(fs::exists(out_ / "detector.weights"));
  const test::ProgramResult resumed = test::waretwin(training + "1");
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_NE(resumed.err.find("goes on after epoch"), std::string::npos) << resumed.err;
  EXPECT_TRUE(fs::exists(out_ / "detector.weights"));
}

// The program alone in a folder, or with a stand-in for what it starts.
class BesideItself : public ::testing::Test {
 protected:
  BesideItself() { fs::copy_file(WARETWIN_PROGRAM, folder_.path() / "waretwin"); }

  test::ProgramResult with(const std::string& script) const {
    const fs::path other = folder_.path() / "waretwin-train";
    write_file(other, "#!/bin/sh\n" + script + "\n");
    fs::permissions(other, fs::perms::owner_all);
    return call();
  }
  test::ProgramResult call() const {
    const fs::path out = folder_.path() / "out", err = folder_.path() / "err";
    const int status =
        std::system((test::in_quotes(folder_.path() / "waretwin") + " train 'a set' --out 'b c' --minutes 2.5 --set train.batch=4 >" +
                     test::in_quotes(out) + " 2>" + test::in_quotes(err))
                        .c_str());
    return {WEXITSTATUS(status), read_file(out), read_file(err)};
  }

  test::TemporaryFolder folder_;
};

TEST_F(BesideItself, WithoutTheOtherItNamesThePackage) { EXPECT_ONE_LINE(call(), "libtorch-dev"); }

TEST_F(BesideItself, WordsAndExitCodesArePassedOn) {
  const test::ProgramResult result = with("printf '<%s>' \"$@\"; exit 1");
  EXPECT_EQ(result.out, "<--out><b c><--name><detector><--minutes><2.5><--set><train.batch=4><--><a set>");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(with("exit 0").exit_code, 0);
  EXPECT_EQ(with("exit 2").exit_code, 2);
}

TEST_F(BesideItself, ACrashIsAFault) {
  const test::ProgramResult result = with("kill -SEGV $$");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_NE(result.err.find("signal 11"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace waretwin

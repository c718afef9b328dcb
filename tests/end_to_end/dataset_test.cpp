// waretwin dataset as a user runs it: killed and gone on with, in shards, with mistakes on the command line.
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/end_to_end/program.h"

namespace waretwin {
namespace {

using test::in_quotes;
using test::TemporaryFolder;
namespace fs = std::filesystem;

const std::string kSmall =
    "dataset --generate flat --count 12 --quiet --set dataset.images_per_hall=3 --set sensors.cameras.camera.width=160 "
    "--set sensors.cameras.camera.height=96 ";

TEST(Dataset, KilledAndShardedSetsAreThoseOfOneRun) {
  const TemporaryFolder folder;
  const fs::path whole = folder.path() / "whole", parts = folder.path() / "parts", killed = folder.path() / "killed";
  const auto result = test::waretwin(kSmall + "--out " + in_quotes(whole));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("12 pictures"), std::string::npos) << result.out;
  EXPECT_TRUE(fs::exists(whole / "contact_sheet.png"));

  for (const char* shard : {"1/2", "0/2"}) {
    const auto part = test::waretwin(kSmall + "--shard " + shard + " --out " + in_quotes(parts));
    ASSERT_EQ(part.exit_code, 0) << part.err;
  }
  EXPECT_EQ(read_file(parts / "SHA256SUMS"), read_file(whole / "SHA256SUMS"));

  // As soon as the first hall is done, without a chance to tidy up.
  const std::string script = "'" WARETWIN_PROGRAM "' " + kSmall + "--out " + in_quotes(killed) + " >/dev/null 2>&1 & pid=$!; " +
                             "for i in $(seq 600); do test -e " + in_quotes(killed / "halls" / "000000.json") +
                             " && break; sleep 0.05; done; kill -9 $pid; wait $pid; true";
  ASSERT_EQ(std::system(script.c_str()), 0);
  const auto again = test::waretwin(kSmall + "--out " + in_quotes(killed));
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(read_file(killed / "SHA256SUMS"), read_file(whole / "SHA256SUMS"));
  const std::string check = "cd " + in_quotes(killed) + " && sha256sum --check --quiet --strict SHA256SUMS";
  EXPECT_EQ(std::system(check.c_str()), 0);
}

TEST(Dataset, OneFormatLeavesOutTheOther) {
  const TemporaryFolder folder;
  const auto result = test::waretwin(kSmall + "--format coco --out " + in_quotes(folder.path() / "set"));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(fs::exists(folder.path() / "set" / "annotations" / "instances_train.json"));
  EXPECT_FALSE(fs::exists(folder.path() / "set" / "labels"));
  EXPECT_FALSE(fs::exists(folder.path() / "set" / "dataset.data"));
}

TEST(Dataset, MistakesEndInOneLine) {
  const TemporaryFolder folder;
  const std::string out = " --out " + in_quotes(folder.path() / "set");
  const auto expect = [&](const std::string& options, const std::string& part) {
    const auto result = test::waretwin("dataset " + options + out);
    EXPECT_EQ(result.exit_code, 2) << options;
    EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_FALSE(fs::exists(folder.path() / "set")) << "nothing is left behind";
  };
  expect("", "--generate STYLE");
  expect("--generate flat --shard 2/2", "expected I/N");
  expect("--generate flat --shard x", "expected I/N");
  expect("--generate castle", "castle");
  expect("--generate flat --count 0", "--count");
  expect("--generate flat --format png", "png");
  expect("--generate flat --set dataset.labels.min_visible=2", "min_visible");
  expect("--generate flat --set dataset.light.colour=1", "dataset.light.colour");
  expect("--generate flat --set dataset.classes=[teapot]", "teapot");
  expect("--generate flat --set dataset.camera.name=left", "left");
  expect("nowhere.yaml", "nowhere.yaml");
}

}  // namespace
}  // namespace waretwin

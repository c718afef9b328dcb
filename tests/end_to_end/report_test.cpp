// The pages that the program writes, and the drive as a video.
#include <gtest/gtest.h>

#include <filesystem>
#ifdef WARETWIN_VIDEO
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>
#endif

#include "tests/end_to_end/program.h"

namespace waretwin {
namespace {

namespace fs = std::filesystem;
using test::in_quotes;
using test::TemporaryFolder;

// Three mapped frames without colour: quick.
test::ProgramResult short_run(const fs::path& out, const std::string& more = "") {
  return test::waretwin("run " + test::agiprobot() + " --out " + in_quotes(out) +
                        " --quiet --profile paper --detector truth --rate 2 --frames 24 --set simulation.colour=false " + more);
}

TEST(Report, IsTheSameWhenItIsMadeAgainFromTheFolder) {
  const TemporaryFolder folder;
  const fs::path out = folder.path() / "out";
  ASSERT_EQ(short_run(out).exit_code, 0);
  const std::string first = read_file(out / "report.html");
  fs::remove(out / "report.html");
  const auto again = test::waretwin("report " + in_quotes(out));
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_NE(again.out.find("report.html"), std::string::npos);
  EXPECT_TRUE(read_file(out / "report.html") == first);
  EXPECT_TRUE(fs::exists(out / "frames.jsonl"));
  EXPECT_FALSE(fs::exists(out / "frames/small/frame-0000.colour.jpg")) << "a black picture says nothing";
  EXPECT_TRUE(fs::exists(out / "frames/small/frame-0000.depth.jpg"));

  const auto plain = test::waretwin("report " + in_quotes(out), "WARETWIN_VIEWER=none");
  ASSERT_EQ(plain.exit_code, 0) << plain.err;
  EXPECT_NE(plain.out.find("plain page"), std::string::npos);
  EXPECT_NE(read_file(out / "report.html").find("built without Node"), std::string::npos);
  EXPECT_EQ(read_file(out / "report.html").find("<script"), std::string::npos);
}

TEST(Report, CostsNoDriveItsScore) {
  const TemporaryFolder folder;
  const fs::path out = folder.path() / "out";
  make_folder(out);
  write_file(out / "upright.json", "{}");  // of an earlier map of a recording whose y pointed down
  const auto result = test::waretwin(
      "run " + test::agiprobot() + " --out " + in_quotes(out) + " --quiet --detector none --frames 2 --set simulation.colour=false",
      "WARETWIN_VIEWER=/no/such/page");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("complete but for its report.html"), std::string::npos) << result.err;
  EXPECT_TRUE(fs::exists(out / "score.json"));
  EXPECT_FALSE(fs::exists(out / "upright.json"));
  EXPECT_EQ(test::waretwin("report " + in_quotes(out)).exit_code, 0);
}

TEST(Report, RefusesWhatItCannotShow) {
  const TemporaryFolder folder;
  const auto report = [&](const std::string& more) { return test::waretwin("report " + in_quotes(folder.path()) + more); };
  EXPECT_ONE_LINE(test::waretwin("report " + in_quotes(folder.path() / "none")), "does not exist");
  EXPECT_ONE_LINE(report(""), "expected score.json");
  EXPECT_ONE_LINE(report(" --set a=b"), "no configuration keys");
  EXPECT_ONE_LINE(report(" --seed 3"), "--seed 3");
  EXPECT_ONE_LINE(test::waretwin("report"), "DIR");
  write_file(folder.path() / "results.json", "{}");
  EXPECT_ONE_LINE(report(""), "schema");
  EXPECT_ONE_LINE(report(" --video drive.mp4"), "of no drive");
  write_file(folder.path() / "dataset.yaml", "");
  fs::remove(folder.path() / "results.json");
  EXPECT_ONE_LINE(report(""), "manifest.json");
  EXPECT_NE(test::waretwin("report --help").out.find("Example:"), std::string::npos);
}

#ifdef WARETWIN_VIDEO
TEST(Report, WritesTheDriveAsAVideo) {
  const TemporaryFolder folder;
  const fs::path out = folder.path() / "out", file = folder.path() / "drive.mp4";
  ASSERT_EQ(short_run(out).exit_code, 0);
  const std::string lines = read_file(out / "frames.jsonl");
  const auto frames = std::count(lines.begin(), lines.end(), '\n');
  ASSERT_GE(frames, 3);
  const auto made = test::waretwin("report " + in_quotes(out) + " --quiet --video " + in_quotes(file));
  ASSERT_EQ(made.exit_code, 0) << made.err;
  cv::VideoCapture video(file.string());
  ASSERT_TRUE(video.isOpened());
  int count = 0;
  cv::Mat image, last;
  while (video.read(image)) {
    ++count;
    EXPECT_EQ(image.size(), cv::Size(1280, 540));
    image.copyTo(last);
  }
  EXPECT_EQ(count, frames + 15) << "the last picture stays for two seconds";
  // Something is drawn in both halves.
  for (const cv::Rect& half : {cv::Rect(0, 0, 640, 360), cv::Rect(640, 0, 640, 540)}) {
    cv::Scalar mean, deviation;
    cv::meanStdDev(last(half), mean, deviation);
    EXPECT_GT(deviation[0] + deviation[1] + deviation[2], 20.0);
  }
  EXPECT_ONE_LINE(test::waretwin("report " + in_quotes(out) + " --quiet --video " + in_quotes(folder.path() / "drive.avi")), ".mp4");
  EXPECT_ONE_LINE(test::waretwin("report " + in_quotes(out) + " --quiet --video " + in_quotes(folder.path() / "no/such/drive.mp4")),
                  "drive");
  fs::remove(out / "frames.jsonl");
  EXPECT_ONE_LINE(test::waretwin("report " + in_quotes(out) + " --quiet --video " + in_quotes(file)), "kept no frames");
}
#endif

}  // namespace
}  // namespace waretwin

// waretwin report: the page of a run, a study or a dataset, and the drive as a video.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>
#include <memory>

#include "core/error.h"
#include "harness/program/common_options.h"
#include "harness/program/progress.h"
#include "harness/report/drive_video.h"
#include "harness/report/report_file.h"

namespace waretwin {

namespace {

struct ReportOptions {
  CommonOptions common;
  std::string folder, video;
};

int report(const ReportOptions& options) {
  options.common.apply();
  // Nothing here is drawn at random or configured: a setting that would be passed over is refused.
  if (options.common.seed) throw Error("--seed " + std::to_string(*options.common.seed) + ": nothing of a report is drawn at random");
  if (!options.common.set.empty()) throw Error("--set " + options.common.set.front() + ": a report has no configuration keys");
  const ReportKind kind = report_kind(options.folder);
  if (!options.video.empty()) {
    if (kind != ReportKind::kRun) throw Error("--video: " + options.folder + " is of no drive; expected the folder of a run or a map");
    Progress progress("video", options.common.quiet);
    const VideoSummary video = write_drive_video(options.folder, options.video, [&](double done) { progress.update(done, "drawn"); });
    std::printf("%d frames, %d x %d, %s, in ", video.frames, video.width, video.height, video.codec.c_str());
    std::cout << options.video << "\n";
  }
  const ReportSummary summary = write_report(options.folder);
  std::cout << (std::filesystem::path(options.folder) / "report.html").string();
  std::printf(" (%.1f MB)\n", static_cast<double>(summary.bytes) / 1e6);
  if (summary.plain) std::printf("the plain page: this waretwin was built without Node, which the 3D page needs (docs/report.md)\n");
  return 0;
}

}  // namespace

Command add_report_command(CLI::App& program) {
  auto options = std::make_shared<ReportOptions>();
  CLI::App* command = program.add_subcommand("report", "report.html of a run, a map, a study or a dataset; the drive as a video");
  command->add_option("DIR", options->folder, "folder that run, map, study or dataset left")->required();
  command->add_option("--video", options->video, "also the drive: pictures with boxes, the growing map beside them")->type_name("FILE.mp4");
  options->common.add_to(*command);
  command->footer(
      "Example:\n  waretwin report out/agiprobot\n  waretwin report out/agiprobot --video out/agiprobot/drive.mp4\n\n"
      "The page is one file that opens from disk in any browser; `?` on it lists its keys.");
  return {command, [options] { return report(*options); }};
}

}  // namespace waretwin

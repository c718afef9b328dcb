#include "sensors/recordings/stamped_files.h"

#include <string>

#include "core/error.h"
#include "sensors/recordings/text_formats.h"

namespace waretwin {

namespace fs = std::filesystem;

void refuse_one_stamp(const fs::path& file, std::size_t count, const std::string& what, Stamp stamp, const std::string& expected) {
  throw Error(file, "all " + std::to_string(count) + " " + what + " have the stamp " + stamp_text(stamp) +
                        "; expected the time at which each was taken" + (expected.empty() ? "" : ", " + expected));
}

std::vector<StampedFile> read_file_list(const fs::path& list) {
  std::vector<StampedFile> files;
  for (const TextLine& line : read_text_lines(list)) {
    if (line.words.size() != 2) {
      throw Error(list, line.line, "has " + std::to_string(line.words.size()) + " words; expected 'seconds file'");
    }
    const fs::path name = line.words[1];
    const fs::path plain = name.lexically_normal();
    if (name.is_absolute() || (!plain.empty() && *plain.begin() == "..")) {
      throw Error(list, line.line, "'" + line.words[1] + "' leaves the folder; expected a file inside it");
    }
    const fs::path file = list.parent_path() / name;
    if (!fs::exists(file)) throw Error(list, line.line, "'" + line.words[1] + "' does not exist");
    files.push_back({parse_text_stamp(list, line.line, line.words[0]), file});
  }
  expect_times(files, list, "files");
  sort_by_stamp(files);
  return files;
}

void remark_unpaired(RecordingContents& contents, std::size_t colours, std::size_t depths, double tolerance_s) {
  const auto say = [&](std::size_t count, const std::string& what, const std::string& partner) {
    if (count == contents.frames.size()) return;
    contents.remarks.push_back(std::to_string(count - contents.frames.size()) + " of " + std::to_string(count) + " " + what + " have no " +
                               partner + " within " + std::to_string(tolerance_s) + " s and are left out");
  };
  say(colours, "colour pictures", "depth image");
  say(depths, "depth images", "colour picture");
}

void remark_without_pose(RecordingContents& contents, std::size_t unknown, std::size_t in_gaps, const std::string& poses,
                         double max_gap_s) {
  if (unknown > 0) contents.remarks.push_back(std::to_string(unknown) + " frames have no pose in " + poses);
  if (in_gaps > 0) {
    contents.remarks.push_back(std::to_string(in_gaps) + " frames have no pose: they lie in gaps of " + poses + " of more than " +
                               std::to_string(max_gap_s) + " s (recording.max_pose_gap_s)");
  }
}

}  // namespace waretwin

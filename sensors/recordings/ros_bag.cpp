#include "sensors/recordings/ros_bag.h"

#include <vector>

#include "core/error.h"

namespace waretwin {

namespace fs = std::filesystem;

bool is_ros_bag(const fs::path& file) { return file.extension() == ".bag" && fs::is_regular_file(file); }

std::optional<fs::path> bag_in(const fs::path& folder) {
  std::vector<fs::path> bags;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (is_ros_bag(entry.path())) bags.push_back(entry.path());
  }
  if (bags.empty()) return std::nullopt;
  if (bags.size() > 1) {
    throw Error(folder, "holds " + std::to_string(bags.size()) + " bags, " + bags[0].filename().string() + " and " +
                            bags[1].filename().string() + " among them; expected one, or the name of a bag itself");
  }
  return bags.front();
}

#ifndef WARETWIN_ROSBAG

RecordingContents read_ros_bag(const fs::path& file, const RecordingConfig&) {
  throw Error(file, "is a ROS bag, and this build reads none; expected a build that found librosbag-storage-dev and libtf2-dev");
}

std::unique_ptr<RecordingWriter> make_bag_writer(const fs::path&, const StreamInfo&, const RosBagFormat&) {
  throw Error("format rosbag: this build writes no bags; expected a build that found librosbag-storage-dev and libtf2-dev");
}

#endif

}  // namespace waretwin

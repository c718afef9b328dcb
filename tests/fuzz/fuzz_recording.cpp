// Feeds arbitrary bytes to the text files of a SceneNN folder: it throws Error or gives frames in order with finite poses. The first byte
// says which file the rest is.
#include <cstdint>
#include <filesystem>
#include <opencv2/core.hpp>
#include <optional>
#include <variant>

#include "core/error.h"
#include "core/files.h"
#include "sensors/recordings/recorded_image.h"
#include "sensors/recordings/recording.h"
#include "tests/support/test_data.h"

namespace {

namespace fs = std::filesystem;

constexpr const char* kFiles[] = {"trajectory.log", "timestamp.txt", "stamps.txt",       "asus.ini",
                                  "laser.txt",      "odometry.txt",  "depth_native.txt", "recording.yaml"};

// Two frames of two by two pixels.
void make_pictures(const fs::path& folder) {
  fs::create_directories(folder / "image");
  fs::create_directories(folder / "depth");
  for (const char* number : {"00001", "00002"}) {
    waretwin::write_colour_image(folder / "image" / (std::string("image") + number + ".png"), cv::Mat(2, 2, CV_8UC3, cv::Scalar(1, 2, 3)));
    waretwin::write_depth_image(folder / "depth" / (std::string("depth") + number + ".png"), cv::Mat(2, 2, CV_32FC1, cv::Scalar(1.0)));
  }
}

void check(waretwin::Recording& recording) {
  using namespace waretwin;
  std::optional<Stamp> last;
  while (auto event = recording.next()) {
    WARETWIN_CHECK(!last || stamp_of(*event) >= *last, "events are in order");
    last = stamp_of(*event);
    if (auto* frame = std::get_if<RgbdFrame>(&*event)) {
      WARETWIN_CHECK(!frame->recorded_X_WC || frame->recorded_X_WC->matrix().allFinite(), "poses are finite");
      try {
        load_pictures(*frame);
      } catch (const Error&) {
      }
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  static const waretwin::test::TemporaryFolder folder;
  if (!fs::exists(folder.path() / "image")) make_pictures(folder.path());
  for (const char* name : kFiles) fs::remove(folder.path() / name);
  waretwin::write_file(folder.path() / kFiles[data[0] % std::size(kFiles)],
                       std::string_view(reinterpret_cast<const char*>(data) + 1, size - 1));
  try {
    check(*waretwin::open_recording(folder.path()));
  } catch (const waretwin::Error&) {
  }
  return 0;
}

// Feeds arbitrary bytes to the reader of boxes made elsewhere, by the first byte as one JSON file, as a frame's rows or as the classes'
// names: it throws Error or gives boxes that have a name, a size and a score, and masks that fill their picture.
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <opencv2/core.hpp>
#include <string>

#include "core/error.h"
#include "core/files.h"
#include "mapper/detect/boxes_file.h"
#include "tests/support/test_data.h"

namespace {

// Its runs fill its picture, and the picture has the pixels that they count.
void check_mask(const waretwin::MaskRuns& mask) {
  waretwin::expect_whole(mask);
  constexpr std::int64_t kDrawn = 1 << 20;  // pixels; larger pictures cost more time than they tell
  if (static_cast<std::int64_t>(mask.size.width) * mask.size.height > kDrawn) return;
  int pixels = 0;
  for (std::size_t i = 1; i < mask.runs.size(); i += 2) pixels += mask.runs[i];
  const cv::Mat picture = waretwin::mask_picture(mask);
  WARETWIN_CHECK(picture.size() == mask.size, "a mask has its picture's size");
  WARETWIN_CHECK(cv::countNonZero(picture) == pixels, "a mask's picture has the pixels of its runs");
}

void check(const waretwin::FrameBoxes& boxes) {
  for (const auto& [stamp, detections] : boxes) {
    for (const waretwin::Detection& detection : detections) {
      const cv::Rect2f& box = detection.box;
      WARETWIN_CHECK(!detection.class_name.empty(), "a box has a class");
      WARETWIN_CHECK(std::abs(box.x) <= 1e6f && std::abs(box.y) <= 1e6f, "a box is near a picture");
      WARETWIN_CHECK(box.width > 0.0f && box.width <= 1e6f && box.height > 0.0f && box.height <= 1e6f, "a box has a size");
      WARETWIN_CHECK(detection.score >= 0.0f && detection.score <= 1.0f, "a score is a share");
      if (!detection.mask.empty()) check_mask(detection.mask);
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  static const waretwin::test::TemporaryFolder folder;
  const std::filesystem::path json = folder.path() / "boxes.json", rows = folder.path() / "rows";
  waretwin::make_folder(rows);
  waretwin::write_file(rows / "classes.txt", "conveyor\nrack\n");
  waretwin::write_file(rows / "1654000000.5.txt", "0 10 20 30 40 0.5\n1 1 2 3 4\n");
  const int kind = data[0] % 3;
  waretwin::write_file(kind == 0 ? json : rows / (kind == 1 ? "1654000000.5.txt" : "classes.txt"),
                       std::string_view(reinterpret_cast<const char*>(data) + 1, size - 1));
  waretwin::DetectConfig config;
  config.rename = {"rack=shelf"};
  waretwin::FrameBoxes boxes;
  try {
    boxes = waretwin::read_boxes(kind == 0 ? json : rows, config);
  } catch (const waretwin::Error&) {
    return 0;
  }
  check(boxes);
  return 0;
}

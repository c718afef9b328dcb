// Feeds arbitrary bytes to the reader of labelled sets, as one of its files by the first byte: it throws Error or gives boxes in pictures.
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>

#include "core/error.h"
#include "core/files.h"
#include "harness/labelled/labelled_set.h"
#include "tests/support/test_data.h"

namespace {

constexpr std::array<const char*, 5> kFiles = {"labels/a.txt", "set.json", "set.data", "train.txt", "set.names"};

void check(const waretwin::LabelledSet& set) {
  WARETWIN_CHECK(!set.images.empty() && !set.classes.empty(), "a set has pictures and classes");
  for (const waretwin::LabelledImage& image : set.images) {
    for (const waretwin::LabelledBox& box : image.boxes) {
      WARETWIN_CHECK(box.class_index >= 0 && static_cast<std::size_t>(box.class_index) < set.classes.size(), "a box has a class");
      const cv::Rect2d& s = box.share;
      WARETWIN_CHECK(s.x >= 0.0 && s.y >= 0.0 && s.width > 0.0 && s.height > 0.0, "a box is in its picture");
      WARETWIN_CHECK(s.x + s.width <= 1.0 + 1e-9 && s.y + s.height <= 1.0 + 1e-9, "a box is in its picture");
      WARETWIN_CHECK(std::isfinite(box.area) && box.area >= 0.0, "an area is one");
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const waretwin::test::TemporaryFolder folder;
  const std::filesystem::path root = folder.path();
  if (size == 0) return 0;
  for (const char* name : {"images", "labels"}) waretwin::make_folder(root / name);
  waretwin::write_file(root / "images/a.jpg", "");
  waretwin::write_file(root / "labels/a.txt", "0 0.5 0.5 0.5 0.5\n");
  waretwin::write_file(root / "set.data", "names = set.names\ntrain = train.txt\n");
  waretwin::write_file(root / "train.txt", "images/a.jpg\n");
  waretwin::write_file(root / "set.names", "conveyor\n");
  const std::string name = kFiles[data[0] % kFiles.size()];
  waretwin::write_file(root / name, std::string_view(reinterpret_cast<const char*>(data) + 1, size - 1));
  try {
    check(waretwin::read_labelled_set(root / (name == "set.json" ? "set.json" : "set.data"), "all"));
  } catch (const waretwin::Error&) {
  }
  return 0;
}

#include "harness/score/truth_file.h"

#include "core/error.h"
#include "harness/score/scenenn_annotation.h"
#include "harness/score/upright.h"

namespace waretwin {

namespace fs = std::filesystem;

namespace {

constexpr const char* kList = "truth.json";

std::vector<fs::path> annotations_in(const fs::path& folder) {
  std::vector<fs::path> annotations;
  std::error_code ignored;
  for (fs::directory_iterator at(folder, ignored), end; !ignored && at != end; at.increment(ignored)) {
    if (at->path().extension() == ".xml") annotations.push_back(at->path());
  }
  return annotations;
}

}  // namespace

bool has_truth(const fs::path& folder) { return fs::exists(folder / kList) || !annotations_in(folder).empty(); }

fs::path truth_file(const fs::path& path) {
  if (!fs::is_directory(path) || fs::exists(path / kList)) return file_or_in_folder(path, kList);
  const std::vector<fs::path> annotations = annotations_in(path);
  if (annotations.size() == 1) return annotations.front();
  if (annotations.empty()) return file_or_in_folder(path, kList);
  throw Error(path, "holds " + std::to_string(annotations.size()) + " .xml files; expected truth.json or one annotation");
}

std::vector<ListedObject> read_truth(const fs::path& file, const fs::path& map_folder) {
  if (file.extension() != ".xml") return read_object_list(file);
  const bool turned = fs::exists(map_folder / "upright.json");
  return read_scenenn_annotation(file, upright_from_recording(map_folder), turned ? "upright" : "world");
}

}  // namespace waretwin

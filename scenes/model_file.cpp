#include "scenes/model_file.h"

#include <algorithm>

#include "scenes/gltf_uri.h"

namespace waretwin {

namespace fs = std::filesystem;

namespace {

std::string problem_with(const fs::path& file, const fs::path& folder) {
  const std::string quoted = "is '" + file.string() + "'; ";
  if (file.is_absolute()) return quoted + "expected a path relative to the scenario's folder";
  if (std::find(file.begin(), file.end(), "..") != file.end()) return quoted + "expected a file inside the scenario's folder";
  std::error_code ignored;
  if (!fs::exists(folder / file, ignored)) return quoted + "there is no such file in '" + folder.string() + "'";
  if (!lies_within(folder / file, folder)) return quoted + "that link leaves the scenario's folder";
  if (!fs::is_regular_file(folder / file, ignored)) return quoted + "expected a file";
  return "";
}

void check(Fields& f, const char* key, const fs::path& file, const fs::path& folder) {
  const std::string extension = file.extension().string();
  if (extension != ".glb" && extension != ".gltf") f.reject(key, "is '" + file.string() + "'; expected a .gltf or .glb file");
  const std::string problem = folder.empty() ? "" : problem_with(file, folder);
  if (!problem.empty()) f.reject(key, problem);
}

}  // namespace

void visit_model_file(Fields& f, fs::path& file, const fs::path& folder) {
  f("file", file, "glTF file (.gltf or .glb), relative to the scenario's folder", {.required = true});
  check(f, "file", file, folder);
}

void visit_optional_model(Fields& f, const char* key, fs::path& file, const fs::path& folder, const char* doc) {
  f(key, file, doc);
  if (!file.empty()) check(f, key, file, folder);
}

}  // namespace waretwin

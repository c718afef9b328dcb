#include "mapper/detect/model_files.h"

#include <algorithm>
#include <sstream>

#include "core/error.h"
#include "core/files.h"
#include "mapper/detect/shipped_models.h"

namespace waretwin {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> files_ending(const fs::path& folder, const std::string& extension) {
  std::vector<fs::path> found;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (entry->path().extension() == extension && entry->is_regular_file()) found.push_back(entry->path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

// The file of that ending with the same stem, else the only one in the folder.
fs::path beside(const fs::path& file, const std::string& extension, const std::string& what) {
  fs::path same = file;
  same.replace_extension(extension);
  if (fs::is_regular_file(same)) return same;
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  const std::vector<fs::path> found = files_ending(folder, extension);
  if (found.size() == 1) return found.front();
  throw Error(file, "no " + what + " for this model; expected " + same.string() + " or a single *" + extension + " beside it, found " +
                        std::to_string(found.size()));
}

fs::path model_in(const fs::path& folder) {
  std::vector<fs::path> models = files_ending(folder, ".cfg");
  const std::vector<fs::path> onnx = files_ending(folder, ".onnx");
  models.insert(models.end(), onnx.begin(), onnx.end());
  if (models.size() != 1) {
    throw Error(folder, std::to_string(models.size()) + " models in this folder; expected exactly one .cfg (with .weights) or .onnx");
  }
  return models.front();
}

}  // namespace

ModelFiles find_model_files(const fs::path& named, const fs::path& names) {
  // What is there goes before what is shipped.
  const fs::path model = fs::exists(named) || !may_be_shipped_model(named) ? named : shipped_model(named.string());
  if (!fs::exists(model)) throw Error(model, "no such model; expected a folder, a .cfg or .weights file, or an .onnx file");
  const fs::path file = fs::is_directory(model) ? model_in(model) : model;
  ModelFiles files;
  if (file.extension() == ".onnx") {
    files.onnx = file;
  } else if (file.extension() == ".cfg") {
    files.cfg = file;
    files.weights = beside(file, ".weights", "weights");
  } else if (file.extension() == ".weights") {
    files.weights = file;
    files.cfg = beside(file, ".cfg", "network description");
  } else {
    throw Error(file, "not a model; expected a file ending in .cfg, .weights or .onnx");
  }
  files.names = names.empty() ? beside(file, ".names", "class names") : names;
  return files;
}

std::vector<std::string> read_class_names(const fs::path& file) {
  std::istringstream text(read_file(file, 1 << 20));
  std::vector<std::string> names;
  for (std::string line; std::getline(text, line);) {
    const auto last = line.find_last_not_of(" \t\r");
    names.push_back(last == std::string::npos ? "" : line.substr(0, last + 1));
  }
  while (!names.empty() && names.back().empty()) names.pop_back();
  if (names.empty()) throw Error(file, "no class names; expected one a line");
  const auto blank = std::find(names.begin(), names.end(), "");
  if (blank != names.end()) throw Error(file, static_cast<int>(blank - names.begin()) + 1, "blank line; expected a class name");
  return names;
}

}  // namespace waretwin

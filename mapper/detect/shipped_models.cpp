#include "mapper/detect/shipped_models.h"

#include <algorithm>
#include <cstdlib>
#include <system_error>

#include "core/error.h"

namespace waretwin {

namespace fs = std::filesystem;

fs::path shipped_models_folder() {
  std::error_code error;
  const char* named = std::getenv("WARETWIN_MODELS");
  if (named != nullptr && *named != '\0') {
    if (!fs::is_directory(named, error)) throw Error("WARETWIN_MODELS is " + std::string(named) + "; expected a folder of models");
    return named;
  }
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error) {
    fs::path installed = program.parent_path().parent_path() / "share/waretwin/models";
    if (fs::is_directory(installed, error)) return installed;
  }
  return WARETWIN_SOURCE_MODELS;
}

std::vector<std::string> shipped_model_names() {
  const auto is_model = [](const fs::path& file) { return file.extension() == ".cfg" || file.extension() == ".onnx"; };
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator folder(shipped_models_folder(), error), end; !error && folder != end; folder.increment(error)) {
    std::error_code no_folder;
    fs::directory_iterator file(folder->path(), no_folder);
    if (!no_folder && std::any_of(begin(file), fs::directory_iterator(), [&](const auto& entry) { return is_model(entry.path()); })) {
      names.push_back(folder->path().filename().string());
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

bool may_be_shipped_model(const fs::path& model) {
  const fs::path ending = model.extension();
  return !model.empty() && model == model.filename() && model != "." && model != ".." && ending != ".cfg" && ending != ".weights" &&
         ending != ".onnx";
}

bool is_shipped_model(const fs::path& model) {
  const std::vector<std::string> names = shipped_model_names();
  return may_be_shipped_model(model) && std::find(names.begin(), names.end(), model.string()) != names.end();
}

fs::path shipped_model(const std::string& name) {
  const std::vector<std::string> names = shipped_model_names();
  if (std::find(names.begin(), names.end(), name) != names.end()) return shipped_models_folder() / name;
  std::string known;
  for (const std::string& other : names) known += (known.empty() ? "" : ", ") + other;
  throw Error("model '" + name + "': no such file and no shipped model; expected a folder, a .cfg, .weights or .onnx file, or one of " +
              (known.empty() ? "the shipped ones (there are none in " + shipped_models_folder().string() + ")" : known));
}

fs::path model_or_shipped(const std::string& model) { return model.empty() ? shipped_model(kUsualModel) : fs::path(model); }

}  // namespace waretwin

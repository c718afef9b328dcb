// Which files a MODEL argument means.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace waretwin {

struct ModelFiles {
  std::filesystem::path cfg, weights;  // Darknet, or
  std::filesystem::path onnx;          // ONNX; exactly one of the two is set
  std::filesystem::path names;         // class names, one a line
  bool darknet() const { return onnx.empty(); }
};

// `model` is a folder that holds one model, a .cfg or .weights file (the other stands beside it under the same stem, or is the only one),
// an .onnx file, or the name of a shipped model (shipped_models.h). Class names: `names` if given, else the .names file of the model's
// stem, else the only .names file beside it. Throws Error naming what is missing or ambiguous.
ModelFiles find_model_files(const std::filesystem::path& model, const std::filesystem::path& names);

// One name a line; blank lines at the end are left out. Throws Error for an empty file or a blank line between names.
std::vector<std::string> read_class_names(const std::filesystem::path& file);

}  // namespace waretwin

// Models that come with the program and are called by name instead of by path.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace waretwin {

// Where they lie, a folder a model: the environment variable WARETWIN_MODELS, else share/waretwin/models beside the installed program, else
// mapper/detect/models of the source tree. Throws Error where WARETWIN_MODELS names no folder.
std::filesystem::path shipped_models_folder();

// Names of those that are there, sorted.
std::vector<std::string> shipped_model_names();

// Whether a MODEL argument may be such a name: a word without a folder that does not end like a model's file.
bool may_be_shipped_model(const std::filesystem::path& model);

// Whether it is one that is there.
bool is_shipped_model(const std::filesystem::path& model);

// The model's folder. Throws Error listing the known ones.
std::filesystem::path shipped_model(const std::string& name);

// Which one it is where none is named.
inline constexpr const char* kUsualModel = "conveyor";
// `model` as it is or, if empty, the usual one's folder, whatever lies in the present folder. Throws Error where it is not there.
std::filesystem::path model_or_shipped(const std::string& model);

}  // namespace waretwin

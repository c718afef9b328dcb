// Names of models in a scenario.
#pragma once

#include <filesystem>
#include <string>

#include "core/fields.h"

namespace waretwin {

// Reads the key `file`, the name of a glTF file relative to the scenario's folder, and rejects what is none. With a `folder` the file must
// exist and stay inside it, so that the folder can be copied as it is; an empty folder checks the name alone.
void visit_model_file(Fields& f, std::filesystem::path& file, const std::filesystem::path& folder);
// The same for a key of another name that need not be there; empty means no model.
void visit_optional_model(Fields& f, const char* key, std::filesystem::path& file, const std::filesystem::path& folder, const char* doc);

}  // namespace waretwin

// What a page shows, before it is a page: one JSON text and the binaries that it names.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>

namespace waretwin {

// `json` has `schema`, `version`, `kind` (run, map, laser, study, dataset), `title`, `subtitle`, `facts` (lines) and `files` (names in the
// folder, for links); the rest is its kind's: run_page.h, study_page.h, dataset_page.h. It names binaries by their names in `blocks`.
// clang-tidy sees throws in the moves of nlohmann::json, which promise none.
struct PageData {  // NOLINT(bugprone-exception-escape)
  nlohmann::ordered_json json;
  std::map<std::string, std::string> blocks;  // name -> bytes: JPEG, or a mesh's numbers (page_mesh.h)
};

inline constexpr const char* kPageSchema = "waretwin-page-1";

}  // namespace waretwin

// The page of a study's folder: which mounting of the sensors maps best.
#pragma once

#include <filesystem>

#include "harness/report/page_data.h"

namespace waretwin {

// Reads DIR/results.json (schema waretwin-study-1), the coverage maps that its candidates name and DIR/preview/NAME.png (or that beside
// DIR, where coverage alone was measured). Throws Error naming the file and the key where that is not as it should be. A picture that is
// gone is left out.
//
// json beside the keys of PageData: study (results.json; each candidate with `coverage`: [{caption, block}] and `preview`: a block or
// null), pictures (plots, for the plain page).
PageData study_page(const std::filesystem::path& folder);

}  // namespace waretwin

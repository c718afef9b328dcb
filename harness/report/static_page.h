// A page without scripts, for builds without Node: tables and pictures, no 3D.
#pragma once

#include <filesystem>
#include <string>

#include "harness/report/page_data.h"

namespace waretwin {

// Self-contained HTML that says why it is the plain one. Of a run it also shows two of the pictures in frames/ of `folder`.
std::string static_page(const PageData& data, const std::filesystem::path& folder);

}  // namespace waretwin

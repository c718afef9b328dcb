// The page that viewer/ builds, into which data go.
#pragma once

#include <optional>
#include <string>

#include "harness/report/page_data.h"

namespace waretwin {

// The built page: share/waretwin/viewer/report.html beside the installed program, else the one of the build folder; WARETWIN_VIEWER names
// another file, or `none`. Nothing where the build had no Node. Throws Error where WARETWIN_VIEWER names no page.
std::optional<std::string> page_template();

// The template with the data at its mark. Throws Error where it has none.
std::string filled_page(const std::string& page, const PageData& data);

// JSON text that may stand inside a script element: nothing in it ends the element or opens a comment.
std::string script_safe(const std::string& json);

}  // namespace waretwin

#include "harness/report/page_template.h"

#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "core/error.h"
#include "core/files.h"
#include "harness/report/base64.h"

namespace waretwin {

namespace fs = std::filesystem;

namespace {

constexpr const char* kMark = "<!--waretwin-data-->";

}  // namespace

std::optional<std::string> page_template() {
  std::error_code error;
  const char* named = std::getenv("WARETWIN_VIEWER");
  if (named != nullptr && *named != '\0') {
    if (std::string(named) == "none") return std::nullopt;
    if (!fs::is_regular_file(named, error)) throw Error("WARETWIN_VIEWER is " + std::string(named) + "; expected a built page or none");
    return read_file(named);
  }
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error) {
    const fs::path installed = program.parent_path().parent_path() / "share/waretwin/viewer/report.html";
    if (fs::is_regular_file(installed, error)) return read_file(installed);
  }
  if (fs::is_regular_file(WARETWIN_BUILT_VIEWER, error)) return read_file(WARETWIN_BUILT_VIEWER);
  return std::nullopt;
}

std::string script_safe(const std::string& json) {
  // "<" stands in JSON only within strings, where its escape means the same.
  std::string safe;
  safe.reserve(json.size());
  for (const char c : json) {
    if (c == '<') {
      safe += "\\u003c";
    } else {
      safe += c;
    }
  }
  return safe;
}

std::string filled_page(const std::string& page, const PageData& data) {
  const std::size_t mark = page.find(kMark);
  if (mark == std::string::npos) throw Error(std::string("the viewer's page has no ") + kMark + "; build viewer/ again");
  std::string html = page.substr(0, mark);
  const auto type = nlohmann::json::error_handler_t::replace;  // names in a folder may be anything
  html += "<script type=\"application/json\" id=\"waretwin-data\">" + script_safe(data.json.dump(-1, ' ', false, type)) + "</script>\n";
  for (const auto& [name, bytes] : data.blocks) {
    html += "<script type=\"text/plain\" id=\"block:" + name + "\">" + base64(bytes) + "</script>\n";
  }
  html.append(page, mark + std::string(kMark).size());
  return html;
}

}  // namespace waretwin

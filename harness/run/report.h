// report.html: a run on one plain page, with its pictures inside.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/run/mapping.h"
#include "harness/score/run_score.h"

namespace waretwin {

struct ReportPicture {
  std::string caption;
  cv::Mat image;  // BGR
};

struct ReportPage {
  std::string title;
  std::string subtitle;
  const RunScore* score = nullptr;  // nothing for a map without truth
  std::vector<ListedObject> mapped;
  std::map<std::string, TimingSummary> timing_ms;
  std::vector<std::string> facts;  // lines under the title
  std::vector<ReportPicture> pictures;
  std::vector<std::string> files;  // linked at the end
};

// Self-contained HTML: no scripts, pictures as JPEG in the page.
std::string report_html(const ReportPage& page);

}  // namespace waretwin

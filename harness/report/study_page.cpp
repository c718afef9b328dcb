#include "harness/report/study_page.h"

#include <algorithm>
#include <array>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "core/files.h"
#include "core/json_text.h"
#include "core/version.h"
#include "harness/pictures/picture_file.h"
#include "harness/report/page_json.h"

namespace waretwin {

namespace fs = std::filesystem;

namespace {

constexpr const char* kStudySchema = "waretwin-study-1";
constexpr int kWidth = 520, kQuality = 85;
// Pictures beyond these would make the page too heavy; the best, the baseline and the Pareto front come first.
constexpr std::size_t kMaxPictures = 400;

bool is_plain(const fs::path& name) {
  return !name.empty() && name.is_relative() && std::none_of(name.begin(), name.end(), [](const fs::path& part) { return part == ".."; });
}

// Where a value of another type stands than the page can show, it says so here instead of going blank in a browser.
void expect_shape(const fs::path& file, const Json& study) {
  const auto expect = [&](bool good, const std::string& key, const char* what) {
    if (!good) throw Error(file, key + ": expected " + what);
  };
  const auto at = [](const Json& json, const char* key) { return json.contains(key) ? json.at(key) : Json(nullptr); };
  expect(study.is_object() && at(study, "schema") == kStudySchema, "schema", kStudySchema);
  const Json pareto = at(study, "pareto");
  expect(pareto.is_null() || (pareto.is_object() && at(pareto, "measures").is_array()), "pareto", "measures and candidates");
  for (const char* key : {"factors", "measures", "candidates"}) {
    expect(at(study, key).is_array(), key, "a list");
    for (const Json& entry : study[key]) expect(entry.is_object() && at(entry, "name").is_string(), key, "entries with a name");
  }
  for (const Json& candidate : study["candidates"]) {
    const std::string name = candidate["name"];
    expect(at(candidate, "number").is_number_integer(), "candidates, " + name + ", number", "a whole number");
    const Json state = at(candidate, "state");
    expect(state == "run" || state == "screened_out" || state == "refused", "candidates, " + name + ", state",
           "run, screened_out or refused");
    expect(at(candidate, "values").is_object(), "candidates, " + name + ", values", "a value for each factor");
    if (state == "run") expect(at(candidate, "measures").is_object(), "candidates, " + name + ", measures", "a value for each measure");
    const Json runs = at(candidate, "runs");
    expect(runs.is_null() ||
               (runs.is_array() && std::all_of(runs.begin(), runs.end(), [&](const Json& run) { return at(run, "measures").is_object(); })),
           "candidates, " + name + ", runs", "drives with measures");
  }
}

class Pictures {
 public:
  Pictures(PageData& page, const fs::path& folder) : page_(page), folder_(folder) {}

  // The block's name; null where there is no such picture or no room for it.
  Json add(const fs::path& name) { return add(name, folder_); }
  Json add(const fs::path& name, const fs::path& folder) {
    std::error_code error;
    if (!is_plain(name) || page_.blocks.size() >= kMaxPictures || !fs::is_regular_file(folder / name, error)) return nullptr;
    cv::Mat image = cv::imread((folder / name).string(), cv::IMREAD_COLOR);
    if (image.empty()) throw Error(folder / name, "is no picture");
    if (image.cols > kWidth) {
      const double scale = static_cast<double>(kWidth) / image.cols;
      cv::resize(image, image, {}, scale, scale, cv::INTER_AREA);
    }
    const std::string block = "picture." + std::to_string(page_.blocks.size());
    page_.blocks[block] = encoded_jpeg(image, kQuality);
    return block;
  }

 private:
  PageData& page_;
  fs::path folder_;
};

}  // namespace

PageData study_page(const fs::path& folder) {
  const fs::path file = folder / "results.json";
  Json study = parse_json<Json>(file, read_file(file), "a study's results.json");
  expect_shape(file, study);
  PageData page;
  Json& json = page.json;
  json["schema"] = kPageSchema;
  json["version"] = kVersion;
  json["kind"] = "study";
  const auto text = [&](const char* key) { return study.contains(key) && study[key].is_string() ? study[key].get<std::string>() : ""; };
  json["title"] = "study " + text("name");
  json["subtitle"] = text("description");
  std::array<int, 3> states{};
  for (const Json& candidate : study["candidates"]) {
    ++states[candidate["state"] == "run" ? 0 : candidate["state"] == "screened_out" ? 1 : 2];
  }
  json["facts"] = {std::to_string(study["candidates"].size()) + " candidates: " + std::to_string(states[0]) + " run, " +
                   std::to_string(states[1]) + " screened out, " + std::to_string(states[2]) + " refused"};
  json["pictures"] = Json::array();
  json["files"] = Json::array();
  std::error_code error;
  for (const char* name : {"study.md", "results.csv", "runs.csv", "results.json", "timing.csv"}) {
    if (fs::is_regular_file(folder / name, error)) json["files"].push_back(name);
  }

  Pictures pictures(page, folder);
  // For the plain page; the viewer draws its own.
  std::vector<std::string> plots = {"pareto"};
  if (study.contains("best_by") && study["best_by"].is_string()) plots.push_back("effects-" + study["best_by"].get<std::string>());
  for (const std::string& plot : plots) {
    const Json block = pictures.add(fs::path("plots") / (plot + ".png"));
    if (!block.is_null()) json["pictures"].push_back({{"caption", plot}, {"block", block}});
  }
  // What coverage alone says lies beside the previews, in a folder of its own.
  const fs::path previews = fs::is_directory(folder / "preview", error) ? folder : folder.parent_path();
  std::vector<Json*> order;
  for (Json& candidate : study["candidates"]) order.push_back(&candidate);
  const auto rank = [&](const Json* candidate) {
    const Json& number = candidate->at("number");
    if (study.contains("best") && number == study["best"]) return 0;
    if (study.contains("baseline") && number == study["baseline"]) return 1;
    return candidate->contains("pareto") && candidate->at("pareto") == true ? 2 : 3;
  };
  std::stable_sort(order.begin(), order.end(), [&](const Json* a, const Json* b) { return rank(a) < rank(b); });
  for (Json* candidate : order) {
    (*candidate)["coverage"] = Json::array();
    (*candidate)["preview"] = pictures.add(fs::path("preview") / (candidate->at("name").get<std::string>() + ".png"), previews);
    if (!candidate->contains("coverage_maps") || !(*candidate)["coverage_maps"].is_array()) continue;
    for (const Json& name : (*candidate)["coverage_maps"]) {
      if (!name.is_string()) continue;
      const Json block = pictures.add(name.get<std::string>());
      if (!block.is_null())
        (*candidate)["coverage"].push_back({{"caption", fs::path(name.get<std::string>()).stem().string()}, {"block", block}});
    }
  }
  json["study"] = std::move(study);
  return page;
}

}  // namespace waretwin

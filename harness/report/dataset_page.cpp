#include "harness/report/dataset_page.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "core/files.h"
#include "core/version.h"
#include "harness/dataset/image_record.h"
#include "harness/pictures/picture_file.h"
#include "harness/report/page_json.h"

namespace waretwin {

namespace fs = std::filesystem;

namespace {

constexpr int kThumbnails = 300, kWidth = 480, kQuality = 80;
constexpr std::size_t kSideBins = 20, kVisibleBins = 10;

Json box_json(const cv::Rect& box) { return {box.x, box.y, box.width, box.height}; }

std::size_t bin(double share, std::size_t bins) {
  return static_cast<std::size_t>(std::clamp(share, 0.0, 0.999999) * static_cast<double>(bins));
}

struct ClassCounts {
  int labels = 0;
  std::array<int, kSideBins> sides{};
  std::array<int, kVisibleBins> visible{};
};

// `width`: of the picture, where it is known: large ones are then read at half their size, which takes a quarter of the time.
std::string thumbnail(const fs::path& file, int width = 0) {
  cv::Mat image = cv::imread(file.string(), width >= 2 * kWidth ? cv::IMREAD_REDUCED_COLOR_2 : cv::IMREAD_COLOR);
  if (image.empty()) throw Error(file, "is gone or no picture; delete the folder and make the set again");
  if (image.cols > kWidth) {
    const double scale = static_cast<double>(kWidth) / image.cols;
    cv::resize(image, image, {}, scale, scale, cv::INTER_AREA);
  }
  return encoded_jpeg(image, kQuality);
}

Json image_json(const ImageRecord& image, const HallRecord& hall, const std::string& block) {
  Json json = {{"index", image.index}, {"name", image.name},      {"split", hall.split},
               {"hall", hall.hall},    {"kind", image.kind},      {"size", {image.intrinsics.width, image.intrinsics.height}},
               {"block", block},       {"labels", Json::array()}, {"left_out", Json::array()}};
  for (const ImageLabel& label : image.labels.labels) {
    json["labels"].push_back({{"class", label.class_index},
                              {"box", box_json(label.box)},
                              {"amodal_box", box_json(label.amodal_box)},
                              {"visible", rounded(label.visible, 3)}});
  }
  for (const LeftOut& object : image.labels.left_out) {
    json["left_out"].push_back({{"class", object.class_index}, {"box", box_json(object.box)}, {"why", to_text(object.why)}});
  }
  return json;
}

Json read_manifest(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error)) throw Error(file, "is missing: the set is not finished; `waretwin dataset` goes on with it");
  try {
    Json manifest = Json::parse(read_file(file));
    for (const char* key : {"images", "halls", "without_labels"}) manifest.at(key).get<int>();
    for (const char* key : {"labels", "splits", "views", "left_out"}) {
      if (!manifest.at(key).is_object()) throw Error(file, std::string(key) + ": expected counts by name");
    }
    return manifest;
  } catch (const nlohmann::json::exception& problem) {
    throw Error(file, "is no manifest of a set (" + std::string(problem.what()) + ")");
  }
}

}  // namespace

PageData dataset_page(const fs::path& folder) {
  const Json manifest = read_manifest(folder / "manifest.json");
  const int images = manifest["images"], halls = manifest["halls"];
  const int shown = std::min(kThumbnails, images);
  std::vector<ClassCounts> counts(manifest["labels"].size());
  PageData page;
  Json& json = page.json;
  json["schema"] = kPageSchema;
  json["version"] = kVersion;
  json["kind"] = "dataset";
  json["title"] = "training pictures";
  json["images"] = Json::array();
  for (int number = 0; number < halls; ++number) {
    const HallRecord hall = read_hall_record(folder / record_name(number));
    for (const ImageRecord& image : hall.images) {
      const fs::path name = image.name;
      if (name.empty() || name != name.filename() || name == "." || name == "..")
        throw Error(folder / record_name(number), "names a picture '" + image.name + "'; expected a plain name");
      if (image.intrinsics.width < 1 || image.intrinsics.height < 1)
        throw Error(folder / record_name(number), image.name + " has no size; expected at least one pixel");
      const double area = static_cast<double>(image.intrinsics.width) * image.intrinsics.height;
      for (const ImageLabel& label : image.labels.labels) {
        const auto k = static_cast<std::size_t>(label.class_index);
        if (k >= counts.size()) throw Error(folder / record_name(number), "names class " + std::to_string(k) + ", manifest.json has fewer");
        ++counts[k].labels;
        ++counts[k].sides[bin(std::sqrt(std::max(0.0, static_cast<double>(label.box.width) * label.box.height) / area), kSideBins)];
        ++counts[k].visible[bin(label.visible, kVisibleBins)];
      }
      // Evenly over the whole set.
      if (static_cast<std::int64_t>(json["images"].size()) * images > static_cast<std::int64_t>(image.index) * shown) continue;
      if (static_cast<int>(json["images"].size()) >= shown) continue;
      const std::string block = "picture." + std::to_string(page.blocks.size());
      page.blocks[block] = thumbnail(folder / "images" / (image.name + ".jpg"), image.intrinsics.width);
      json["images"].push_back(image_json(image, hall, block));
    }
  }
  Json& dataset = json["dataset"];
  for (const char* key : {"images", "without_labels", "halls", "splits", "views", "left_out"}) dataset[key] = manifest[key];
  dataset["classes"] = Json::array();
  std::size_t k = 0;
  for (const auto& [name, labels] : manifest["labels"].items()) {
    dataset["classes"].push_back(
        {{"name", name}, {"labels", counts[k].labels}, {"sides", counts[k].sides}, {"visible", counts[k].visible}});
    ++k;
  }
  json["subtitle"] = std::to_string(images) + " pictures of " + std::to_string(halls) + " halls, " +
                     std::to_string(static_cast<int>(manifest["without_labels"])) + " without labels";
  json["facts"] = {std::to_string(page.blocks.size()) + " pictures are shown here, spread over the set"};
  page.blocks.emplace("sheet", thumbnail(folder / "contact_sheet.png"));
  json["pictures"] = {{{"caption", "Some pictures with their labels"}, {"block", "sheet"}}};
  json["files"] = Json::array();
  for (const char* name :
       {"dataset.yaml", "manifest.json", "SHA256SUMS", "contact_sheet.png", "dataset.data", "dataset.names", "train.txt", "valid.txt",
        "test.txt", "annotations/instances_train.json", "annotations/instances_valid.json", "annotations/instances_test.json"}) {
    std::error_code error;
    if (fs::is_regular_file(folder / name, error)) json["files"].push_back(name);
  }
  return page;
}

}  // namespace waretwin

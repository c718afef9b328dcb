#include "harness/dataset/dataset_index.h"

#include <nlohmann/json.hpp>
#include <optional>

#include "core/checksum.h"
#include "core/error.h"
#include "core/files.h"
#include "core/version.h"
#include "harness/dataset/coco_file.h"
#include "harness/dataset/contact_sheet.h"
#include "harness/pictures/picture_file.h"

namespace waretwin {

namespace fs = std::filesystem;

namespace {

constexpr int kThumbnails = 48;
const std::vector<std::string> kSplits = {"train", "valid", "test"};

// Lists and checksums grow in memory: about a kilobyte a picture.
void write_lists(const fs::path& folder, const std::map<std::string, std::string>& lists, const std::vector<std::string>& classes,
                 std::map<std::string, std::string>& sums) {
  const auto write = [&](const std::string& name, const std::string& text) {
    write_file(folder / name, text);
    sums[name] = sha256(text);
  };
  std::string data = "classes = " + std::to_string(classes.size()) + "\n";
  for (const std::string& split : kSplits) {
    const auto list = lists.find(split);
    write(split + ".txt", list == lists.end() ? "" : list->second);
    // Readers of a set would trip over a split without pictures.
    if (list != lists.end()) data += split + " = " + split + ".txt\n";
  }
  std::string names;
  for (const std::string& name : classes) names += name + "\n";
  write("dataset.names", names);
  write("dataset.data", data + "names = dataset.names\n");
}

}  // namespace

DatasetSummary write_index(const fs::path& folder, int halls, int images, const std::vector<std::string>& classes,
                           const DatasetFormats& formats, const std::string& configuration_sha256) {
  DatasetSummary summary;
  summary.classes = classes;
  summary.labels.assign(classes.size(), 0);
  std::map<std::string, int> images_of_kind;
  std::map<std::string, std::string> lists, sums;
  std::map<std::string, std::optional<CocoFile>> coco;
  if (formats.coco) make_folder(folder / "annotations");
  std::vector<ImageRecord> shown;
  const int thumbnails = std::min(kThumbnails, images);
  for (int number = 0; number < halls; ++number) {
    const HallRecord record = read_hall_record(folder / record_name(number));
    sums[record_name(number).generic_string()] = sha256(read_file(folder / record_name(number)));
    // Splits without pictures get no file: readers of a set would trip over it.
    std::optional<CocoFile>& annotations = coco[record.split];
    if (formats.coco && !annotations) {
      annotations.emplace(folder / "annotations" / ("instances_" + record.split + ".json"), classes,
                          "synthetic pictures by waretwin " + std::string(kVersion) + ", " + record.split);
    }
    for (const ImageRecord& image : record.images) {
      // Evenly over the whole set.
      if (static_cast<int>(shown.size()) * images <= image.index * thumbnails) shown.push_back(image);
      ++summary.images;
      ++summary.splits[record.split];
      ++images_of_kind[image.kind];
      summary.empty += image.labels.labels.empty();
      for (const ImageLabel& label : image.labels.labels) {
        const auto index = static_cast<std::size_t>(label.class_index);
        if (index >= classes.size()) {
          throw Error(folder / record_name(number), "class " + std::to_string(label.class_index) + " of " + std::to_string(classes.size()));
        }
        ++summary.labels[index];
      }
      for (const LeftOut& object : image.labels.left_out) ++(object.why == LeftOut::Why::kSmall ? summary.small : summary.hidden);
      sums.insert(image.files.begin(), image.files.end());
      lists[record.split] += "images/" + image.name + ".jpg\n";
      if (annotations) annotations->add(image, record.hall);
    }
  }
  if (formats.yolo) write_lists(folder, lists, classes, sums);
  for (auto& [split, file] : coco) {
    if (!file) continue;
    file->finish();
    const std::string name = "annotations/instances_" + split + ".json";
    sums[name] = sha256(read_file(folder / name));
  }
  write_png(folder / "contact_sheet.png", contact_sheet(folder, shown, classes));
  sums["contact_sheet.png"] = sha256(read_file(folder / "contact_sheet.png"));
  sums["dataset.yaml"] = configuration_sha256;

  nlohmann::ordered_json manifest;
  manifest["schema"] = 1;
  manifest["version"] = kVersion;
  manifest["images"] = summary.images;
  manifest["without_labels"] = summary.empty;
  manifest["halls"] = halls;
  manifest["splits"] = summary.splits;
  manifest["views"] = images_of_kind;
  manifest["labels"] = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < classes.size(); ++i) manifest["labels"][classes[i]] = summary.labels[i];
  manifest["left_out"] = {{"hidden", summary.hidden}, {"small", summary.small}};
  manifest["sha256"] = sums;
  const std::string text = manifest.dump(1) + "\n";
  write_file(folder / "manifest.json", text);
  sums["manifest.json"] = sha256(text);
  std::string lines;
  for (const auto& [name, sum] : sums) lines += sum + "  " + name + "\n";
  write_file(folder / "SHA256SUMS", lines);
  return summary;
}

}  // namespace waretwin

#include "harness/labelled/labelled_set.h"

#include <algorithm>
#include <map>
#include <optional>

#include "core/error.h"
#include "harness/labelled/coco_set.h"
#include "harness/labelled/text_sets.h"

namespace waretwin {

namespace {

namespace fs = std::filesystem;

// Which of the layouts a path is; exactly one member is set, or none.
struct Layout {
  std::optional<fs::path> data;          // Darknet's .data file
  std::map<std::string, fs::path> coco;  // by split
  std::optional<fs::path> coco_file;     // one JSON file, one piece
  std::optional<fs::path> names;         // loose pictures with this file of names
};

Layout layout_of(const fs::path& dataset) {
  Layout layout;
  if (fs::is_regular_file(dataset)) {
    if (dataset.extension() == ".data") layout.data = dataset;
    if (dataset.extension() == ".json") layout.coco_file = dataset;
    return layout;
  }
  if (!fs::is_directory(dataset)) return layout;
  const std::vector<fs::path> data = files_of(dataset, {".data"});
  if (data.size() > 1) {
    throw Error(dataset, "holds " + data[0].filename().string() + " and " + data[1].filename().string() + "; expected one .data file");
  }
  if (data.size() == 1) {
    layout.data = data.front();
    return layout;
  }
  layout.coco = coco_files(dataset);
  if (layout.coco.empty()) layout.names = loose_names(dataset);
  return layout;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::vector<std::string> splits_of(const Layout& layout) {
  if (layout.data) return darknet_splits(*layout.data);
  std::vector<std::string> splits;
  for (const char* split : {"train", "valid", "test"}) {
    if (layout.coco.count(split) != 0) splits.emplace_back(split);
  }
  return splits;
}

Layout need_layout(const fs::path& dataset) {
  if (!fs::exists(dataset)) throw Error(dataset, "does not exist; expected a labelled set of pictures");
  Layout layout = layout_of(dataset);
  if (!layout.data && !layout.coco_file && !layout.names && layout.coco.empty()) {
    throw Error(dataset,
                "is no labelled set; expected a .data file (Darknet), a COCO JSON file, or a folder with one of these, with "
                "annotations/*_SPLIT.json, or with pictures and one *.names or classes.txt");
  }
  return layout;
}

}  // namespace

bool is_labelled_set(const fs::path& dataset) {
  const Layout layout = layout_of(dataset);
  return layout.data || layout.coco_file || layout.names || !layout.coco.empty();
}

std::vector<std::string> splits_of(const fs::path& dataset) { return splits_of(need_layout(dataset)); }

LabelledSet read_labelled_set(const fs::path& dataset, const std::string& split) {
  const std::vector<std::string> known = {"train", "valid", "test", "all"};
  if (std::find(known.begin(), known.end(), split) == known.end()) {
    throw Error("split '" + split + "' is not known; expected " + joined(known));
  }
  const Layout layout = need_layout(dataset);
  const std::vector<std::string> splits = splits_of(layout);
  if (split != "all" && std::find(splits.begin(), splits.end(), split) == splits.end()) {
    throw Error(dataset, "has no split '" + split + "'; expected all" + (splits.empty() ? "" : ", " + joined(splits)));
  }
  LabelledSet set;
  if (layout.data) {
    set = read_darknet_set(*layout.data, split);
  } else if (layout.names) {
    set = read_loose_set(dataset, *layout.names);
  } else if (layout.coco_file) {
    read_coco_file(*layout.coco_file, set);
  } else {
    for (const std::string& part : splits) {
      if (split == "all" || split == part) read_coco_file(layout.coco.at(part), set);
    }
  }
  if (set.images.empty()) throw Error(dataset, "holds no pictures (split " + split + "); expected at least one");
  return set;
}

std::vector<fs::path> pictures_in(const fs::path& folder) {
  return files_of(folder, {".jpg", ".jpeg", ".png", ".bmp", ".tif", ".tiff", ".webp"});
}

}  // namespace waretwin

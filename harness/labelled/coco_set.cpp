#include "harness/labelled/coco_set.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <system_error>

#include "core/error.h"
#include "core/files.h"
#include "core/json_text.h"
#include "harness/labelled/label_text.h"
#include "harness/labelled/text_sets.h"

namespace waretwin {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr double kLargest = 1e6;  // pixels: of sides and coordinates
constexpr int kDeepest = 16;      // levels of nesting; annotations need 4

// What is being read, for messages.
struct Place {
  const fs::path& file;
  std::string where;
  [[noreturn]] void fail(const std::string& problem) const { throw Error(file, where.empty() ? problem : where + ": " + problem); }
};

std::string shown(const Json& value) { return value.dump().substr(0, 60); }

const Json& need(const Json& parent, const char* key, const Place& place) {
  if (!parent.is_object()) place.fail("is " + shown(parent) + "; expected an object with '" + key + "'");
  const auto found = parent.find(key);
  if (found == parent.end()) place.fail("key '" + std::string(key) + "' is missing");
  return *found;
}

const Json& need_list(const Json& parent, const char* key, const Place& place) {
  const Json& value = need(parent, key, place);
  if (!value.is_array()) place.fail("'" + std::string(key) + "' is " + shown(value) + "; expected a list");
  return value;
}

std::int64_t need_id(const Json& parent, const char* key, const Place& place) {
  const Json& value = need(parent, key, place);
  if (!value.is_number_integer()) place.fail("'" + std::string(key) + "' is " + shown(value) + "; expected a whole number");
  return value.get<std::int64_t>();
}

std::string need_name(const Json& parent, const char* key, const Place& place) {
  const Json& value = need(parent, key, place);
  if (!value.is_string() || value.get_ref<const std::string&>().empty()) {
    place.fail("'" + std::string(key) + "' is " + shown(value) + "; expected a name");
  }
  return value.get<std::string>();
}

double need_side(const Json& parent, const char* key, const Place& place) {
  const Json& value = need(parent, key, place);
  const double side = value.is_number() ? value.get<double>() : 0.0;
  if (!(side >= 1.0 && side <= kLargest)) place.fail("'" + std::string(key) + "' is " + shown(value) + "; expected pixels from 1");
  return side;
}

bool flag(const Json& parent, const char* key, const Place& place) {
  const auto found = parent.find(key);
  if (found == parent.end()) return false;
  if (found->is_boolean()) return found->get<bool>();
  if (found->is_number_integer() && (*found == 0 || *found == 1)) return *found == 1;
  place.fail("'" + std::string(key) + "' is " + shown(*found) + "; expected 0 or 1");
}

Json parse(const fs::path& file) {
  // Outlines are most of such a file and not wanted here.
  const auto wanted = [&](int depth, Json::parse_event_t event, Json& parsed) {
    if (depth > kDeepest) throw Error(file, "is nested more than " + std::to_string(kDeepest) + " levels deep");
    return !(event == Json::parse_event_t::key && parsed == "segmentation");
  };
  return parse_json<Json>(file, read_file(file), "a labelled set as COCO writes it", wanted);
}

// Where pictures of a JSON file may lie, best first.
std::vector<fs::path> picture_folders(const fs::path& file) {
  const fs::path here = file.has_parent_path() ? file.parent_path() : fs::path("."), up = here / "..";
  const std::string stem = file.stem().string();
  std::vector<fs::path> folders = {here, here / "images", up, up / "images"};
  // COCO's own: train2017/ beside annotations/instances_train2017.json.
  if (const auto bar = stem.rfind('_'); bar != std::string::npos && bar + 1 < stem.size()) folders.push_back(up / stem.substr(bar + 1));
  return folders;
}

fs::path find_picture(const std::vector<fs::path>& folders, const std::string& name, const Place& place) {
  for (const fs::path& folder : folders) {
    std::error_code unreadable;
    fs::path picture = (folder / name).lexically_normal();
    if (fs::is_regular_file(picture, unreadable)) return picture;
  }
  place.fail("no picture '" + name.substr(0, 120) + "'; expected it beside the file, in images/ or one folder up");
}

// Class indices by category id, in the order of the ids.
std::map<std::int64_t, int> read_categories(const Json& document, const fs::path& file, std::vector<std::string>& names) {
  std::map<std::int64_t, std::string> by_id;
  std::set<std::string> seen;
  const Json& categories = need_list(document, "categories", {file, ""});
  for (std::size_t i = 0; i < categories.size(); ++i) {
    const Place place{file, "categories[" + std::to_string(i) + "]"};
    const std::int64_t id = need_id(categories[i], "id", place);
    const std::string name = need_name(categories[i], "name", place);
    if (!by_id.emplace(id, name).second) place.fail("id " + std::to_string(id) + " stands twice");
    if (!seen.insert(name).second) place.fail("name '" + name + "' stands twice");
  }
  if (by_id.empty()) throw Error(file, "'categories' is empty; expected at least one class");
  std::map<std::int64_t, int> indices;
  for (const auto& [id, name] : by_id) {
    indices[id] = static_cast<int>(names.size());
    names.push_back(name);
  }
  return indices;
}

struct Size {
  double width = 0.0, height = 0.0;
};

// Nothing where the annotation has no width or no height.
std::optional<LabelledBox> read_annotation(const Json& annotation, const Size& size, const Place& place) {
  const Json& bbox = need(annotation, "bbox", place);
  std::array<double, 4> n{};
  bool usable = bbox.is_array() && bbox.size() == 4;
  for (std::size_t k = 0; usable && k < 4; ++k) {
    usable = bbox[k].is_number() && std::abs(bbox[k].get<double>()) <= kLargest;
    if (usable) n[k] = bbox[k].get<double>();
  }
  if (!usable || n[2] < 0.0 || n[3] < 0.0) place.fail("'bbox' is " + shown(bbox) + "; expected [x, y, width, height] in pixels");
  LabelledBox box;
  box.ignored = flag(annotation, "iscrowd", place) || flag(annotation, "ignore", place);
  if (const auto area = annotation.find("area"); area != annotation.end()) {
    const double pixels = area->is_number() ? area->get<double>() : -1.0;
    if (!(pixels >= 0.0 && pixels <= kLargest * kLargest)) place.fail("'area' is " + shown(*area) + "; expected pixels from 0");
    box.area = pixels / (size.width * size.height);
  }
  if (n[2] == 0.0 || n[3] == 0.0) return std::nullopt;
  box.share = inside_picture({n[0] / size.width, n[1] / size.height, n[2] / size.width, n[3] / size.height});
  if (box.share.empty()) place.fail("'bbox' is " + shown(bbox) + ", which is outside its picture");
  return box;
}

// train, valid or test by the end of a file's name; empty for others.
std::string split_of(const fs::path& file) {
  std::string word = file.stem().string();
  word = word.substr(word.rfind('_') + 1);  // the whole stem where there is no bar
  while (!word.empty() && word.back() >= '0' && word.back() <= '9') word.pop_back();
  if (word == "train" || word == "test") return word;
  return word == "val" || word == "valid" ? "valid" : "";
}

}  // namespace

std::map<std::string, fs::path> coco_files(const fs::path& folder) {
  std::map<std::string, fs::path> files;
  if (!fs::is_directory(folder / "annotations")) return files;
  const auto is_instances = [](const fs::path& file) { return file.filename().string().starts_with("instances_"); };
  for (const fs::path& file : files_of(folder / "annotations", {".json"})) {
    const std::string split = split_of(file);
    if (split.empty()) continue;
    const auto [entry, added] = files.emplace(split, file);
    if (added) continue;
    if (is_instances(file) == is_instances(entry->second)) {
      throw Error(folder / "annotations", "holds " + entry->second.filename().string() + " and " + file.filename().string() +
                                              "; expected one file for " + split + ", or one named instances_*");
    }
    if (is_instances(file)) entry->second = file;
  }
  return files;
}

void read_coco_file(const fs::path& file, LabelledSet& set) {
  const Json document = parse(file);
  std::vector<std::string> names;
  const std::map<std::int64_t, int> classes = read_categories(document, file, names);
  if (set.classes.empty()) set.classes = names;
  if (set.classes != names) throw Error(file, "'categories' are others than those of the set's other files");

  const std::vector<fs::path> folders = picture_folders(file);
  std::map<std::int64_t, std::size_t> by_id;
  std::vector<Size> sizes;
  const std::size_t first = set.images.size();
  const Json& images = need_list(document, "images", {file, ""});
  for (std::size_t i = 0; i < images.size(); ++i) {
    const Place place{file, "images[" + std::to_string(i) + "]"};
    const std::int64_t id = need_id(images[i], "id", place);
    if (!by_id.emplace(id, i).second) place.fail("id " + std::to_string(id) + " stands twice");
    const std::string name = need_name(images[i], "file_name", place);
    sizes.push_back({need_side(images[i], "width", place), need_side(images[i], "height", place)});
    set.images.push_back({find_picture(folders, name, place), name, {}});
  }
  const auto read_boxes = [&](const Json& entries, const char* key, bool ignored) {
    for (std::size_t i = 0; i < entries.size(); ++i) {
      const Place place{file, std::string(key) + "[" + std::to_string(i) + "]"};
      const auto image = by_id.find(need_id(entries[i], "image_id", place));
      if (image == by_id.end()) place.fail("image_id " + shown(entries[i]["image_id"]) + " is no id of an image");
      const auto index = classes.find(need_id(entries[i], "category_id", place));
      if (index == classes.end()) place.fail("category_id " + shown(entries[i]["category_id"]) + " is no id of a category");
      std::optional<LabelledBox> box = read_annotation(entries[i], sizes[image->second], place);
      if (!box) continue;
      box->class_index = index->second;
      box->ignored = box->ignored || ignored;
      set.images[first + image->second].boxes.push_back(*box);
    }
  };
  read_boxes(need_list(document, "annotations", {file, ""}), "annotations", false);
  // A key of `waretwin dataset`: visible objects without a label.
  if (document.contains("left_out")) read_boxes(need_list(document, "left_out", {file, ""}), "left_out", true);
}

}  // namespace waretwin

#include "harness/dataset/dataset_maker.h"

#include <algorithm>
#include <cstdio>
#include <deque>
#include <future>
#include <set>

#include "core/checksum.h"
#include "core/config.h"
#include "core/error.h"
#include "core/files.h"
#include "core/parallel.h"
#include "harness/dataset/dataset_index.h"
#include "harness/dataset/hall_photographer.h"
#include "harness/pictures/picture_file.h"
#include "harness/run/run_config.h"
#include "sensors/measurements.h"

namespace waretwin {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kWaitingFiles = 4;  // pictures that are encoded while the next ones are made

std::vector<std::string> classes_of(const DatasetConfig& config, const std::vector<std::unique_ptr<HallSource>>& sources) {
  std::set<std::string> all;
  for (const auto& source : sources) {
    const std::vector<std::string> names = source->classes();
    all.insert(names.begin(), names.end());
  }
  if (all.empty()) throw Error("no hall has an object to be labelled; expected truth rules or extras that name a class");
  if (config.classes.empty()) return {all.begin(), all.end()};
  for (const std::string& name : config.classes) {
    if (all.contains(name)) continue;
    std::string known;
    for (const std::string& k : all) known += (known.empty() ? "" : ", ") + k;
    throw Error("dataset.classes: no hall has an object of class '" + name + "'; expected some of " + known);
  }
  return config.classes;
}

void expect_camera(const std::string& name, const std::vector<std::unique_ptr<HallSource>>& sources) {
  for (const auto& source : sources) {
    const std::vector<std::string> known = source->cameras();
    if (name.empty() || std::find(known.begin(), known.end(), name) != known.end()) continue;
    throw Error("dataset.camera.name '" + name + "': " + source->description() +
                " has no such camera; expected one of its sensors.cameras");
  }
}

// What makes two sets the same, as text: dataset.yaml.
std::string description(const DatasetConfig& config, const std::vector<std::unique_ptr<HallSource>>& sources,
                        const std::vector<std::string>& classes, const DatasetFormats& formats) {
  struct {
    DatasetConfig config;
    void visit(Fields& f) { f.group("dataset", config, "a set of training pictures"); }
  } tree{config};
  std::string about = std::string("formats") + (formats.yolo ? " yolo" : "") + (formats.coco ? " coco" : "");
  for (const auto& source : sources) about += "; " + source->description();
  about += "; classes";
  for (const std::string& name : classes) about += " " + name;
  return resolved_config([&](Fields& f) { tree.visit(f); }, about);
}

// A folder belongs to one set: its dataset.yaml says which. Several shards may begin at the same time.
void claim(const fs::path& folder, const std::string& text) {
  const fs::path file = folder / "dataset.yaml";
  const auto is_ours = [&] {
    if (!fs::exists(file)) return false;
    if (read_file(file) == text) return true;
    throw Error(file, "is of a set with other settings, halls or formats; expected the same as before, or a new folder");
  };
  if (is_ours()) return;
  const auto is_foreign = [](const fs::directory_entry& entry) { return !entry.path().filename().string().starts_with(".dataset."); };
  std::error_code problem;
  const auto has_foreign = [&] { return std::any_of(fs::directory_iterator(folder, problem), fs::directory_iterator(), is_foreign); };
  if (fs::exists(folder) && (!fs::is_directory(folder) || has_foreign() || problem)) {
    if (problem) throw Error(folder, "cannot be read: " + problem.message());
    if (is_ours()) return;  // another shard was faster
    throw Error(folder, "is no set of training pictures (it has no dataset.yaml); expected a new name or an empty folder");
  }
  make_folder(folder);
  write_file(file, text);
}

// A hall is done when its record and all files that it names are there: parts of a set may have been copied together.
bool is_done(const fs::path& folder, int number, const std::string& set) {
  const fs::path file = folder / record_name(number);
  if (!fs::exists(file)) return false;
  const HallRecord record = read_hall_record(file);
  if (record.set != set) throw Error(file, "belongs to a set with other settings than dataset.yaml beside it; expected parts of one set");
  for (const ImageRecord& image : record.images) {
    for (const auto& [name, sum] : image.files) {
      if (!fs::exists(folder / name)) return false;
    }
  }
  return true;
}

// Class, and the box's middle and size as shares of the picture; for labels, and for objects that are left out.
template <class Objects>
std::string darknet_lines(const Objects& objects, const Intrinsics& intrinsics) {
  std::string text;
  const double width = intrinsics.width, height = intrinsics.height;
  for (const auto& object : objects) {
    char line[128];
    std::snprintf(line, sizeof line, "%d %.7f %.7f %.7f %.7f\n", object.class_index, (object.box.x + 0.5 * object.box.width) / width,
                  (object.box.y + 0.5 * object.box.height) / height, object.box.width / width, object.box.height / height);
    text += line;
  }
  return text;
}

// Encodes and writes a picture's files; its record with their checksums.
ImageRecord write_photograph(const Photograph& photograph, const fs::path& folder, const DatasetConfig& config,
                             const DatasetFormats& formats) {
  ImageRecord record = photograph.record;
  const auto write = [&](const std::string& name, std::string_view bytes) {
    write_file(folder / name, bytes);
    record.files[name] = sha256(bytes);
  };
  write("images/" + record.name + ".jpg", encoded_jpeg(photograph.colour, config.jpeg_quality));
  if (config.depth) write("depth/" + record.name + ".png", encoded(depth_to_millimetres(photograph.depth), ".png"));
  if (config.instances) write("instances/" + record.name + ".png", encoded(photograph.instances, ".png"));
  if (formats.yolo) {
    write("labels/" + record.name + ".txt", darknet_lines(record.labels.labels, record.intrinsics));
    // Darknet has no word for it; `waretwin train` and `detect` read these as neither objects nor background.
    write("ignored/" + record.name + ".txt", darknet_lines(record.labels.left_out, record.intrinsics));
  }
  return record;
}

}  // namespace

std::vector<std::string> split_halls(int halls, int sources, double valid_share, double test_share) {
  const double shares[] = {1.0 - valid_share - test_share, valid_share, test_share};
  const char* const names[] = {"train", "valid", "test"};
  int counts[] = {0, 0, 0}, seen = 0;
  std::vector<int> splits(static_cast<std::size_t>(halls), 0);
  // Source by source, so that each has its part in every split; each hall goes to the split that is farthest behind its share.
  for (int source = 0; source < sources; ++source) {
    for (int h = source; h < halls; h += sources) {
      ++seen;
      int most = 0;
      for (int k = 1; k < 3; ++k) {
        if (shares[k] * seen - counts[k] > shares[most] * seen - counts[most] + 1e-9) most = k;
      }
      ++counts[most];
      splits[static_cast<std::size_t>(h)] = most;
    }
  }
  // A small set has some of each that is asked for, too, as long as it has halls: trainers want a split to validate on.
  for (int k = 1; k < 3; ++k) {
    if (!(shares[k] > 0.0) || counts[k] > 0 || halls <= k) continue;
    const auto last = std::find(splits.rbegin(), splits.rend(), 0);
    if (last == splits.rend()) continue;
    *last = k;
    ++counts[k];
  }
  std::vector<std::string> out;
  for (const int split : splits) out.emplace_back(names[split]);
  return out;
}

DatasetSummary make_dataset(const DatasetConfig& asked_for, const std::vector<std::unique_ptr<HallSource>>& sources, const fs::path& folder,
                            const DatasetFormats& formats, const Shard& shard, const std::function<void(const DatasetProgress&)>& step) {
  WARETWIN_CHECK(!sources.empty() && shard.count > 0 && shard.index >= 0 && shard.index < shard.count, "halls and a shard of them");
  // dataset.yaml says the number itself: a set goes on as it was begun, whatever the usual number is by then.
  DatasetConfig config = asked_for;
  config.images_per_hall = asked_for.hall_size();
  const std::vector<std::string> classes = classes_of(config, sources);
  expect_camera(config.camera.name, sources);
  const std::string text = description(config, sources, classes, formats);
  const std::string set = sha256(text);
  claim(folder, text);
  make_folder(folder / "halls");
  make_folder(folder / "images");
  if (formats.yolo) make_folder(folder / "labels");
  if (formats.yolo) make_folder(folder / "ignored");
  if (config.depth) make_folder(folder / "depth");
  if (config.instances) make_folder(folder / "instances");

  const int size = config.hall_size(), halls = (config.count + size - 1) / size;
  const std::vector<std::string> splits = split_halls(halls, static_cast<int>(sources.size()), config.valid_share, config.test_share);
  const auto first_image = [&](int number) { return number * size; };
  const auto images_of = [&](int number) { return std::min(size, config.count - first_image(number)); };
  DatasetProgress progress;
  std::deque<int> to_do;
  std::vector<bool> done(static_cast<std::size_t>(halls), false);
  for (int number = shard.index; number < halls; number += shard.count) {
    progress.of += images_of(number);
    if (is_done(folder, number, set)) {
      done[static_cast<std::size_t>(number)] = true;
      progress.found += images_of(number);
    } else {
      to_do.push_back(number);
    }
  }
  progress.done = progress.found;
  if (step) step(progress);

  struct Prepared {
    std::string hall;
    std::unique_ptr<HallPhotographer> photographer;
  };
  const auto prepare = [&](int number) {
    const Hall hall = sources[static_cast<std::size_t>(number) % sources.size()]->hall(static_cast<std::uint64_t>(number));
    return Prepared{hall.name, std::make_unique<HallPhotographer>(hall, config, classes, number)};
  };
  // A hall is made ready while pictures of the one before are taken: much of that is work for one thread.
  const auto how = thread_count() == 1 ? std::launch::deferred : std::launch::async;
  std::future<Prepared> coming;
  if (!to_do.empty()) coming = std::async(how, prepare, to_do.front());
  while (!to_do.empty()) {
    const int number = to_do.front();
    to_do.pop_front();
    Prepared now = coming.get();
    if (!to_do.empty()) coming = std::async(how, prepare, to_do.front());
    HallRecord record;
    record.set = set;
    record.number = number;
    record.hall = now.hall;
    record.split = splits[static_cast<std::size_t>(number)];
    std::deque<std::future<ImageRecord>> writing;
    const auto take_written = [&] {
      record.images.push_back(writing.front().get());
      writing.pop_front();
    };
    for (int i = 0; i < images_of(number); ++i) {
      Photograph photograph = now.photographer->take(first_image(number) + i);
      writing.push_back(std::async(
          how, [&folder, &config, &formats, taken = std::move(photograph)] { return write_photograph(taken, folder, config, formats); }));
      if (writing.size() > kWaitingFiles) take_written();
      ++progress.done;
      if (step) step(progress);
    }
    while (!writing.empty()) take_written();
    write_file(folder / record_name(number), to_json(record));
    done[static_cast<std::size_t>(number)] = true;
  }

  DatasetSummary summary;
  for (int number = 0; number < halls; ++number)
    summary.missing_halls += !done[static_cast<std::size_t>(number)] && !is_done(folder, number, set);
  if (summary.missing_halls > 0) return summary;
  return write_index(folder, halls, config.count, classes, formats, set);
}

}  // namespace waretwin

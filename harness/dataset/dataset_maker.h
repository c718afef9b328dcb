// A set of labelled training pictures on disk.
//
// A set is made hall by hall. Hall number h holds pictures h * hall_size() and on; each of its files depends on the configuration, the
// sources and h alone. So any split over processes (shards), any number of threads, and any number of kills and restarts give the same
// bytes: what a hall leaves is written under final names only when complete, its record (image_record.h) last, and halls whose record is
// there are passed over. Once all records are there, lists and annotations are made from them (dataset_index.h).
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "harness/dataset/dataset_config.h"
#include "harness/dataset/hall_source.h"
#include "harness/units/units.h"

namespace waretwin {

struct DatasetFormats {
  bool yolo = true, coco = true;
};

struct DatasetProgress {
  int done = 0, of = 0;  // pictures of this shard
  int found = 0;         // of those, there already
};

struct DatasetSummary {
  int images = 0, empty = 0;          // of the whole set; 0 where other shards' halls are missing
  std::map<std::string, int> splits;  // pictures of each that has some
  std::vector<std::string> classes;
  std::vector<int> labels;    // by class
  int hidden = 0, small = 0;  // visible objects without a label
  int missing_halls = 0;      // that other shards have not made yet
};

// Makes this shard's halls of the set in `folder`, and the lists of the whole set where it was the last part. `step` is called after each
// picture; what it throws ends the work, and a later call goes on. Throws Error where `folder` holds anything but a set of the very same
// configuration, and for sources without objects of the classes, or without the
// camera, asked for.
DatasetSummary make_dataset(const DatasetConfig& config, const std::vector<std::unique_ptr<HallSource>>& sources,
                            const std::filesystem::path& folder, const DatasetFormats& formats, const Shard& shard,
                            const std::function<void(const DatasetProgress&)>& step = {});

// The split of each hall: as even as the shares allow, over all halls and over those of each source (hall h is of source h % sources). Each
// split with a share has a hall as soon as there are three.
std::vector<std::string> split_halls(int halls, int sources, double valid_share, double test_share);

}  // namespace waretwin

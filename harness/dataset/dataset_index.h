// What tells a trainer which pictures a set has: Darknet's lists, COCO's annotations, the manifest, a sheet of thumbnails.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "harness/dataset/dataset_maker.h"

namespace waretwin {

// From the records of halls 0 to `halls` - 1 in `folder`, which must all be there, with `images` pictures in all:
//   yolo: train.txt, valid.txt, test.txt, dataset.names, dataset.data (paths relative to the folder)
//   coco: annotations/instances_SPLIT.json
//   manifest.json, SHA256SUMS, contact_sheet.png
// Holds one hall's record at a time.
DatasetSummary write_index(const std::filesystem::path& folder, int halls, int images, const std::vector<std::string>& classes,
                           const DatasetFormats& formats, const std::string& configuration_sha256);

}  // namespace waretwin

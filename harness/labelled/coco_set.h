// Sets whose labels are COCO JSON ("Microsoft COCO", Lin et al. 2014; format: cocodataset.org, Data format): images, annotations,
// categories.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "harness/labelled/labelled_set.h"

namespace waretwin {

// The JSON files of annotations/ by split: NAME_train2017.json is train, _val or _valid is valid, _test is test. Of several for one split
// that named instances_* counts. Throws Error where that does not decide.
std::map<std::string, std::filesystem::path> coco_files(const std::filesystem::path& folder);

// Appends the pictures of one file. The first file settles the classes; a further one with others is an Error.
void read_coco_file(const std::filesystem::path& file, LabelledSet& set);

}  // namespace waretwin

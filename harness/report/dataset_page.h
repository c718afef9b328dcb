// The page of a set of training pictures: a sheet to look through before training.
#pragma once

#include <filesystem>

#include "harness/report/page_data.h"

namespace waretwin {

// Reads what `waretwin dataset` leaves; statistics are of all pictures, thumbnails of at most 300 spread over the set. Throws Error naming
// the file for a set that is not finished, or a file of it that is not as it was written.
//
// json beside the keys of PageData:
//   dataset: {images, without_labels, halls, splits, views, left_out, classes: [{name, labels, sides: [..], visible: [..]}]}; `sides`
//   counts labels by the side of the square of their box's area, in share of the picture's: 20 bins of 0.05; `visible` by visible share: 10
//   bins images: [{index, name, split, hall, kind, size, block, labels: [{class, box, amodal_box, visible}], left_out: [{class, box,
//   why}]}]
PageData dataset_page(const std::filesystem::path& folder);

}  // namespace waretwin

// A sheet of thumbnails with their boxes: what a person looks at before training on a set.
#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "harness/dataset/image_record.h"

namespace waretwin {

// Thumbnails of these pictures of the set in `folder`, in rows of six. Boxes in the colours of their classes: visible ones solid, amodal
// ones thin. BGR.
cv::Mat contact_sheet(const std::filesystem::path& folder, const std::vector<ImageRecord>& images, const std::vector<std::string>& classes);

}  // namespace waretwin

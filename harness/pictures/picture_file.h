// Pictures as PNG files.
#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>

namespace waretwin {

// Atomically (core/files.h): a full disk is noticed. Throws Error where the file cannot be written.
void write_png(const std::filesystem::path& file, const cv::Mat& image);

}  // namespace waretwin

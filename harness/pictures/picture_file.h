// Pictures as the bytes of image files.
#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

namespace waretwin {

// `ending` names the format: .png, .jpg. `parameters` as cv::imencode has them.
std::string encoded(const cv::Mat& image, const std::string& ending, const std::vector<int>& parameters = {});

// Likewise; `quality` from 0 to 100.
std::string encoded_jpeg(const cv::Mat& image, int quality);

// Atomically (core/files.h): a full disk is noticed. Throws Error where the file cannot be written.
void write_png(const std::filesystem::path& file, const cv::Mat& image);

}  // namespace waretwin

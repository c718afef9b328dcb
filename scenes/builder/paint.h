// Drawing textures: value noise, stains, scratches, text. Integer and plain double arithmetic only, so that a texture is the same
// wherever it is drawn.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>

#include "core/random.h"

namespace waretwin::builder {

// Smooth noise in [0, 1] that repeats at the picture's edges: `octaves` layers of which the coarsest has `cells` cells across.
// CV_32F, width x height.
cv::Mat tiling_noise(int width, int height, int cells, int octaves, const std::string& key);

// A surface of one colour (BGR, 0-255) with slow changes of brightness (+- coarse) and grain (+- fine), both in grey levels.
cv::Mat mottled(int width, int height, const cv::Scalar& bgr, double coarse, double fine, const std::string& key);

// Darkens (amount < 0) or brightens where noise is high, as dirt and wear do.
void add_stains(cv::Mat& picture, double amount, double threshold, int cells, const std::string& key);

// Thin straight scratches, wrapped at the edges.
void add_scratches(cv::Mat& picture, int count, double length_px, const cv::Scalar& bgr, double opacity, const std::string& key);

// Streaks along x (brushed metal, wood): noise stretched by `stretch`.
void add_streaks(cv::Mat& picture, double amount, int stretch, const std::string& key);

void put_text(cv::Mat& picture, const std::string& text, int x, int baseline_y, double height_px, const cv::Scalar& colour,
              int thickness = 1);

// A made-up linear bar code.
void draw_barcode(cv::Mat& picture, const cv::Rect& area, const std::string& key);

}  // namespace waretwin::builder

// A labelled set that a network learns in seconds: bright rectangles, orange or blue, on a noisy grey.
#pragma once

#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "core/files.h"
#include "core/random.h"

namespace waretwin::test {

inline void write_rectangles(const std::filesystem::path& folder, int train, int valid) {
  make_folder(folder / "images");
  make_folder(folder / "labels");
  std::string lists[2];
  for (int i = 0; i < train + valid; ++i) {
    const RandomStream random(21, "rectangles", "picture", i);
    cv::Mat picture(96, 160, CV_8UC3);
    cv::RNG(static_cast<std::uint64_t>(i) + 1).fill(picture, cv::RNG::UNIFORM, 60, 120);
    std::string labels;
    for (int k = 0; k < 2; ++k) {
      const int w = 28 + static_cast<int>(random.uniform(k, 0) * 30), h = 24 + static_cast<int>(random.uniform(k, 1) * 30);
      const int x = 80 * k + static_cast<int>(random.uniform(k, 2) * (80 - w)), y = static_cast<int>(random.uniform(k, 3) * (96 - h));
      const int c = random.uniform(k, 4) < 0.5 ? 0 : 1;
      cv::rectangle(picture, cv::Rect(x, y, w, h), c == 0 ? cv::Scalar(20, 140, 250) : cv::Scalar(240, 90, 30), cv::FILLED);
      labels += std::to_string(c) + " " + std::to_string((x + 0.5 * w) / 160) + " " + std::to_string((y + 0.5 * h) / 96) + " " +
                std::to_string(w / 160.0) + " " + std::to_string(h / 96.0) + "\n";
    }
    const std::string name = "p" + std::to_string(1000 + i);
    cv::imwrite((folder / "images" / (name + ".png")).string(), picture);
    write_file(folder / "labels" / (name + ".txt"), labels);
    lists[i < train ? 0 : 1] += "images/" + name + ".png\n";
  }
  write_file(folder / "train.txt", lists[0]);
  write_file(folder / "valid.txt", lists[1]);
  write_file(folder / "set.names", "orange\nblue\n");
  write_file(folder / "set.data", "classes = 2\ntrain = train.txt\nvalid = valid.txt\nnames = set.names\n");
}

}  // namespace waretwin::test

// What is known of the pictures of one hall: written beside them when the hall is done, read back when lists and annotations are made.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/pose.h"
#include "harness/dataset/image_labels.h"
#include "sensors/lens.h"

namespace waretwin {

struct ImageRecord {
  int index = 0;     // in the whole set
  std::string name;  // "000042"
  std::string kind;  // ViewKind
  Intrinsics intrinsics;
  Distortion distortion;         // none where pictures are rectified
  Pose X_WC = Pose::Identity();  // at the stamp
  ImageLabels labels;
  std::map<std::string, std::string> files;  // names relative to the set's folder -> SHA-256
};

struct HallRecord {
  std::string set;  // checksum of the dataset.yaml that it was made with
  int number = 0;
  std::string hall;   // its name
  std::string split;  // train, valid, test
  std::vector<ImageRecord> images;
};

const char* to_text(LeftOut::Why why);

// Name of hall `number`'s record in the set's folder.
std::filesystem::path record_name(int number);

// As OpenCV orders them: k1, k2, p1, p2, k3, k4, k5, k6.
std::array<double, 8> coefficients(const Distortion& distortion);

std::string to_json(const HallRecord& record);
// Throws Error naming the file where it is no such record.
HallRecord read_hall_record(const std::filesystem::path& file);

}  // namespace waretwin

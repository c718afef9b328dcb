// What the paper publishes about SceneNN: Zhou et al., "Efficient Object-Level Semantic Mapping with RGB-D Cameras", section 4.2, Tables 1
// to 5. Percent and milliseconds as printed.
//
// Printed averages that do not follow from their own rows stand here as printed:
// - Table 1: the averages of 061, 206, 223 and 255 are means over all classes of the row. That of 086 leaves the zeros out; those of 011,
//   016, 030, 078 and 096 are neither.
// - Table 2: all averages are means over all classes of the row, zeros included.
// - Table 3: the averages of Li et al. and of the paper are means over the ten sequences; those of Pham et al. and Grinvald et al. are not
//   (their rows give 42.0 and 52.4). Its last sequence is printed as 225; Tables 1 and 2 call it 255. Grinvald et al. have 43.6 on 223
//   there, 43.8 in Table 2.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace waretwin {

// Columns of Tables 1 and 2, and of Table 3.
inline constexpr std::array<const char*, 9> kSceneNnClasses = {"bed",          "chair",      "sofa",   "table", "books",
                                                               "refrigerator", "television", "toilet", "bag"};
inline constexpr std::array<const char*, 10> kSceneNnSequences = {"011", "016", "030", "061", "078", "086", "096", "206", "223", "255"};

// A row of Table 1 (3D IoU) or 2 (AP): a class that the sequence does not have is a dash there and nothing here.
struct PaperSequence {
  std::string id;
  std::array<std::optional<double>, 9> classes;
  double average = 0.0;
  std::optional<double> average_voxbloxpp;  // Table 2 alone
};

// A row of Table 3: mAP of a method.
struct PaperMethod {
  std::string name;
  std::array<double, 10> sequences;
  double average = 0.0;
};

// A row of Table 4; the last one is the total.
struct PaperModule {
  std::string name;
  double cpu_ms = 0.0, gpu_ms = 0.0;
};

struct PaperSystem {
  std::string name, platform, frequency, map;
  double fps = 0.0;
};

const std::vector<PaperSequence>& paper_table1();
const std::vector<PaperSequence>& paper_table2();
const std::vector<PaperMethod>& paper_table3();
const std::vector<PaperModule>& paper_table4();
const std::vector<PaperSystem>& paper_table5();

}  // namespace waretwin

#include "harness/score/scenenn_paper.h"

namespace waretwin {

namespace {

constexpr std::optional<double> kDash = std::nullopt;

}  // namespace

const std::vector<PaperSequence>& paper_table1() {
  // clang-format off
  static const std::vector<PaperSequence> rows = {
      //         bed    chair  sofa   table  books  fridge tv     toilet bag
      {"011", {{kDash, 70.2,  70.2,  86.3,  kDash, kDash, kDash, kDash, kDash}}, 78.0, kDash},
      {"016", {{51.3,  kDash, 71.9,  0.0,   kDash, kDash, kDash, kDash, kDash}}, 41.4, kDash},
      {"030", {{kDash, 57.6,  80.4,  85.7,  0.0,   kDash, kDash, kDash, kDash}}, 57.4, kDash},
      {"061", {{kDash, 74.5,  62.7,  95.1,  kDash, kDash, kDash, kDash, kDash}}, 77.4, kDash},
      {"078", {{kDash, 45.9,  kDash, 0.0,   0.0,   67.8,  kDash, kDash, kDash}}, 13.9, kDash},
      {"086", {{kDash, 58.2,  kDash, 0.0,   0.0,   kDash, kDash, kDash, 53.8 }}, 56.0, kDash},
      {"096", {{63.1,  60.9,  kDash, 0.0,   0.0,   kDash, 32.3,  kDash, 0.0  }}, 31.3, kDash},
      {"206", {{kDash, 56.5,  23.3,  65.5,  kDash, kDash, kDash, kDash, 29.6 }}, 43.7, kDash},
      {"223", {{kDash, 63.7,  kDash, 69.2,  kDash, kDash, kDash, kDash, kDash}}, 66.5, kDash},
      {"255", {{kDash, kDash, kDash, kDash, kDash, 55.8,  kDash, kDash, kDash}}, 55.8, kDash}};
  // clang-format on
  return rows;
}

const std::vector<PaperSequence>& paper_table2() {
  // clang-format off
  static const std::vector<PaperSequence> rows = {
      //         bed    chair  sofa   table  books  fridge tv     toilet bag
      {"011", {{kDash, 100.0, 100.0, 100.0, kDash, kDash, kDash, kDash, kDash}}, 100.0, 75.0},
      {"016", {{100.0, kDash, 100.0, 0.0,   kDash, kDash, kDash, kDash, kDash}}, 66.7,  33.3},
      {"030", {{kDash, 72.0,  100.0, 66.7,  0.0,   kDash, kDash, kDash, kDash}}, 59.7,  56.1},
      {"061", {{kDash, 62.5,  100.0, 33.3,  kDash, kDash, kDash, kDash, kDash}}, 65.3,  66.7},
      {"078", {{kDash, 50.0,  kDash, 0.0,   0.0,   100.0, kDash, kDash, kDash}}, 37.5,  45.2},
      {"086", {{kDash, 75.0,  kDash, 0.0,   0.0,   kDash, kDash, kDash, 50.0 }}, 31.3,  20.0},
      {"096", {{100.0, 100.0, kDash, 0.0,   0.0,   kDash, 0.0,   kDash, 0.0  }}, 33.3,  29.2},
      {"206", {{kDash, 41.0,  0.0,   40.0,  kDash, kDash, kDash, kDash, 0.0  }}, 20.3,  79.6},
      {"223", {{kDash, 100.0, kDash, 50.0,  kDash, kDash, kDash, kDash, kDash}}, 75.0,  43.8},
      {"255", {{kDash, kDash, kDash, kDash, kDash, 100.0, kDash, kDash, kDash}}, 100.0, 75.0}};
  // clang-format on
  return rows;
}

const std::vector<PaperMethod>& paper_table3() {
  static const std::vector<PaperMethod> rows = {
      {"Pham et al. (2019)", {52.1, 34.2, 56.8, 59.1, 34.9, 35.0, 16.5, 41.7, 40.9, 48.6}, 43.0},
      {"Grinvald et al. (2019)", {75.0, 33.3, 56.1, 66.7, 45.2, 20.0, 29.2, 79.6, 43.6, 75.0}, 54.4},
      {"Li et al. (2020b)", {78.6, 25.0, 58.6, 46.6, 69.8, 47.2, 26.6, 78.0, 45.8, 75.0}, 55.1},
      {"Zhou et al. (the paper)", {100.0, 66.7, 59.7, 65.3, 37.5, 31.3, 33.3, 20.3, 75.0, 100.0}, 58.9}};
  return rows;
}

const std::vector<PaperModule>& paper_table4() {
  static const std::vector<PaperModule> rows = {{"Object Detection", 725.0, 32.0},
                                                {"Object Segmentation", 17.75, 15.0},
                                                {"Object Association", 5.22, 5.0},
                                                {"Object Mapping", 299.0, 50.0},
                                                {"Total", 1046.97, 102.0}};
  return rows;
}

const std::vector<PaperSystem>& paper_table5() {
  static const std::vector<PaperSystem> rows = {{"Pham et al. (2019)", "Nvidia Quadro M2200", "every frame", "object-oriented", 1.0},
                                                {"Grinvald et al. (2019)", "NVIDIA Titan X", "every frame", "object-oriented", 1.0},
                                                {"Li et al. (2020b)", "Nvidia GeForce GTX1080 Ti", "every frame", "object-oriented", 10.8},
                                                {"Zhou et al., GPU", "Nvidia GeForce GTX3050 Ti", "every frame", "object-oriented", 10.0},
                                                {"Zhou et al., CPU", "None", "every frame", "object-oriented", 1.0}};
  return rows;
}

}  // namespace waretwin

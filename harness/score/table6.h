// The paper's Table 6 with ours beside it.
#pragma once

#include <string>
#include <vector>

#include "harness/score/run_score.h"

namespace waretwin {

struct PaperRow {
  std::string id;  // "1" to "4", "Average"
  double iou3d, e_trans_m, e_rot_deg;
};

// Zhou et al., Table 6: "Evaluation of object detection accuracy on the logistic environment". The average comes last.
const std::vector<PaperRow>& paper_table6();

// Markdown: a row an object (IoU_3D, E_trans in metres, E_rot in degrees) and the average, as mapped and after alignment, then the paper's
// own rows. Objects that do not count are marked and left out of the average.
std::string table6(const ComparedLists& objects, const std::string& title);

}  // namespace waretwin

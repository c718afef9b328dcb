#include "harness/gate/measures.h"

#include <array>
#include <cmath>

namespace waretwin {

namespace {

// Runs are deterministic, so a tolerance is no allowance for noise: it says what nobody would miss. Times depend on the machine.
constexpr std::array<Measure, 23> kMeasures = {{
    {"objects_seen", "/summary/truth", true, 0.0, "true objects that were seen enough to count"},
    {"recall", "/summary/recall", true, 0.0, "share of the counted true objects that are matched"},
    {"precision", "/summary/precision", true, 0.0, "share of the mapped objects that match a true one"},
    {"mean_iou3d", "/summary/mean_iou3d", true, 0.005, "mean 3D IoU over the counted true objects"},
    {"mean_e_trans_m", "/summary/mean_e_trans_m", false, 0.002, "mean distance of centres, m"},
    {"mean_e_rot_deg", "/summary/mean_e_rot_deg", false, 0.2, "mean error of yaw, deg"},
    {"ap50", "/summary/ap50", true, 0.005, "area under the precision-recall curve of objects"},
    {"map_paper", "/summary/map_paper", true, 0.005, "the paper's mAP"},
    {"ate_rmse_m", "/trajectory/ate_rmse_m", false, 0.002, "trajectory error, root mean square, m"},
    {"ate_max_m", "/trajectory/ate_max_m", false, 0.01, "trajectory error, largest, m"},
    {"rpe_trans_m", "/trajectory/rpe_trans_m", false, 0.002, "relative pose error, m"},
    {"rpe_rot_deg", "/trajectory/rpe_rot_deg", false, 0.05, "relative pose error, deg"},
    {"unlocalised_share", "/trajectory/unlocalised_share", false, 0.005, "share of the poses on the move that rest on odometry alone",
     false, true},
    {"surface_mean_m", "/surface/mean_m", false, 0.001, "mean distance of the mesh from the hall, m", false, true},
    {"surface_found", "/surface/found", true, 0.005, "share of the seen surface that the mesh has", false, true},
    {"detection_ap50", "/detection/ap50", true, 0.01, "the detector's AP50 in the mapped frames", false, true},
    {"detection_precision", "/detection/precision", true, 0.01, "the detector's precision there", false, true},
    {"detection_recall", "/detection/recall", true, 0.01, "the detector's recall there", false, true},
    {"frames_without_pose", "/frames/without_pose", false, 0.0, "camera frames that could not be placed", false, true},
    {"contacts", "/motion/contacts", false, 0.0, "how often the vehicle touched something", true},
    {"frame_median_ms", "/timing_ms/frame/median", false, std::nullopt, "time of a mapped frame, median, ms", false, true},
    {"frame_p95_ms", "/timing_ms/frame/p95", false, std::nullopt, "time of a mapped frame, 95th percentile, ms", false, true},
    {"peak_rss_mb", "/peak_rss_mb", false, std::nullopt, "memory, MB"},
}};

}  // namespace

std::span<const Measure> measures() { return kMeasures; }

void MeasureValues::visit(Fields& f, const char* meaning) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string doc = std::string(meaning) + ": " + kMeasures[i].what;
    f(kMeasures[i].name, values[i], doc.c_str(), {.min = 0});
  }
}

Tolerances::Tolerances() {
  for (std::size_t i = 0; i < kMeasures.size(); ++i) measures.values[i] = kMeasures[i].tolerance;
}

void Tolerances::visit(Fields& f) {
  measures.visit(f, "how much worse it may be");
  f("object_iou3d", object_iou3d, "how much worse it may be: 3D IoU of each true object by itself", {.min = 0, .max = 1});
}

void PassMarks::visit(Fields& f) { measures.visit(f, "what it must reach"); }

}  // namespace waretwin

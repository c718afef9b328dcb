// Mapped cuboids against true ones, the way the paper's Table 6 compares them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/fields.h"
#include "harness/score/cuboid_file.h"

namespace waretwin {

struct ScoringRules {
  double max_centre_distance_m = 1.0;  // a pair's centres are nearer than this
  double match_iou = 0.5;              // matched: IoU of at least this
  double min_visible_fraction = 0.6;   // true objects that were seen less do not count
  double square_ratio = 1.1;           // dx / dy below this: the box looks the same after 90 deg
  void visit(Fields& f);
};

// One true object and what was mapped of it.
struct ObjectScore {
  int truth_id = 0;
  std::optional<int> map_id;  // the assigned mapped object
  std::string class_name;
  double iou3d = 0.0;               // 0 without a partner
  std::optional<double> e_trans_m;  // distance of the centres; nothing without a partner
  std::optional<double> e_rot_deg;  // in [0, 90], [0, 45] for square boxes
  double visible_fraction = 1.0;
  bool counted = true;  // visible_fraction reaches the rule's minimum
};

// Means over nothing are empty.
struct ScoreSummary {
  int truth = 0;    // true objects that count
  int mapped = 0;   // mapped objects that count: of a class that the truth names, not assigned to a true object that does not count
  int matched = 0;  // counted pairs with IoU >= match_iou
  std::optional<double> recall, precision;
  std::optional<double> mean_iou3d;                      // over counted true objects, an unassigned one as 0
  std::optional<double> mean_e_trans_m, mean_e_rot_deg;  // over counted pairs
  std::optional<double> ap50;                            // area under the precision-recall curve, averaged over classes
  std::optional<double> map_paper;  // the paper's mAP: TP / (TP + FP) a class, averaged; a class of which nothing was mapped gives 0
};

// The same of one class that the truth names.
struct ClassScore {
  std::string class_name;
  int truth = 0, mapped = 0, matched = 0, assigned = 0;  // objects that count; assigned: true objects with a partner, however small the IoU
  // Nothing where no true object counts, of the class's own counts as in the summary.
  std::optional<double> mean_iou3d;  // over counted true objects, an unassigned one as 0
  std::optional<double> ap50;        // area under the precision-recall curve
  std::optional<double> ap_paper;    // TP / (TP + FP); 0 where nothing was mapped
};

struct ObjectListScore {
  std::vector<ObjectScore> objects;  // in the order of the truth
  std::vector<int> false_positives;  // ids of mapped objects that count and match nothing, ascending
  std::vector<ClassScore> classes;   // by name
  ScoreSummary summary;
};

// Pairs are assigned within a class by largest total IoU, among those with IoU > 0 and centres near enough. Mapped objects of classes that
// the truth does not name are left out. All cuboids must name the same frame (Error otherwise).
ObjectListScore score_objects(const std::vector<ListedObject>& mapped, const std::vector<ListedObject>& truth,
                              const ScoringRules& rules = {});

}  // namespace waretwin

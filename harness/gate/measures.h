// The numbers of score.json that gates judge, each with what is better and by how much it may get worse.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/fields.h"

namespace waretwin {

struct Measure {
  const char* name;   // in tolerances, pass marks and tables
  const char* place;  // in score.json, as a JSON pointer
  bool more_is_better;
  std::optional<double> tolerance;  // by which it may get worse, in its own unit; nothing: shown and not judged unless asked for
  const char* what;
  bool counts = false;  // the entries of a list there
  bool ours = false;    // comes of our own mapper's stages: another mapper's score has none
};
std::span<const Measure> measures();

// One optional number for each of measures(), as a configuration group: pass marks, or tolerances beside the usual ones.
struct MeasureValues {
  std::vector<std::optional<double>> values = std::vector<std::optional<double>>(measures().size());
  void visit(Fields& f, const char* meaning);  // `meaning` of a number, before what is measured
};

// How much worse each measure may be. A file's keys replace the usual values.
struct Tolerances {
  Tolerances();
  MeasureValues measures;
  std::optional<double> object_iou3d = 0.05;  // of each true object by itself, which a mean would hide
  void visit(Fields& f);
};

// The least (of what is better when more) or most that a score may have.
struct PassMarks {
  MeasureValues measures;
  void visit(Fields& f);
};

}  // namespace waretwin

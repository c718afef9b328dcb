#include "harness/study/study_measures.h"

#include "harness/gate/measures.h"

namespace waretwin {

const std::vector<StudyMeasure>& study_measures() {
  static const std::vector<StudyMeasure> all = [] {
    std::vector<StudyMeasure> list;
    for (const Measure& measure : measures()) {
      // All objects count in a study, so their number says nothing.
      if (!measure.tolerance || std::string(measure.name) == "objects_seen") continue;
      list.push_back({measure.name, measure.what, measure.more_is_better, MeasureSource::kRun});
    }
    const auto coverage = [&list](const char* name, const char* what, bool more_is_better) {
      list.push_back({name, what, more_is_better, MeasureSource::kCoverage});
    };
    coverage("object_coverage", "share of the true objects' viewable surface that the depth cameras see along the route, mean over objects",
             true);
    coverage("object_coverage_least", "the same of the object that is seen least", true);
    coverage("floor_coverage", "share of the viewable floor that the depth cameras see along the route", true);
    coverage("blind_floor", "share of the floor around the vehicle that no depth camera sees at an instant", false);
    coverage("blind_ahead_m", "from the vehicle's front to the nearest floor on its lane that a depth camera sees, m", false);
    coverage("blind_laser", "share of the directions around the vehicle that no laser looks into", false);
    coverage("route_s", "time that the route takes, s", false);
    return list;
  }();
  return all;
}

std::optional<std::size_t> study_measure(const std::string& name) {
  const std::vector<StudyMeasure>& all = study_measures();
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].name == name) return i;
  }
  return std::nullopt;
}

std::string study_measure_names() {
  std::string names;
  for (const StudyMeasure& measure : study_measures()) names += (names.empty() ? "" : ", ") + measure.name;
  return names;
}

}  // namespace waretwin

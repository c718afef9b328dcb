// The budget of errors: what each stage of the mapper costs, by putting the truth in its place.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/run/run_config.h"
#include "harness/score/run_score.h"

namespace waretwin {

struct BudgetRow {
  std::string name;   // "as configured", "true poses", "true boxes", "true depth", "true association", "all true"
  bool same = false;  // the configuration has the truth there already: equals the first row
  ComparedLists objects;
  std::optional<TrajectoryScore> trajectory;  // not aligned
};

// Drives the route once; each row maps the same measurements. True depth is the ideal depth of the colour view, as `--depth truth` gives
// it. `truth` with the visible fractions of the run. `progress`, after each event: share of the drive that is done.
std::vector<BudgetRow> run_budget(const RunConfig& config, const std::shared_ptr<const Scene>& scene,
                                  const std::vector<ListedObject>& truth, const std::function<void(double)>& progress = {});

// budget.md: a row a stage, with what it costs against the first row in IoU, metres and degrees.
std::string budget_text(const std::vector<BudgetRow>& rows, const std::string& title);

}  // namespace waretwin

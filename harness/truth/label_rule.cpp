#include "harness/truth/label_rule.h"

namespace waretwin {

void LabelRule::visit(Fields& f) {
  f("min_visible", min_visible, "share of the whole object, parts beyond the picture included, that must be visible", {.min = 0, .max = 1});
  f("min_side_px", min_side_px, "longer side of the visible box, at least", {.min = 1, .max = 16384});
}

}  // namespace waretwin

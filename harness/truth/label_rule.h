// Which objects of a picture a detector is to find.
#pragma once

#include <algorithm>

#include "core/fields.h"
#include "sim/object_views.h"

namespace waretwin {

struct LabelRule {
  double min_visible = 0.3;  // share of the whole object, parts beyond the picture included, that the picture shows
  int min_side_px = 24;      // longer side of the visible box

  bool too_small(const ObjectView& view) const { return std::max(view.visible_box.width, view.visible_box.height) < min_side_px; }
  bool labels(const ObjectView& view) const { return !too_small(view) && view.visible() >= min_visible; }
  void visit(Fields& f);
};

}  // namespace waretwin

#include "scenes/builder/halls.h"

namespace waretwin::builder {

void build_warehouse(Kit& kit) { kit.group("warehouse", -1); }

}  // namespace waretwin::builder

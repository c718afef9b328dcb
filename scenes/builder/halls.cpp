#include "scenes/builder/halls.h"

#include "core/error.h"

namespace waretwin::builder {

std::vector<std::string> hall_names() { return {"agiprobot", "warehouse"}; }

std::string build_hall(const std::string& name) {
  Kit kit;
  if (name == "agiprobot") {
    build_agiprobot(kit);
  } else if (name == "warehouse") {
    build_warehouse(kit);
  } else {
    throw Error("hall '" + name + "' is not known; expected agiprobot or warehouse");
  }
  return kit.model.to_glb(name);
}

}  // namespace waretwin::builder

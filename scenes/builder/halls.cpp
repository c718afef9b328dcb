#include "scenes/builder/halls.h"

#include "core/error.h"

namespace waretwin::builder {

std::vector<std::string> hall_names() { return {"agiprobot"}; }

std::string build_hall(const std::string& name) {
  Kit kit;
  if (name == "agiprobot") {
    build_agiprobot(kit);
  } else {
    throw Error("hall '" + name + "' is not known; expected agiprobot");
  }
  return kit.model.to_glb(name);
}

}  // namespace waretwin::builder

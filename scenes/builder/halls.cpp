#include "scenes/builder/halls.h"

#include "core/error.h"
#include "scenes/builder/parts/movers.h"

namespace waretwin::builder {

std::vector<std::string> hall_names() { return {"agiprobot", "warehouse", "flat"}; }

std::vector<HallFile> build_hall(const std::string& name) {
  Kit kit;
  std::vector<std::string> movers;
  if (name == "agiprobot") {
    build_agiprobot(kit);
    movers = {"tote", "block", "person", "cart", "vehicle", "board", "stand"};
  } else if (name == "warehouse") {
    build_warehouse(kit);
    movers = {"carton", "tote", "person", "cart"};
  } else if (name == "flat") {
    build_flat(kit);
  } else {
    throw Error("hall '" + name + "' is not known; expected agiprobot, warehouse or flat");
  }
  std::vector<HallFile> files = {{"hall.glb", kit.model.to_glb(name)}};
  for (const std::string& mover : movers) files.push_back({mover + ".glb", build_mover(mover)});
  return files;
}

}  // namespace waretwin::builder

// Random halls on disk: the generator's plans, built, loaded back and looked at along their routes.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "scenes/generate/generate_config.h"
#include "scenes/scene.h"

namespace waretwin {

struct MadeObject {
  TrueObject object;      // as loaded from the written files
  std::string kind;       // "table-top belt" ...
  double coverage = 0.0;  // share of its viewable surface that depth views along the route see
  int stops = 0;          // of the route that look at it
};

struct MadeHall {
  std::string name;
  double length_m = 0.0, width_m = 0.0, height_m = 0.0;
  std::string what;  // "conveyors": what its objects are
  std::vector<MadeObject> objects;
  int things = 0;        // that stand about
  int stops = 0;         // of the route
  double route_m = 0.0;  // driven
  double route_s = 0.0;  // with turns and waits
  int draws = 0;         // halls drawn until one did
};

struct HallMakerHooks {
  std::function<void()> step;                       // several times a hall; what it throws ends the making and leaves nothing behind
  std::function<void(const std::string&)> in_vain;  // after each draw that did not do: why
};

// Draws a hall, writes it into `folder` as a scenario of its own (scenario.yaml, hall.glb, plan.png), and checks on the written files that
// the route shows every object: by depth views once a second, as the paper maps. Where it does not, the route looks closer, and after
// that another hall is drawn; the outcome depends on the configuration alone. The folder appears when the hall is complete and replaces
// only an earlier generated one. Throws Error for a size that has no room for the objects,
// where no draw shows them all, and for a folder that holds anything else.
MadeHall make_hall(const generate::GenerateConfig& config, const std::filesystem::path& folder, const HallMakerHooks& hooks = {});

}  // namespace waretwin

// The finishes that parts are made of: painted metal, rubber, wood, screens, labels. Colours, textures drawn to scale, and the share
// of 850 nm light that comes back to a time-of-flight camera.
#pragma once

#include <string>
#include <vector>

#include "scenes/builder/model.h"

namespace waretwin::builder {

// The finish of this name; a name that is not known is a fault of ours.
Finish make_finish(const std::string& name);

std::vector<std::string> finish_names();

}  // namespace waretwin::builder

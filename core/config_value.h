// A single value out of a configuration struct.
#pragma once

#include <optional>
#include <string>

#include "core/config.h"

namespace waretwin {

// The present value of the field with this path ("sensors.cameras.camera.mount.z_m"), as a --set value would give it; nothing where no
// visited field has the path.
std::optional<std::string> value_of(const std::string& key, const VisitFunction& visit);

// Whether the field with this path holds a text; not where no visited field has the path.
bool is_text(const std::string& key, const VisitFunction& visit);

}  // namespace waretwin

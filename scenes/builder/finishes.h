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

// Finishes to order, for halls that are drawn at random. Colours are sRGB in [0, 1]; the same `key` gives the same dirt and scratches.
Finish paint_to_order(const std::string& key, const Eigen::Vector3d& colour, double roughness, double reflectivity);  // on metal
Finish belt_to_order(const std::string& key, const Eigen::Vector3d& colour, double reflectivity);
Finish floor_to_order(const std::string& key, const Eigen::Vector3d& colour, double wear, double reflectivity);  // wear from 0 to 1
Finish wall_to_order(const std::string& key, const Eigen::Vector3d& colour, double reflectivity);
Finish plain_to_order(const Eigen::Vector3d& colour, double roughness, double reflectivity);  // without a texture

}  // namespace waretwin::builder

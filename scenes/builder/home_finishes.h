// What flats are made of: parquet, tiles, wood, cloth, ceramic, leather, book covers, pictures. Named as in finishes.h.
#pragma once

#include <functional>
#include <map>
#include <string>

#include "scenes/builder/model.h"

namespace waretwin::builder {

using Recipe = std::function<Finish()>;

const std::map<std::string, Recipe>& home_recipes();

// To order, for flats that are drawn at random. Colours are sRGB in [0, 1]; the same `key` gives the same grain.
Finish parquet_to_order(const std::string& key, const Eigen::Vector3d& colour, double reflectivity);
Finish tiles_to_order(const std::string& key, const Eigen::Vector3d& colour, double tile_m, double reflectivity);
Finish wood_to_order(const std::string& key, const Eigen::Vector3d& colour, double reflectivity);
Finish fabric_to_order(const std::string& key, const Eigen::Vector3d& colour, double reflectivity);
Finish carpet_to_order(const std::string& key, const Eigen::Vector3d& ground, const Eigen::Vector3d& border, double reflectivity);

}  // namespace waretwin::builder

// Boxes with round numbers for the scoring tests.
#pragma once

#include <string>

#include "harness/score/cuboid_file.h"

namespace waretwin::test {

inline ListedObject object(int id, const std::string& class_name, double x, double y, double yaw_deg = 0.0,
                           const Eigen::Vector3d& size = {2.0, 1.0, 1.0}) {
  ListedObject result;
  result.id = id;
  result.class_name = class_name;
  result.cuboid.centre = {x, y, 0.5 * size.z()};
  result.cuboid.yaw = to_radians(yaw_deg);
  result.cuboid.size = size;
  return result;
}

}  // namespace waretwin::test

// Poses, numbers and object lists as a page's JSON has them.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "core/pose.h"
#include "harness/score/cuboid_file.h"

namespace waretwin {

using Json = nlohmann::ordered_json;

// To so many decimals; null for what is not finite.
Json rounded(double value, int decimals);

// x, y, z, qx, qy, qz, qw.
Json pose_json(const Pose& X);
// Throws Error for a quaternion of no length; nlohmann's exceptions for anything else that is no pose.
Pose pose_from(const Json& json);

// [{id, class, centre, yaw, size, score}], metres and radians.
Json objects_json(const std::vector<ListedObject>& objects);
std::vector<ListedObject> objects_from(const Json& json);

}  // namespace waretwin

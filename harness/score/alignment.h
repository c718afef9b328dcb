// One planar motion that lays the map over the truth: what is left after it is the error of the objects, without the robot's drift.
#pragma once

#include <optional>
#include <vector>

#include "harness/score/object_score.h"

namespace waretwin {

// The upright motion X_TM (x, y and yaw; T the truth's world, M the map's) that minimises the squared distances between the centres of the
// counted pairs of `score`. With one pair, centre and yaw are laid over each other. Nothing where there is no pair.
std::optional<Pose> align_map_to_truth(const std::vector<ListedObject>& mapped, const std::vector<ListedObject>& truth,
                                       const ObjectListScore& score);

// The list moved by X_TM; frames keep their name.
std::vector<ListedObject> moved(const std::vector<ListedObject>& objects, const Pose& X_TM);

}  // namespace waretwin

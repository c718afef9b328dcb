// SceneNN's annotation of a scene (Hua et al. 2016), NAME.xml: <label id="3" text="chair" nyu_class="chair" obbox="cx cy cz dx dy dz qx qy
// qz qw"/>, the box as centre, edge lengths along its own axes and orientation, in metres in the recording's world.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/pose.h"
#include "harness/score/cuboid_file.h"

namespace waretwin {

// True objects as such a file; numbers come back to the same bits.
std::string scenenn_annotation(const std::vector<ListedObject>& objects);

// The labelled objects of such a file as upright cuboids of `frame`, whose z points up; X_UR is the pose of the recording's world in it. A
// box that is tilted becomes the upright one around its corners with the heading of its own edges. The class is nyu_class, else text, in
// lower case; labels without a class or a box, and those of the room itself (wall, floor, ceiling), are left out, and NYU's
// "refridgerator" is spelt as the paper does. Throws Error naming file and label for what is damaged.
std::vector<ListedObject> read_scenenn_annotation(const std::filesystem::path& file, const Pose& X_UR = Pose::Identity(),
                                                  const std::string& frame = "world");

}  // namespace waretwin

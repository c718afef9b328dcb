// What is in a hall, as text for people.
#pragma once

#include <filesystem>
#include <string>

#include "scenes/scenario.h"
#include "scenes/scene.h"

namespace waretwin {

// Counts, bounds, materials, textures, lights, objects with their cuboids, and the loader's notes; several lines, each with its end.
std::string describe_scene(const Scene& scene);

// A scenario's own values (models, route, robot, sensors) followed by its scene. Throws Error when the scene cannot be built.
std::string describe_scenario(const Scenario& scenario);

}  // namespace waretwin

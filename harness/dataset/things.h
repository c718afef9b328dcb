// What is put into a hall beside its own things, so that a detector meets more than the hall's designer thought of: loose things that
// fall (sim/motion), and things that stand. None of it is an object.
#pragma once

#include "core/dice.h"
#include "harness/dataset/dataset_config.h"
#include "scenes/scenario.h"
#include "scenes/scene.h"

namespace waretwin {

// Adds to the scene, and to the scenario's motion what falls. Standing things keep off the vehicle's route and off everything else.
void add_things(Scene& scene, Scenario& scenario, const ThingsVariation& config, Dice& dice);

}  // namespace waretwin

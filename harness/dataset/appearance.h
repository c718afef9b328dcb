// Another look for a hall: lamps, materials, stains.
#pragma once

#include "core/dice.h"
#include "harness/dataset/dataset_config.h"
#include "scenes/scene.h"

namespace waretwin {

void vary_light(Scene& scene, const LightVariation& config, Dice& dice);

// Materials that shine by themselves (lamps, screens) stay as they are. Textures that are changed are copied: other materials keep theirs.
void vary_materials(Scene& scene, const MaterialVariation& config, Dice& dice);

}  // namespace waretwin

// What each candidate's cameras would see: a look before hours of driving.
#pragma once

#include <filesystem>
#include <functional>

#include "harness/study/study.h"

namespace waretwin {

// Writes OUT/preview/cNNN.png for every candidate that no constraint on its factors refuses, and preview.png with up to 48 of them in rows:
// the first hall from the moment of the route at which the baseline sees most of the true objects, its cameras side by side. Where a depth
// camera reads nothing (outside its field or its range), the picture is dim. Nothing is measured or driven. Returns the number of
// candidates drawn. Throws Error as run_study, and for a vehicle without a camera.
int draw_previews(const StudyRequest& request, const StudyHooks& hooks = {});

}  // namespace waretwin

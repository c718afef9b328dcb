// How pictures are made.
#pragma once

#include <cstdint>
#include <string>

#include "core/fields.h"

namespace waretwin {

struct RenderOptions {
  // "fast": direct light with one shadow ray for two pixels, ambient light with half-resolution occlusion. "path": unidirectional path
  // tracing with next-event estimation, for stills and training images.
  std::string quality = "fast";
  int samples = 16;       // per pixel, in `path`
  int bounces = 4;        // in `path`: surfaces after the first that may add light
  bool shadows = true;    // in `fast`
  bool occlusion = true;  // in `fast`: ambient occlusion
  double exposure = 1.0;  // factor on radiance before the tone curve, on top of the scenario's
  void visit(Fields& f);
};

}  // namespace waretwin

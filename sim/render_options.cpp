#include "sim/render_options.h"

namespace waretwin {

void RenderOptions::visit(Fields& f) {
  f("quality", quality, "fast: direct and ambient light; path: bounced light too, many times slower", {.choices = {"fast", "path"}});
  f("samples", samples, "rays a pixel of quality path", {.min = 1, .max = 65536});
  f("bounces", bounces, "reflections that light may take in quality path", {.min = 0, .max = 1000});
  f("shadows", shadows, "cast shadows in quality fast");
  f("occlusion", occlusion, "darken ambient light in corners in quality fast");
  f("exposure", exposure, "factor on radiance before the tone curve", {.min = 0, .max = 1e6});
}

}  // namespace waretwin

// Which files of a map are written. All are, but for those that need an optional package.
#pragma once

#include <string>

#include "core/fields.h"
#include "mapper/output/octomap_file.h"

namespace waretwin {

struct OutputConfig {
  std::string octomap = "auto";

  bool wants_octomap() const { return octomap == "always" || (octomap == "auto" && octomap_available()); }

  void visit(Fields& f) {
    f("octomap", octomap, "octomap.bt: where the program was built with liboctomap-dev; always (refused where it was not); or never",
      {.choices = {"auto", "always", "never"}});
    if (octomap == "always" && !octomap_available())
      f.reject("octomap", "needs a program built with OctoMap; install liboctomap-dev and build again");
  }
};

}  // namespace waretwin

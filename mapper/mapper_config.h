// Every constant of the mapper, in one tree. Defaults of profile `paper` come from the paper's text; `best` changes what it improves.
#pragma once

#include <string>

#include "core/fields.h"

namespace waretwin {

struct MapperConfig {
  void visit(Fields& f);
};

}  // namespace waretwin

// What a page says in words about a run.
#pragma once

#include "harness/report/page_json.h"

namespace waretwin {

// Fills title, subtitle and facts of a run's page from its score or map. Throws nlohmann's exceptions where a value has the wrong type.
void add_facts(Json& page);

}  // namespace waretwin

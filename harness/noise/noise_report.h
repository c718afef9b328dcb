// A noise survey for people and for tools.
#pragma once

#include <string>

#include "harness/noise/noise_survey.h"

namespace waretwin {

// Tables, laws, caveats and a piece of a scenario, as lines of text.
std::string noise_text(const NoiseSurvey& survey);

// The same figures; lengths in metres.
std::string noise_json(const NoiseSurvey& survey);

// Keys of `sensors.cameras.NAME` that give a simulated camera this view and this noise, by the law that fits better (`gaussian` where they
// do about equally well); YAML, indented by `indent` spaces.
std::string noise_yaml(const NoiseSurvey& survey, int indent);

// Whose weighted residuals are smaller: "gaussian", "time_of_flight", or "neither" within a tenth of each other or where there is no law.
std::string better_law(const NoiseSurvey& survey);

}  // namespace waretwin

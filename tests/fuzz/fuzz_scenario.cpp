// Feeds arbitrary text to the scenario reader: it reads it or throws Error.
#include <cstdint>

#include "core/error.h"
#include "scenes/scenario.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  waretwin::Scenario scenario;
  try {
    waretwin::read_config_text(std::string(reinterpret_cast<const char*>(data), size), "input.yaml",
                               [&](waretwin::Fields& f) { scenario.visit(f); });
  } catch (const waretwin::Error&) {
  }
  return 0;
}

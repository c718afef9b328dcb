// A hall that a file of the harness (a suite, a study) has drawn, in place of a scenario.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "scenes/generate/generate_config.h"

namespace waretwin {

// A hall to be drawn, where `style` is named.
struct DrawnHall {
  DrawnHall() { config.style.clear(); }
  generate::GenerateConfig config;
  bool asked_for() const { return !config.style.empty(); }
  bool changed() const;  // whether anything is named
  void visit(Fields& f) { config.visit(f); }
};

// Rejects what names neither a scenario nor a hall to be drawn, or both; keys `scenario` and `generate` of the group being visited.
void check_hall_source(Fields& f, const std::string& scenario, const DrawnHall& drawn);

// Draws it into out/halls/ and returns its folder. One that is there already, of the same program and wishes, is taken as it is; several
// processes may ask for the same one. `check` is called now and then and may throw to stop.
std::filesystem::path draw_hall_once(generate::GenerateConfig config, const std::filesystem::path& out, const std::function<void()>& check);

}  // namespace waretwin

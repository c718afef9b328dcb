#include "sensors/laser_config.h"

#include <numbers>

#include "core/error.h"

namespace waretwin {

void LaserNoise::visit(Fields& f) {
  f("enabled", enabled, "false switches the range error off");
  f("sigma_m", sigma_m, "standard deviation of a range", {.min = 0, .max = 1});
  f("bias_max_m", bias_max_m, "bound of the systematic part, drawn once per run", {.min = 0, .max = 1});
}

LaserConfig LaserConfig::make(const std::string& preset) {
  LaserConfig laser;
  laser.preset = preset;
  if (preset == "sick_s300") return laser;
  if (preset == "ideal") {
    laser.noise.enabled = false;
    laser.range_step_m = 0.0;
    return laser;
  }
  throw Error("laser preset '" + preset + "' is not known; expected sick_s300 or ideal");
}

double LaserConfig::angle_min() const { return -0.5 * to_radians(field_deg); }

double LaserConfig::angle_increment() const { return beams > 1 ? to_radians(field_deg) / (beams - 1) : 0.0; }

Stamp LaserConfig::beam_interval() const { return from_seconds(angle_increment() / (2.0 * std::numbers::pi) / rate_hz); }

void LaserConfig::visit(Fields& f) {
  const std::string before = preset;
  f("preset", preset, "the product whose values the other keys start from", {.choices = {"sick_s300", "ideal"}});
  if (preset != before) {
    const Mount kept = mount;
    *this = make(preset);
    mount = kept;
  }
  f("beams", beams, "beams in a scan", {.min = 1, .max = 100000});
  f("field_deg", field_deg, "angle from the first to the last beam", {.min = 0, .max = 360});
  f("rate_hz", rate_hz, "turns a second", {.min = 0.01, .max = 1000});
  f("range_min_m", range_min_m, "nothing is measured nearer than this", {.min = 0, .max = 1000});
  f("range_max_m", range_max_m, "nothing is measured beyond this", {.min = 0.001, .max = 1000});
  if (range_max_m <= range_min_m) f.reject("range_max_m", "must be greater than range_min_m");
  f("range_step_m", range_step_m, "resolution of the output; 0 = none", {.min = 0, .max = 1});
  f.group("noise", noise, "error of a range");
  f.group("mount", mount, "place on the vehicle");
}

}  // namespace waretwin

#include "sensors/laser_config.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/error.h"

namespace waretwin {

void LaserNoise::visit(Fields& f) {
  f("enabled", enabled, "false switches the range error off");
  f("sigma_m", sigma_m, "standard deviation of a range", {.min = 0, .max = 1});
  f("sigma_far_m", sigma_far_m, "standard deviation at the farthest range", {.min = 0, .max = 1});
  f("grows_from_m", grows_from_m, "up to here the standard deviation is sigma_m, then it grows evenly", {.min = 0, .max = 1000});
  f("bias_max_m", bias_max_m, "bound of the systematic part, drawn once per run", {.min = 0, .max = 1});
}

double LaserNoise::deviation(double range, double range_max) const {
  if (range <= grows_from_m || range_max <= grows_from_m) return sigma_m;
  return sigma_m + (sigma_far_m - sigma_m) * std::min((range - grows_from_m) / (range_max - grows_from_m), 1.0);
}

void LaserSpot::visit(Fields& f) {
  f("mixed", mixed, "false: a beam without width");
  f("dropouts", dropouts, "false: every surface is bright enough");
  f("diameter_m", diameter_m, "width of the beam at the scanner", {.min = 0, .max = 1});
  f("divergence_rad", divergence_rad, "how it widens", {.min = 0, .max = 0.5});
  f("merge_m", merge_m, "echoes nearer to each other than this become one", {.min = 0, .max = 10});
  f("min_signal", min_signal, "weaker echoes are not seen", {.min = 0, .max = 100});
  f("retroreflectors", retroreflectors, "false: retroreflectors read true ranges");
  f("retro_shift_m", retro_shift_m, "how much too short they read at most", {.min = 0, .max = 10});
  f("retro_least_signal", retro_least_signal, "signal of a retroreflector from which on it reads short", {.min = 1e-6, .max = 1e6});
  f("retro_full_signal", retro_full_signal, "signal at which it reads short by retro_shift_m", {.min = 1e-6, .max = 1e6});
  if (retro_full_signal <= retro_least_signal) f.reject("retro_full_signal", "must be greater than retro_least_signal");
  f("masked_deg", masked_deg, "blind sectors where the vehicle itself stands: from, to, from, to ...", {.min = -360, .max = 360});
  if (masked_deg.size() % 2 != 0) f.reject("masked_deg", "must hold pairs of angles, from and to");
}

bool LaserSpot::masks(double angle) const {
  const double deg = to_degrees(angle);
  for (std::size_t i = 0; i + 1 < masked_deg.size(); i += 2) {
    if (deg >= masked_deg[i] && deg <= masked_deg[i + 1]) return true;
  }
  return false;
}

double LaserSpot::retro_shift(double signal) const {
  if (!retroreflectors || !(signal > retro_least_signal)) return 0.0;
  return retro_shift_m * std::min(std::log(signal / retro_least_signal) / std::log(retro_full_signal / retro_least_signal), 1.0);
}

namespace {

const std::vector<std::string>& presets() {
  static const std::vector<std::string> names = {"sick_s300", "sick_tim571", "hokuyo_utm30lx", "ideal"};
  return names;
}

}  // namespace

LaserConfig LaserConfig::make(const std::string& preset) {
  LaserConfig laser;
  laser.preset = preset;
  if (preset == "sick_s300") return laser;
  if (preset == "sick_tim571") {
    // Data sheet of the TiM5xx long range (SICK, product family TiM5xx; 8015886 for the TiM561): 270 deg in steps of 0.33 deg, 15 Hz, 0.05
    // to 25 m, systematic error +-60 mm, statistical error 20 mm at one sigma. It names no larger error at reflectors.
    // Its sibling's spot is 7 mm + 14.4 mrad x distance wide and 8.6 mrad high (operating instructions TiM3xx, 8024851, section 3.6.4).
    laser.beams = 811;
    laser.rate_hz = 15.0;
    laser.range_max_m = 25.0;
    laser.range_step_m = 0.001;
    laser.noise = {.enabled = true, .sigma_m = 0.02, .bias_max_m = 0.06, .sigma_far_m = 0.02};
    laser.spot.diameter_m = 0.007;
    laser.spot.divergence_rad = 0.0144;
    laser.spot.retro_shift_m = 0.06;
    return laser;
  }
  if (preset == "hokuyo_utm30lx") {
    // Data sheet (Hokuyo UTM-30LX specification): 270 deg in steps of 0.25 deg, 25 ms a scan, 0.1 to 30 m, steps of 1 mm;
    // accuracy +-30 mm up to 10 m and +-50 mm up to 30 m, repeated accuracy (one sigma) 10 mm and 30 mm. What the accuracy leaves
    // beside the repeated one is 20 mm in both ranges: the systematic part. It names no larger error at reflectors.
    laser.beams = 1081;
    laser.rate_hz = 40.0;
    laser.range_min_m = 0.1;
    laser.range_step_m = 0.001;
    laser.noise = {.enabled = true, .sigma_m = 0.01, .bias_max_m = 0.02, .sigma_far_m = 0.03, .grows_from_m = 10.0};
    laser.spot.retro_shift_m = 0.03;
    return laser;
  }
  if (preset == "ideal") {
    laser.noise.enabled = false;
    laser.spot.mixed = laser.spot.dropouts = laser.spot.retroreflectors = false;
    laser.range_step_m = 0.0;
    return laser;
  }
  throw Error("laser preset '" + preset + "' is not known; expected sick_s300, sick_tim571, hokuyo_utm30lx or ideal");
}

double LaserConfig::angle_min() const { return -0.5 * to_radians(field_deg); }

double LaserConfig::angle_increment() const { return beams > 1 ? to_radians(field_deg) / (beams - 1) : 0.0; }

Stamp LaserConfig::beam_interval() const { return from_seconds(angle_increment() / (2.0 * std::numbers::pi) / rate_hz); }

void LaserConfig::visit(Fields& f) {
  const std::string before = preset;
  f("preset", preset, "the product whose values the other keys start from", {.choices = presets()});
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
  f.group("spot", spot, "light of a beam");
  f.group("noise", noise, "error of a range");
  f.group("mount", mount, "place on the vehicle");
}

}  // namespace waretwin

#include "harness/noise/noise_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/pose.h"
#include "core/version.h"

namespace waretwin {

namespace {

using Json = nlohmann::ordered_json;

// Beyond this, neighbours are not measured independently.
constexpr double kCorrelated = 0.1;
constexpr int kNoiseSchema = 1;
// Share of missing pixels below which depth counts as filling the picture.
constexpr double kWholePicture = 0.25;

template <class... Values>
std::string line(const char* pattern, Values... values) {
  char buffer[400];
  std::snprintf(buffer, sizeof buffer, pattern, values...);
  return buffer;
}

std::string interval_mm(const Estimate& e, const char* unit) {
  return line("%.3f %s (95 %%: %.3f to %.3f)", 1e3 * e.value, unit, 1e3 * e.low, 1e3 * e.high);
}

Json estimate_json(const Estimate& e) { return {{"value", e.value}, {"low", e.low}, {"high", e.high}}; }

std::string number(double value) { return line("%.4g", value); }

std::string table(const NoiseSurvey& survey) {
  std::string text = "  range (m)   incidence (deg)  patches  sigma_z (mm)  95 %           sigma_r (mm)  95 %\n";
  for (const NoiseCell& c : survey.cells) {
    text += line("  %4.2f-%4.2f   %3.0f-%-3.0f        %9d    %8.2f    %5.2f-%-5.2f      %8.2f    %5.2f-%.2f\n", c.range_from_m,
                 c.range_to_m, c.incidence_from_deg, c.incidence_to_deg, c.patches, 1e3 * c.sigma_z.value, 1e3 * c.sigma_z.low,
                 1e3 * c.sigma_z.high, 1e3 * c.sigma_r.value, 1e3 * c.sigma_r.low, 1e3 * c.sigma_r.high);
  }
  return text;
}

std::string laws(const NoiseSurvey& survey) {
  std::string text;
  if (const auto& law = survey.gaussian) {
    text += "gaussian law, sigma_z = base + growth * z^2\n  base   " + interval_mm(law->base_m, "mm") + "\n  growth " +
            interval_mm(law->growth_per_m, "mm/m^2") + "\n" +
            line("  cells lie %.1f %% off it (rms), weighted residuals %.2f\n", 100 * law->relative_rms, law->misfit);
    if (law->at_limit) text += "  the best fit had a negative number; it was set to 0\n";
  } else {
    text += "gaussian law: not determined, the planes lie at too few distances\n";
  }
  if (const auto& law = survey.time_of_flight) {
    text +=
        "time-of-flight law, sigma_r = noise_m * sqrt(s + background) / s, s = illumination * reflectivity * cos(incidence) / r^2\n  "
        "noise_m " +
        interval_mm(law->noise_m, "mm") +
        line(" at reflectivity %s, illumination %s, background %s\n", number(survey.config.reflectivity).c_str(),
             number(survey.config.illumination).c_str(), number(survey.config.background).c_str()) +
        line("  cells lie %.1f %% off it (rms), weighted residuals %.2f\n", 100 * law->relative_rms, law->misfit);
  } else {
    text += "time-of-flight law: not determined, the planes lie at too few distances\n";
  }
  const std::string better = better_law(survey);
  if (better != "neither") text += "the " + std::string(better == "gaussian" ? "gaussian" : "time-of-flight") + " law fits better\n";
  if (better == "neither" && survey.gaussian && survey.time_of_flight) text += "both laws fit about equally well\n";
  return text;
}

std::string caveats(const NoiseSurvey& survey) {
  std::string text;
  if (survey.correlation > kCorrelated) {
    text += line("neighbouring readings err alike (correlation %.2f): ", survey.correlation);
    text += survey.native
                ? "the camera smooths its depth; noise from one reading to the next is smaller than that of a single reading\n"
                : "this depth is interpolated, smoothed or quantised, so that its scatter about a plane is smaller than the noise of a "
                  "reading; record the depth camera's own images (depth_native.txt) where you can\n";
  } else {
    text += line("neighbouring readings err independently (correlation %.2f)\n", survey.correlation);
  }
  text += "a cell is its median patch: with several materials it stands for the typical one, dark ones are noisier\n";
  return text;
}

}  // namespace

std::string better_law(const NoiseSurvey& survey) {
  if (!survey.gaussian || !survey.time_of_flight)
    return survey.gaussian ? "gaussian" : survey.time_of_flight ? "time_of_flight" : "neither";
  const double a = survey.gaussian->misfit, b = survey.time_of_flight->misfit;
  if (std::abs(a - b) <= 0.1 * std::max(a, b)) return "neither";
  return a < b ? "gaussian" : "time_of_flight";
}

std::string noise_yaml(const NoiseSurvey& survey, int indent) {
  const std::string space(static_cast<std::size_t>(indent), ' ');
  const Intrinsics& k = survey.calibration.intrinsics;
  const auto view_deg = [](int pixels, double focal) { return to_degrees(2.0 * std::atan(0.5 * pixels / focal)); };
  const bool light = better_law(survey) == "time_of_flight";
  std::string text = space + line("width: %d\n", k.width) + space + line("height: %d\n", k.height) + space +
                     line("horizontal_fov_deg: %.2f\n", view_deg(k.width, k.fx)) + space +
                     line("vertical_fov_deg: %.2f\n", view_deg(k.height, k.fy)) + space +
                     "depth_min_m: " + number(survey.calibration.depth_min_m) + "\n" + space +
                     "depth_max_m: " + number(survey.calibration.depth_max_m) + "\n";
  if (light) {
    text += space + "depth_model: time_of_flight\n" + space + "time_of_flight: {noise_m: " + number(survey.time_of_flight->noise_m.value) +
            ", background: " + number(survey.config.background) + ", illumination: " + number(survey.config.illumination) + "}\n";
  } else if (survey.gaussian) {
    // Depth all over the picture is no illuminated outline, as that of the presets is.
    if (survey.missing_share < kWholePicture) {
      text += space + "field: {shape: rectangle, horizontal_deg: 179, vertical_deg: 179, tilt_down_deg: 0}\n";
    }
    text += space + "depth_model: gaussian\n" + space + "noise: {sigma_base_m: " + number(survey.gaussian->base_m.value) +
            ", sigma_per_m2: " + number(survey.gaussian->growth_per_m.value) + ", dropout_share: " + number(survey.planar_missing_share) +
            "}\n";
  }
  return text;
}

std::string noise_text(const NoiseSurvey& survey) {
  const PatchCounts& n = survey.patches;
  std::string text =
      "noise of " + survey.source + ", camera " + survey.camera + line(": %d of %d frames, ", survey.used_frames, survey.frames) +
      (survey.native ? "the depth camera's own images" : "depth in the colour view") + line(" (%d x %d)\n", survey.width, survey.height);
  text += line(
      "%ld patches of %d x %d pixels, %ld of them planes; the others: %ld with too few readings, %ld edges or curves, %ld too grazing, "
      "%ld outside the trusted range\n\n",
      n.looked_at, survey.config.patch_px, survey.config.patch_px, n.planar, n.few_readings, n.structured, n.grazing, n.out_of_range);
  text +=
      "scatter about the plane, along the optical axis (z) and along the rays (r), without the rounding to millimetres\n" + table(survey);
  text += "\n" + laws(survey) + caveats(survey);
  text += line("\npixels without a reading: %.2f %% of all, %.2f %% on planes; by range\n", 100 * survey.missing_share,
               100 * survey.planar_missing_share);
  for (const MissingByRange& row : survey.missing) text += line("  %4.2f-%4.2f m  %6.2f %%\n", row.from_m, row.to_m, 100 * row.share());
  if (survey.gaussian || survey.time_of_flight) {
    text += "\nfor a scenario:\nsensors:\n  cameras:\n    " + survey.camera + ":\n" + noise_yaml(survey, 6);
  }
  return text;
}

std::string noise_json(const NoiseSurvey& survey) {
  const PatchCounts& n = survey.patches;
  Json json;
  json["schema"] = kNoiseSchema;
  json["version"] = kVersion;
  json["source"] = survey.source;
  json["camera"] = survey.camera;
  json["view"] = survey.native ? "native" : "registered";
  json["width"] = survey.width;
  json["height"] = survey.height;
  json["frames"] = survey.frames;
  json["used_frames"] = survey.used_frames;
  json["patch_px"] = survey.config.patch_px;
  json["patches"] = {{"looked_at", n.looked_at},   {"planar", n.planar},   {"few_readings", n.few_readings},
                     {"structured", n.structured}, {"grazing", n.grazing}, {"out_of_range", n.out_of_range}};
  json["correlation"] = survey.correlation;
  json["missing_share"] = survey.missing_share;
  json["planar_missing_share"] = survey.planar_missing_share;
  json["missing_by_range"] = Json::array();
  for (const MissingByRange& row : survey.missing) {
    json["missing_by_range"].push_back({{"from_m", row.from_m}, {"to_m", row.to_m}, {"pixels", row.pixels}, {"share", row.share()}});
  }
  json["cells"] = Json::array();
  for (const NoiseCell& cell : survey.cells) {
    json["cells"].push_back({{"range_from_m", cell.range_from_m},
                             {"range_to_m", cell.range_to_m},
                             {"incidence_from_deg", cell.incidence_from_deg},
                             {"incidence_to_deg", cell.incidence_to_deg},
                             {"patches", cell.patches},
                             {"depth_m", cell.depth_m},
                             {"sigma_z_m", estimate_json(cell.sigma_z)},
                             {"sigma_r_m", estimate_json(cell.sigma_r)}});
  }
  json["gaussian"] = nullptr;
  if (const auto& law = survey.gaussian) {
    json["gaussian"] = {{"sigma_base_m", estimate_json(law->base_m)},
                        {"sigma_per_m2", estimate_json(law->growth_per_m)},
                        {"at_limit", law->at_limit},
                        {"misfit", law->misfit},
                        {"relative_rms", law->relative_rms}};
  }
  json["time_of_flight"] = nullptr;
  if (const auto& law = survey.time_of_flight) {
    json["time_of_flight"] = {{"noise_m", estimate_json(law->noise_m)},
                              {"reflectivity", survey.config.reflectivity},
                              {"illumination", survey.config.illumination},
                              {"background", survey.config.background},
                              {"misfit", law->misfit},
                              {"relative_rms", law->relative_rms}};
  }
  json["better_law"] = better_law(survey);
  return json.dump(2) + "\n";
}

}  // namespace waretwin

#include "harness/report/run_facts.h"

#include <cstdio>
#include <filesystem>
#include <string>

namespace waretwin {

namespace {

std::string text(const char* pattern, double value) {
  char buffer[96];
  std::snprintf(buffer, sizeof buffer, pattern, value);
  return buffer;
}

// The value under a key; null where there is none.
Json get(const Json& json, const char* key) { return json.is_object() && json.contains(key) ? json.at(key) : Json(nullptr); }

std::string count(const Json& json, const char* key) {
  const Json value = get(json, key);
  return value.is_number() ? std::to_string(value.get<long long>()) : "?";
}

void add_rejected(Json& facts, const Json& of) {
  const Json rejected = get(of, "rejected");
  if (!rejected.is_object()) return;
  for (const auto& [reason, times] : rejected.items())
    facts.push_back("Not segmented: " + reason + ", " + std::to_string(times.get<long long>()) + " times");
}

void add_run_facts(Json& page, const Json& score) {
  page["title"] = score.value("scenario", "a run");
  page["subtitle"] = "profile " + score.value("profile", "?") + ", seed " + count(score, "seed") + ", digest " + score.value("digest", "?");
  Json& facts = page["facts"];
  const Json stages = get(score, "stages");
  if (stages.is_object()) {
    std::string line;
    for (const auto& [stage, maker] : stages.items()) line += (line.empty() ? "Stages: " : ", ") + stage + " " + maker.get<std::string>();
    facts.push_back(line);
  }
  const Json frames = get(score, "frames");
  if (frames.is_object())
    facts.push_back(count(frames, "simulated") + " camera frames, " + count(frames, "mapped") + " mapped, " + count(frames, "dropped") +
                    " dropped to keep the mapping rate");
  if (get(score, "realtime_factor").is_number() && get(score, "peak_rss_mb").is_number())
    facts.push_back(text("%.2f times real time", score["realtime_factor"]) + text(", at most %.0f MB of memory", score["peak_rss_mb"]));
  const Json trajectory = get(score, "trajectory");
  if (trajectory.is_object()) {
    std::string line =
        text("Trajectory error %.3f m rmse", trajectory.at("ate_rmse_m")) + text(", %.3f m at most", trajectory.at("ate_max_m"));
    if (get(trajectory, "ate_aligned_rmse_m").is_number())
      line += text("; %.3f m rmse after SE(3) alignment", trajectory["ate_aligned_rmse_m"]);
    facts.push_back(line);
  }
  const Json surface = get(score, "surface");
  if (surface.is_object())
    facts.push_back(text("Mapped surface %.1f mm from the true one", 1e3 * surface.at("median_m").get<double>()) +
                    text(" in the median, %.1f mm at 95 %%", 1e3 * surface.at("p95_m").get<double>()) +
                    text("; %.1f %% of what was seen is mapped", 100.0 * surface.at("found").get<double>()));
  add_rejected(facts, score);
  const Json motion = get(score, "motion");
  if (motion.is_object()) {
    for (const Json& contact : get(motion, "contacts")) {
      facts.push_back("Error: the vehicle touched " + contact.at("with").get<std::string>() + text(" at %.2f s", contact.at("begin_s")) +
                      text(" near (%.2f", contact.at("x_m")) + text(", %.2f)", contact.at("y_m")));
    }
  }
}

void add_map_facts(Json& page, const Json& map) {
  const std::string source = map.value("source", "a recording");
  // A folder may be named with a slash at its end.
  const std::filesystem::path whole = source.ends_with('/') ? source.substr(0, source.size() - 1) : source;
  page["title"] = "map of " + whole.filename().string();
  page["subtitle"] = "profile " + map.value("profile", "?") + ", digest " + map.value("digest", "?");
  Json& facts = page["facts"];
  facts.push_back("Recording: " + source);
  const Json frames = get(map, "frames");
  if (frames.is_object()) {
    facts.push_back(count(frames, "seen") + " camera frames, " + count(frames, "mapped") + " mapped, " + count(frames, "without_pose") +
                    " without a pose");
  }
  if (get(map, "scans").is_number())
    facts.push_back(count(map, "scans") + " scans, no camera: the trajectory alone, as poses of the laser (X_WL)");
  add_rejected(facts, map);
}

}  // namespace

void add_facts(Json& page) {
  if (page["score"].is_object()) {
    add_run_facts(page, page["score"]);
  } else if (page["map"].is_object()) {
    add_map_facts(page, page["map"]);
  } else {
    page["title"] = "a map";
  }
}

}  // namespace waretwin

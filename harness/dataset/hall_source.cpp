#include "harness/dataset/hall_source.h"

#include <unistd.h>

#include <algorithm>
#include <optional>
#include <set>

#include "core/digest.h"
#include "core/error.h"
#include "core/files.h"
#include "core/random.h"
#include "harness/units/units.h"
#include "scenes/generate/generator.h"
#include "scenes/generate/hall_files.h"
#include "scenes/generate/home.h"

namespace waretwin {

namespace fs = std::filesystem;

namespace {

class ScenarioSource final : public HallSource {
 public:
  ScenarioSource(const fs::path& file, const std::vector<Setting>& settings) {
    hall_.scenario = load_scenario(file, settings);
    if (hall_.scenario.sensors.cameras.empty()) throw Error(file, "has no camera to take pictures with (sensors.cameras)");
    hall_.name = hall_.scenario.name;
    hall_.scene = std::make_shared<const Scene>(build_scene(hall_.scenario));
    Digest digest;
    digest.add(read_file(file));
    for (const Setting& setting : settings) digest.add(setting.key + "=" + setting.value);
    add_scene(*hall_.scene, digest);
    description_ = "scenario " + hall_.name + " " + digest.hex();
  }
  Hall hall(std::uint64_t) const override { return hall_; }
  std::vector<std::string> classes() const override {
    std::set<std::string> names;
    for (const TrueObject& object : hall_.scene->objects) names.insert(object.class_name);
    return {names.begin(), names.end()};
  }
  std::vector<std::string> cameras() const override {
    std::vector<std::string> names;
    for (const auto& entry : hall_.scenario.sensors.cameras) names.push_back(entry.first);
    return names;
  }
  std::string description() const override { return description_; }

 private:
  Hall hall_;
  std::string description_;
};

// A folder for one hall's files, gone with it.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (fs::temp_directory_path() / "waretwin-hall-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw Error(fs::temp_directory_path(), "no folder can be made here for a hall");
    path_ = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

class GeneratedSource final : public HallSource {
 public:
  GeneratedSource(std::string style, std::uint64_t seed, std::vector<Setting> settings)
      : style_(std::move(style)), seed_(seed), settings_(std::move(settings)) {
    // Mistakes are found before anything is made.
    Scenario like_any;
    like_any.models.emplace_back().file = "hall.glb";
    like_any.robot.route.emplace_back();
    like_any.sensors = SensorsConfig::of_the_paper();
    apply_settings(settings_, [&](Fields& f) { like_any.visit(f); });
  }

  Hall hall(std::uint64_t number) const override {
    generate::GenerateConfig config;
    config.style = style_;
    const auto words = RandomStream(seed_, "dataset", "hall." + style_).words(number);
    config.seed = words[0];
    config.coverage = 0.0;
    const generate::Generator generator(config);
    constexpr int kMostDraws = 30;
    for (int draw = 0; draw < kMostDraws; ++draw) {
      const std::optional<generate::HallPlan> plan = generator.draw(draw);
      if (!plan) continue;
      const ScratchFolder folder;
      write_file(folder.path() / "hall.glb", generate::build_glb(*plan));
      write_file(folder.path() / "scenario.yaml", generate::scenario_text(*plan, config.seed));
      Hall hall;
      hall.scenario = load_scenario(folder.path() / "scenario.yaml", settings_);
      hall.scene = std::make_shared<const Scene>(build_scene(hall.scenario));
      hall.name = style_ + " " + std::to_string(config.seed);
      return hall;
    }
    throw InternalError("no hall of style " + style_ + " in " + std::to_string(kMostDraws) + " draws of seed " +
                        std::to_string(config.seed));
  }
  // What the parts of scenes/builder name their conveyors, and the generator its furniture.
  std::vector<std::string> classes() const override {
    return style_ == "home" ? generate::home_classes() : std::vector<std::string>{"conveyor"};
  }
  // What generate::scenario_text gives every hall.
  std::vector<std::string> cameras() const override { return {"camera"}; }
  std::string description() const override {
    std::string text = "generate " + style_;
    for (const Setting& setting : settings_) text += " " + setting.key + "=" + setting.value;
    return text;
  }

 private:
  std::string style_;
  std::uint64_t seed_;
  std::vector<Setting> settings_;
};

}  // namespace

std::unique_ptr<HallSource> scenario_source(const fs::path& file, const std::vector<Setting>& settings) {
  return std::make_unique<ScenarioSource>(file, settings);
}

std::unique_ptr<HallSource> generated_source(const std::string& style, std::uint64_t seed, const std::vector<Setting>& settings) {
  return std::make_unique<GeneratedSource>(style, seed, settings);
}

}  // namespace waretwin

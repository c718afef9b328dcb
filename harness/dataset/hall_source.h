// The halls that training pictures are taken in: scenarios from files, and halls drawn on the fly.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/config.h"
#include "scenes/scenario.h"
#include "scenes/scene.h"

namespace waretwin {

// One hall as it stands before anything is varied.
struct Hall {
  std::string name;
  Scenario scenario;
  std::shared_ptr<const Scene> scene;
};

class HallSource {
 public:
  virtual ~HallSource() = default;
  // The same number gives the same hall; may be called from any thread.
  virtual Hall hall(std::uint64_t number) const = 0;
  // Of the objects in it.
  virtual std::vector<std::string> classes() const = 0;
  // Names of those that could take the pictures.
  virtual std::vector<std::string> cameras() const = 0;
  // What it is, equal exactly where its halls are, without names of folders.
  virtual std::string description() const = 0;
};

// A scenario file with its models; always the same hall. Throws Error as load_scenario and build_scene do, and where it has no camera.
std::unique_ptr<HallSource> scenario_source(const std::filesystem::path& file, const std::vector<Setting>& settings);

// A random hall of a style (scenes/generate) for each number. Routes need not show every object.
std::unique_ptr<HallSource> generated_source(const std::string& style, std::uint64_t seed, const std::vector<Setting>& settings);

}  // namespace waretwin

// Work that is split over processes: each unit's result is written once, under a name made of what the result depends on. So killed,
// repeated and overlapping shards lose nothing and do nothing twice, and whoever finds all units can put them together.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "core/digest.h"
#include "scenes/scene.h"

namespace waretwin {

// Which part of the work this process does: the units whose number leaves `index` when divided by `count`.
struct Shard {
  int index = 0, count = 1;
  bool has(int unit) const { return unit % count == index; }
  int size(int units) const { return (units - index + count - 1) / count; }  // how many of so many it has
};
// "I/N", I from 0. Throws Error for anything else.
Shard parse_shard(const std::string& text);

// What the program is: its file's bytes, and the shared libraries by name and size.
const std::string& program_identity();
// What kind of CPU this is, by which kernels are picked that differ in last bits. A unit made on another is as good for a table, but the
// same machine would not make the same bytes again.
std::string cpu_identity();

// Adds what the models became, whatever files they came from: all that rays meet, and the true objects.
void add_scene(const Scene& scene, Digest& digest);
std::string digest_of(const Scene& scene);

class UnitStore {
 public:
  // Makes the folder. Throws Error where that cannot be.
  explicit UnitStore(const std::filesystem::path& folder);
  // Nothing where the unit is not done.
  std::optional<std::string> result(const std::string& name) const;
  // Atomic.
  void write(const std::string& name, std::string_view result) const;

  std::filesystem::path file(const std::string& name) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace waretwin

#include "harness/score/scenenn_sequences.h"

#include <functional>
#include <set>

#include "core/error.h"
#include "core/own_name.h"
#include "harness/score/truth_file.h"

namespace waretwin {

namespace {

namespace fs = std::filesystem;

constexpr const char* kMapName = "cuboids.json";
constexpr const char* kTruthName = "truth.json";

bool there(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

bool is_folder(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

// Names of the folders in `folder` of which `holds` says yes.
std::set<std::string> folders_that(const fs::path& folder, const std::function<bool(const fs::path&)>& holds) {
  std::set<std::string> found;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    if (is_folder(at->path()) && holds(at->path())) found.insert(at->path().filename().string());
  }
  if (error) throw Error(folder, "cannot be read: " + error.message());
  return found;
}

// The map's folder, or its own name where it has one.
std::string name_of(const fs::path& map_file) {
  return map_file.filename() == kMapName ? own_name(map_file.parent_path()) : map_file.stem().string();
}

MappedSequence read_sequence(const std::string& name, const fs::path& map_file, const fs::path& truth_file) {
  MappedSequence sequence{name, read_object_list(map_file), read_truth(truth_file, map_file.parent_path()), std::nullopt};
  for (const ListedObject& mapped : sequence.mapped) {
    if (sequence.truth.empty() || mapped.cuboid.frame == sequence.truth.front().cuboid.frame) continue;
    throw Error(map_file, "is in frame '" + mapped.cuboid.frame + "'; expected '" + sequence.truth.front().cuboid.frame + "' as in " +
                              truth_file.string());
  }
  const fs::path times = map_file.parent_path() / "timing.csv";
  if (map_file.filename() == kMapName && there(times)) sequence.times = read_stage_times(times);
  return sequence;
}

}  // namespace

std::vector<MappedSequence> read_sequences(const fs::path& map, const fs::path& truth) {
  for (const fs::path& path : {map, truth}) {
    if (!there(path)) throw Error(path, "does not exist; expected an object list, a run's folder or a folder of these");
  }
  if (!is_folder(map) || there(map / kMapName)) {
    const fs::path map_file = file_or_in_folder(map, kMapName);
    return {read_sequence(name_of(map_file), map_file, truth_file(truth))};
  }
  const std::set<std::string> maps = folders_that(map, [](const fs::path& folder) { return there(folder / kMapName); });
  if (maps.empty()) throw Error(map, "holds neither " + std::string(kMapName) + " nor folders with one");
  if (!is_folder(truth)) {
    throw Error(truth, "is one file, but " + map.string() + " holds a folder for each of " + std::to_string(maps.size()) +
                           " sequences; expected a folder of such folders with " + kTruthName);
  }
  for (const std::string& name : folders_that(truth, has_truth)) {
    if (!maps.contains(name)) throw Error(map / name / kMapName, "does not exist; sequence '" + name + "' has a truth, expected its map");
  }
  std::vector<MappedSequence> sequences;
  for (const std::string& name : maps) {
    if (!has_truth(truth / name))
      throw Error(truth / name / kTruthName, "does not exist; sequence '" + name + "' has a map, expected its truth");
    sequences.push_back(read_sequence(name, map / name / kMapName, truth_file(truth / name)));
  }
  return sequences;
}

}  // namespace waretwin

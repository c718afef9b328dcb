#include "harness/units/run_unit.h"

#include <algorithm>
#include <filesystem>
#include <vector>

#include "core/error.h"
#include "core/files.h"
#include "harness/units/units.h"
#include "mapper/detect/model_files.h"
#include "mapper/detect/shipped_models.h"

namespace waretwin {

namespace fs = std::filesystem;

namespace {

// Names within a folder count, for they are what the command knows its files by.
void add_folder(const fs::path& folder, Digest& digest) {
  std::vector<fs::path> files;
  try {
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      if (entry.is_regular_file()) files.push_back(entry.path().lexically_relative(folder));
    }
  } catch (const fs::filesystem_error& error) {
    throw Error(folder, "cannot be read: " + error.code().message());
  }
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {
    digest.add(file.string());
    digest.add(read_file(folder / file));
  }
}

void add_dependencies(const ExternalMapper& mapper, Digest& digest) {
  for (const fs::path file : mapper.depends) {
    if (fs::is_directory(file)) {
      add_folder(file, digest);
    } else {
      digest.add(read_file(file));
    }
  }
}

void add_detector(const RunConfig& config, Digest& digest) {
  if (config.truth_stages.detector || config.external_mapper.used()) return;
  if (config.mapper.detector == "yolo") {
    const ModelFiles files = find_model_files(model_or_shipped(config.mapper.model), config.mapper.detect.names);
    for (const fs::path& file : {files.cfg, files.weights, files.onnx, files.names}) {
      if (!file.empty()) digest.add(read_file(file));
    }
  }
  if (config.mapper.detector == "boxes") digest.add(read_file(config.mapper.boxes));
}

}  // namespace

void add_run(const RunConfig& config, const std::string& scene, Digest& digest) {
  RunConfig without_names = config;
  without_names.mapper.model.clear();
  without_names.mapper.boxes.clear();
  without_names.mapper.detect.names.clear();
  without_names.resume.clear();
  without_names.extrinsics.clear();
  without_names.external_mapper.depends.clear();
  without_names.scenario.robot.model.clear();  // what is in it stands in the scene
  digest.add(write_config([&](Fields& f) { without_names.visit(f); }));
  digest.add(scene);
  add_detector(config, digest);
  add_dependencies(config.external_mapper, digest);
  if (!config.resume.empty()) digest.add(read_file(config.resume));
  if (!config.extrinsics.empty()) digest.add(read_file(config.extrinsics));
}

}  // namespace waretwin

#include "harness/units/run_unit.h"

#include <filesystem>

#include "core/files.h"
#include "harness/units/dependencies.h"
#include "harness/units/units.h"
#include "mapper/detect/model_files.h"
#include "mapper/detect/shipped_models.h"

namespace waretwin {

namespace fs = std::filesystem;

namespace {

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
  // What a suite says of another mapper for all its runs says nothing of one that is mapped by ours.
  if (!config.external_mapper.used()) without_names.external_mapper = {};
  without_names.scenario.robot.model.clear();  // what is in it stands in the scene
  digest.add(write_config([&](Fields& f) { without_names.visit(f); }));
  digest.add(scene);
  add_detector(config, digest);
  if (config.external_mapper.used()) add_dependencies(config.external_mapper.depends, digest);
  if (!config.resume.empty()) digest.add(read_file(config.resume));
  if (!config.extrinsics.empty()) digest.add(read_file(config.extrinsics));
}

}  // namespace waretwin

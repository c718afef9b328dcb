#include "harness/run/run_config.h"

#include "core/version.h"

namespace waretwin {

namespace fs = std::filesystem;

namespace {

void visit_version(Fields& f, std::string& version) { f("version", version, "of the program that made this"); }

}  // namespace

void TruthStages::visit(Fields& f) {
  f("detector", detector, "true boxes in place of the detector");
  f("poses", poses, "true poses in place of localisation");
  f("association", association, "true identities in place of association");
}

void RunExtras::visit(Fields& f) {
  f("pictures", pictures, "keeps pictures of frames");
  f("depth", depth, "measures the depth's error");
  f("surface", surface, "measures the mesh against the hall");
  f("visible_share", visible_share, "measures how much of each true object the frames saw; without it all are taken for seen");
}

void RunConfig::visit(Fields& f) {
  scenario.visit(f);
  f.group("mapper", mapper, "the mapper");
  f.group("simulation", simulation, "how the sensors are simulated");
  f.group("truth_stages", truth_stages, "stages that the truth stands in for");
  f.group("truth_detector", truth_detector, "which objects get a true box");
  f.group("truth_frames", truth_frames, "the truth of mapped frames");
  f.group("detection_score", detection_score, "how detections are compared with what the mapped frames show");
  f.group("score", score, "how map and truth are compared");
  f.group("extras", extras, "what is measured beside the map");
  f.group("output", output, "files that are written where they can be");
  f.group("external_mapper", external_mapper, "another mapper in place of ours (run --mapper)");
  f.group("bag", bag, "how a ROS bag is written (record, run --mapper)");
  f("resume", resume, "the map.waretwin to go on from; empty: a new map");
  f("extrinsics", extrinsics, "a calibration that says where the mapper takes the camera to sit; empty: where its bracket is drawn");
}

RunConfig load_run_config(const fs::path& scenario, RunConfig base, const fs::path& config, const std::vector<Setting>& settings) {
  base.scenario = load_scenario(scenario);
  const auto visit = [&](Fields& f) { base.visit(f); };
  if (!config.empty()) {
    read_resolved_config(config, visit);
    // Placements that the file added must know the scenario's folder to judge their models; see load_scenario.
    for (ModelPlacement& placement : base.scenario.models) placement.folder = scenario.has_parent_path() ? scenario.parent_path() : ".";
    read_resolved_config(config, visit);
  }
  if (!settings.empty()) apply_settings(settings, visit);
  return base;
}

std::string resolved_config(const VisitFunction& visit, const std::string& source) {
  return "# waretwin " + std::string(kVersion) + ", " + source + "\n" + write_config([&](Fields& f) {
           std::string version = kVersion;
           visit_version(f, version);
           visit(f);
         });
}

void read_resolved_config(const fs::path& file, const VisitFunction& visit) {
  const auto versioned = [&](Fields& f) {
    std::string version = kVersion;
    visit_version(f, version);
    visit(f);
  };
  read_config(file, versioned, Completeness::kPartial);
}

}  // namespace waretwin

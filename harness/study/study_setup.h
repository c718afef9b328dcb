// A study's candidates with their configurations: all that can be refused before anything is driven.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/config.h"
#include "harness/run/run_config.h"
#include "harness/study/coverage.h"
#include "harness/study/design.h"
#include "harness/study/study_config.h"

namespace waretwin {

// A hall as some candidates have it: the same models, lights and vehicle.
struct SharedHall {
  std::shared_ptr<const Scene> scene;
  std::string digest;  // of the scene

  // Made when first asked for.
  std::shared_ptr<RayCaster> caster();
  std::shared_ptr<const RayCaster> own_body();
  const CoverageHall& coverage(const RobotConfig& baseline_robot, const CoverageConfig& config);

 private:
  std::shared_ptr<RayCaster> caster_;
  std::shared_ptr<const RayCaster> own_body_;
  bool own_body_made_ = false;
  std::map<std::string, std::unique_ptr<CoverageHall>> coverage_;  // by the robot's size
};

// One candidate in one hall; the seed is still the scenario's.
struct CandidateInHall {
  std::string hall;
  RunConfig config;
  std::shared_ptr<SharedHall> shared;
  RobotConfig baseline_robot;  // whose size says where a vehicle can stand: what is viewable is the same for every candidate
};

struct Candidate {
  int number = 0;
  std::string name;
  DesignPoint values;
  std::vector<Setting> settings;       // that make it
  std::vector<CandidateInHall> halls;  // in the order of StudyConfig::halls; empty where a constraint on its factors refuses it
  std::string refused;                 // that constraint; the baseline is never refused, but may break one
};

struct StudySetup {
  StudyConfig study;
  std::filesystem::path file;
  std::vector<Candidate> candidates;  // the baseline first

  // A candidate's configuration as a run's config.yaml, with all that a run shows: `waretwin run SCENARIO --config` drives it.
  std::string run_config(const CandidateInHall& in_hall) const;
};

struct StudyRequest;

// Reads the study, draws its halls, and loads every candidate's configuration. Throws Error for what is wrong with any of them, naming the
// candidate. `check` is called often and may throw to stop.
StudySetup set_up_study(const StudyRequest& request, const std::function<void()>& check);

}  // namespace waretwin

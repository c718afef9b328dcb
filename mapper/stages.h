// The five stages of the pipeline. Each is an interface with several makers; the harness may put the truth in place of any.
#pragma once

#include <memory>
#include <string>

#include "mapper/associate/associator.h"
#include "mapper/detect/detector.h"
#include "mapper/integrate/integrator.h"
#include "mapper/localise/localiser.h"
#include "mapper/mapper_config.h"
#include "mapper/segment/segmenter.h"
#include "sensors/sensor_stream.h"

namespace waretwin {

struct Stages {
  std::unique_ptr<Localiser> localiser;
  std::unique_ptr<Detector> detector;
  std::unique_ptr<Segmenter> segmenter;
  std::unique_ptr<Associator> associator;
  std::unique_ptr<Integrator> integrator;
};

// What `poses` means for a stream: auto is laser where it has scans, else recorded, else odometry.
std::string chosen_poses(const MapperConfig& config, const StreamInfo& info);

// The detector that a configuration names. Throws Error where its files are missing or are none.
std::unique_ptr<Detector> make_detector(const MapperConfig& config);

// The associator that a configuration names: which mapped object is which, and how objects are updated.
std::unique_ptr<Associator> make_associator(const MapperConfig& config);

// The stages that a configuration names. Throws Error where a model file is missing or the stream lacks what a stage needs (laser poses
// without scans).
Stages make_stages(const MapperConfig& config, const StreamInfo& info);

// The integrator that config.method names.
std::unique_ptr<Integrator> make_integrator(const TsdfConfig& config);

}  // namespace waretwin

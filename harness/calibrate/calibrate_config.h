// What a calibration depends on, as one configuration tree for each kind of source.
#pragma once

#include "core/fields.h"
#include "harness/calibrate/calibration.h"
#include "scenes/scenario.h"
#include "sensors/recordings/recording.h"
#include "sim/simulated_stream.h"

namespace waretwin {

struct SimulatedCalibrationConfig {
  Scenario scenario;
  SimulationConfig simulation;
  CalibrateConfig calibrate;
  void visit(Fields& f) {
    scenario.visit(f);
    f.group("simulation", simulation, "how the sensors are simulated");
    f.group("calibrate", calibrate, "the calibration");
  }
};

struct RecordedCalibrationConfig {
  RecordingConfig recording;
  CalibrateConfig calibrate;
  void visit(Fields& f) {
    f.group("recording", recording, "how the recording is read");
    f.group("calibrate", calibrate, "the calibration");
  }
};

}  // namespace waretwin

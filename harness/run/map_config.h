// What mapping a recording depends on.
#pragma once

#include <string>

#include "core/fields.h"
#include "mapper/mapper_config.h"
#include "mapper/output/output_config.h"
#include "sensors/recordings/recording.h"

namespace waretwin {

struct MapConfig {
  RecordingConfig recording;
  MapperConfig mapper;
  OutputConfig output;
  int frames = 0;
  std::string resume;
  std::string extrinsics;

  void visit(Fields& f) {
    f.group("recording", recording, "how the recording is read");
    f.group("mapper", mapper, "the mapper");
    f.group("output", output, "files that are written where they can be");
    f("frames", frames, "stops after this many camera frames; 0: all", {.min = 0, .max = 1e9});
    f("resume", resume, "the map.waretwin to go on from; empty: a new map");
    f("extrinsics", extrinsics, "a calibration that says where the mapper takes the camera to sit; empty: where the recording says");
  }
};

}  // namespace waretwin

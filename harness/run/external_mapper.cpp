#include "harness/run/external_mapper.h"

#include "sensors/recordings/recording_writer.h"

namespace waretwin {

void ExternalMapper::visit(Fields& f) {
  f("command", command, "shell line of another mapper; {recording}, {out} and {boxes} stand for paths; empty: ours");
  f("timeout_s", timeout_s, "after which the command is ended; 0: never", {.min = 0, .max = 1e7});
  f("format", format, "of the recording that it gets", {.choices = recording_formats()});
  f("keep_recording", keep_recording, "leaves the recording in the run's folder");
  f("depends", depends, "files and folders that the command is made of: where they are others, a suite or study runs it again");
}

}  // namespace waretwin

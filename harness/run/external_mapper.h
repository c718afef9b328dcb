// Somebody else's mapper as configuration.
#pragma once

#include <string>

#include "core/fields.h"

namespace waretwin {

struct ExternalMapper {
  // Empty: our own mapper. Else a line for the shell in which {recording}, {out} and {boxes} stand for the recording's folder, the folder
  // for results, and the true boxes (with truth_stages.detector).
  std::string command;
  double timeout_s = 3600.0;    // 0: never
  std::string format = "tum";   // of the recording
  bool keep_recording = false;  // in OUT/mapper/recording; a drive takes gigabytes
  void visit(Fields& f);
};

}  // namespace waretwin

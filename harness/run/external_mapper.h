// Somebody else's mapper as configuration.
#pragma once

#include <string>
#include <vector>

#include "core/fields.h"

namespace waretwin {

struct ExternalMapper {
  // Empty: our own mapper. Else a line for the shell in which {recording}, {out} and {boxes} stand for the recording's folder, the folder
  // for results, and the true boxes (with truth_stages.detector). It runs in the folder that this program was started in, wherever the file
  // lies that names it.
  std::string command;
  double timeout_s = 3600.0;    // 0: never
  std::string format = "tum";   // of the recording
  bool keep_recording = false;  // in OUT/mapper/recording; a drive takes gigabytes
  // What the command is made of (its program, its weights): files, or folders with all that is in them, named from where the command runs.
  // Where a result is kept by what it depends on (harness/units), their bytes count; else the command's own files do not.
  std::vector<std::string> depends;

  bool used() const { return !command.empty(); }
  void visit(Fields& f);
};

// RunScore::profile of what such a mapper made.
inline constexpr const char* kExternalProfile = "mapper";

}  // namespace waretwin

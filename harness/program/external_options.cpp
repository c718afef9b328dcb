#include "harness/program/external_options.h"

#include <CLI/CLI.hpp>

#include "core/error.h"
#include "core/field_values.h"
#include "harness/program/common_options.h"
#include "sensors/recordings/recording_writer.h"

namespace waretwin {

CLI::Option* ExternalOptions::add_to(CLI::App& app, const std::string& kept) {
  CLI::Option* mapper =
      app.add_option(
             "--mapper", command,
             "another mapper in place of ours: records each drive, runs this shell line in the present folder, in which {recording} "
             "and {out} stand for folders, and scores the cuboids.json that it leaves in {out} (docs/mappers.md)")
          ->type_name("COMMAND");
  app.add_option("--mapper-timeout", timeout_s, "ends the command after S seconds (default 3600; 0: never)")
      ->type_name("S")
      ->check(number_from_to(0.0, 1e7))
      ->needs(mapper);
  app.add_option("--format", format, "of the recording that it gets, as for record (default tum)")
      ->check(CLI::IsMember(recording_formats()))
      ->needs(mapper);
  app.add_flag("--keep-recording", keep_recording, "leaves the recording in " + kept)->needs(mapper);
  return mapper;
}

std::vector<Setting> ExternalOptions::settings() const {
  if (command && command->empty()) throw Error("--mapper: is empty; expected a command with {recording} and {out}");
  std::vector<Setting> given;
  // Quotes of its own are the shell's, not YAML's.
  if (command) given.push_back({"external_mapper.command", text_as_yaml(*command)});
  if (!format.empty()) given.push_back({"external_mapper.format", format});
  if (timeout_s) {
    double seconds = *timeout_s;
    given.push_back({"external_mapper.timeout_s", field_as_yaml(&seconds)});
  }
  if (keep_recording) given.push_back({"external_mapper.keep_recording", "true"});
  return given;
}

}  // namespace waretwin

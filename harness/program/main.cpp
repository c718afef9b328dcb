// The program: one command a file beside this one.
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <iostream>
#include <new>

#include "core/error.h"
#include "core/version.h"
#include "harness/program/common_options.h"

namespace {

enum ExitCode { kSuccess = 0, kBadInput = 2, kFault = 3 };

// One line, whatever the message holds.
int fail(ExitCode code, std::string message) {
  while (!message.empty() && message.back() == '\n') message.pop_back();
  for (char& c : message) {
    if (c == '\n') c = ' ';
  }
  std::fprintf(stderr, "waretwin: %s\n", message.c_str());
  return code;
}

int run(int argc, char** argv) {
  CLI::App program("Digital twin and test harness for robots that map warehouses.", "waretwin");
  program.set_version_flag("--version", std::string("waretwin ") + waretwin::kVersion);
  program.require_subcommand(1);
  program.footer(
      "Examples:\n"
      "  waretwin run scenes/agiprobot/scenario.yaml --out out/agiprobot --profile paper\n"
      "  waretwin map RECORDING --out out/map --detector MODEL\n"
      "  waretwin record scenes/agiprobot/scenario.yaml --out out/drive\n"
      "  waretwin score out/agiprobot --truth out/agiprobot/truth.json\n"
      "  waretwin render scenes/agiprobot/scenario.yaml --out view.png --time 12\n"
      "  waretwin inspect scenes/agiprobot/scenario.yaml\n"
      "  waretwin generate --out halls/7 --seed 7\n"
      "  waretwin dataset --generate cell --out data/conveyors --count 1000\n"
      "  waretwin train data/conveyors --out out/detector\n"
      "  waretwin detect out/detector photo.jpg --out out/boxes\n"
      "  waretwin calibrate scenes/agiprobot/calibration.yaml --out extrinsics.yaml\n"
      "  waretwin report out/agiprobot --video out/drive.mp4\n\n"
      "`waretwin COMMAND --help` explains a command. Results go to files and stdout, the log to stderr.\n"
      "Exit codes: 0 success, 1 a gate failed, 2 bad input (one line says what), 3 a fault of the program.");
  const std::vector<waretwin::Command> commands = {
      waretwin::add_run_command(program),      waretwin::add_map_command(program),      waretwin::add_record_command(program),
      waretwin::add_score_command(program),    waretwin::add_render_command(program),   waretwin::add_inspect_command(program),
      waretwin::add_generate_command(program), waretwin::add_dataset_command(program),  waretwin::add_train_command(program),
      waretwin::add_detect_command(program),   waretwin::add_compare_command(program),  waretwin::add_study_command(program),
      waretwin::add_report_command(program),   waretwin::add_calibrate_command(program)};
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& request) {  // --help, --version
    program.exit(request);
    return kSuccess;
  } catch (const CLI::ParseError& error) {
    const auto named = [&](const waretwin::Command& command) { return command.app->get_name() == argv[1]; };
    if (argc > 1 && argv[1][0] != '-' && std::none_of(commands.begin(), commands.end(), named)) {
      return fail(kBadInput, "command '" + std::string(argv[1]) +
                                 "' is not known; expected run, map, record, score, compare, render, inspect, generate, dataset, train, "
                                 "detect, calibrate or report");
    }
    return fail(kBadInput, std::string(error.what()) + " (--help shows what is known)");
  }
  for (const waretwin::Command& command : commands) {
    if (command.app->parsed()) return command.run();
  }
  return fail(kFault, "no command was run");
}

}  // namespace

int main(int argc, char** argv) {
  spdlog::set_default_logger(spdlog::stderr_color_mt("waretwin"));
  spdlog::set_pattern("[%H:%M:%S] %v");
  try {
    const int code = run(argc, argv);
    std::cout.flush();
    if (!std::cout) return fail(kBadInput, "stdout cannot be written");
    return code;
  } catch (const waretwin::Error& error) {
    return fail(kBadInput, error.what());
  } catch (const std::bad_alloc&) {
    return fail(kFault, "out of memory");
  } catch (const std::exception& error) {
    return fail(kFault, std::string("a fault of the program: ") + error.what());
  }
}

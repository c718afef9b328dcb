// waretwin train: a detector from labelled pictures, by the program waretwin-train beside this one.
#include <CLI/CLI.hpp>
#include <memory>

#include "core/error.h"
#include "harness/program/child_process.h"
#include "harness/program/common_options.h"
#include "harness/train/train_options.h"

namespace waretwin {

namespace {

int train(const TrainOptions& options) {
  const std::filesystem::path program = own_folder() / "waretwin-train";
  if (!std::filesystem::exists(program)) {
    throw Error(program, "not there; it is built where libtorch is found (Debian package libtorch-dev)");
  }
  return run_program(program, options.arguments());
}

}  // namespace

Command add_train_command(CLI::App& program) {
  auto options = std::make_shared<TrainOptions>();
  CLI::App* command = program.add_subcommand("train", "a detector from labelled pictures");
  options->add_to(*command);
  return {command, [options] { return train(*options); }};
}

}  // namespace waretwin

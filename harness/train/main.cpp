// waretwin-train: what `waretwin train` starts, so that nothing else loads libtorch.
#include <ATen/Parallel.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <thread>

#include "core/error.h"
#include "harness/program/freed_memory.h"
#include "harness/program/interrupt.h"
#include "harness/program/progress.h"
#include "harness/train/train_options.h"
#include "harness/train/trainer.h"

namespace waretwin {
namespace {

enum ExitCode { kSuccess = 0, kBadInput = 2, kFault = 3 };

int fail(ExitCode code, std::string message) {
  for (char& c : message) {
    if (c == '\n') c = ' ';
  }
  std::fprintf(stderr, "waretwin: %s\n", message.c_str());
  return code;
}

std::string time_left(double seconds) {
  char text[64];
  if (seconds >= 3600.0) {
    std::snprintf(text, sizeof text, "%.1f h left", seconds / 3600.0);
  } else {
    std::snprintf(text, sizeof text, "%.0f min left", std::ceil(seconds / 60.0));
  }
  return text;
}

train::TrainingRequest request_of(const TrainOptions& options) {
  train::TrainingRequest request{options.dataset, options.out, options.name, options.resume, options.from, {}};
  train::TrainConfig& config = request.config;
  if (options.name.empty() || options.name.find('/') != std::string::npos)
    throw Error("--name '" + options.name + "'; expected a file's name");
  std::vector<Setting> settings;
  if (options.common.seed) settings.push_back({"train.seed", std::to_string(*options.common.seed)});
  if (options.epochs) settings.push_back({"train.epochs", std::to_string(*options.epochs)});
  if (options.minutes) settings.push_back({"train.minutes", std::to_string(*options.minutes)});
  for (Setting& setting : options.common.settings()) settings.push_back(std::move(setting));
  apply_settings(settings, [&](Fields& f) { f.group("train", config, "training of a detector"); });
  return request;
}

int train_by(const TrainOptions& options) {
  options.common.apply();
  // Debian's libtorch takes one thread unless told otherwise.
  at::set_num_threads(options.common.threads > 0 ? options.common.threads
                                                 : static_cast<int>(std::max(1u, std::thread::hardware_concurrency())));
  keep_freed_memory();  // a seventh of the time
  const train::TrainingRequest request = request_of(options);
  const InterruptWatch watch;
  Progress progress("train", options.common.quiet);
  train::EpochResult last;
  train::TrainingHooks hooks;
  hooks.check = [&] { watch.check("--resume goes on after the last whole epoch"); };
  hooks.started = [&](const train::TrainingSet& set) {
    spdlog::info("{} pictures with {} boxes of {} classes, {} to validate; {:.0f} MB decoded; {} parameters, anchors' mean IoU {:.2f}",
                 set.train_pictures, set.boxes, set.classes, set.valid_pictures, set.cache_mb, set.parameters, set.anchor_iou);
    if (!options.from.empty()) spdlog::info("starts from {}, which knows {} of {} classes", options.from, set.known_classes, set.classes);
    if (set.epochs_done > 0) spdlog::info("goes on after epoch {}", set.epochs_done);
  };
  hooks.progress = [&](const train::TrainingProgress& now) {
    char text[128];
    std::snprintf(text, sizeof text, "epoch %d, %.1f images/s, %s, AP50 %.3f", now.epoch, now.pictures_per_second,
                  time_left(now.seconds_left).c_str(), last.ap50);
    progress.update(now.share, text);
  };
  hooks.epoch = [&](const train::EpochResult& result) {
    last = result;
    // A bar has no room for it; a log has.
    if (!progress.on_terminal()) {
      spdlog::info("epoch {}: loss {:.3f} box, {:.3f} object, {:.3f} class; AP {:.4f}, AP50 {:.4f}, AP75 {:.4f}, sides {:.1f} px; {:.0f} s",
                   result.epoch, result.box_loss, result.object_loss, result.class_loss, result.ap, result.ap50, result.ap75,
                   result.side_error_px, result.seconds);
    }
  };
  const train::TrainingSummary summary = train_detector(request, hooks);
  std::printf(
      "AP50 %.4f on the valid split after epoch %d of %d, %.1f minutes\ndetector in %s (waretwin map RECORDING --out DIR --detector %s)\n",
      summary.best_ap50, summary.best_epoch, summary.epochs, summary.seconds / 60.0, summary.weights.c_str(), options.out.c_str());
  return kSuccess;
}

// libtorch's threads wait for each other by turning in circles, which takes the processor from whoever they wait for: beside another
// program, or the threads that make pictures ready, a step takes up to three times as long. OpenMP reads its settings before main.
void wait_asleep(char** argv) {
  if (std::getenv("OMP_WAIT_POLICY") != nullptr) return;
  setenv("OMP_WAIT_POLICY", "passive", 1);
  execv("/proc/self/exe", argv);
}

int run(int argc, char** argv) {
  CLI::App command("a detector from labelled pictures", "waretwin train");
  TrainOptions options;
  options.add_to(command);
  try {
    command.parse(argc, argv);
  } catch (const CLI::Success& request) {
    command.exit(request);
    return kSuccess;
  } catch (const CLI::ParseError& error) {
    return fail(kBadInput, std::string(error.what()) + " (--help shows what is known)");
  }
  return train_by(options);
}

}  // namespace
}  // namespace waretwin

int main(int argc, char** argv) {
  waretwin::wait_asleep(argv);
  spdlog::set_default_logger(spdlog::stderr_color_mt("waretwin"));
  spdlog::set_pattern("[%H:%M:%S] %v");
  try {
    const int code = waretwin::run(argc, argv);
    return std::fflush(stdout) == 0 ? code : waretwin::fail(waretwin::kBadInput, "stdout cannot be written");
  } catch (const waretwin::Error& error) {
    return waretwin::fail(waretwin::kBadInput, error.what());
  } catch (const std::bad_alloc&) {
    return waretwin::fail(waretwin::kFault, "out of memory");
  } catch (const std::exception& error) {
    return waretwin::fail(waretwin::kFault, std::string("a fault of the program: ") + error.what());
  }
}

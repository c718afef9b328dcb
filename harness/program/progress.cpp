#include "harness/program/progress.h"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace waretwin {

Progress::Progress(std::string what, bool quiet) : what_(std::move(what)), quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (drawn_) std::fputc('\n', stderr);
}

void Progress::update(double fraction, const std::string& detail) {
  if (quiet_) return;
  const int percent = static_cast<int>(std::clamp(fraction, 0.0, 1.0) * 100.0);
  if (!terminal_) {
    if (percent / 10 <= last_step_) return;
    last_step_ = percent / 10;
    spdlog::info("{}: {} %, {}", what_, percent, detail);
    return;
  }
  const auto now = std::chrono::steady_clock::now();
  if (drawn_ && now - last_drawn_ < std::chrono::milliseconds(100) && percent < 100) return;
  last_drawn_ = now;
  drawn_ = true;
  constexpr int kWidth = 30;
  const int full = percent * kWidth / 100;
  std::fprintf(stderr, "\r%s [%s%s] %3d %%  %s\033[K", what_.c_str(), std::string(static_cast<std::size_t>(full), '#').c_str(),
               std::string(static_cast<std::size_t>(kWidth - full), '.').c_str(), percent, detail.c_str());
  std::fflush(stderr);
}

}  // namespace waretwin

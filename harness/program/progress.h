// How far long work has come: a bar on a terminal, plain lines elsewhere.
#pragma once

#include <chrono>
#include <string>

namespace waretwin {

class Progress {
 public:
  Progress(std::string what, bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // fraction in [0, 1]; a line every 10 % where stderr is no terminal.
  void update(double fraction, const std::string& detail);
  bool on_terminal() const { return terminal_; }

 private:
  std::string what_;
  bool quiet_, terminal_;
  bool drawn_ = false;
  int last_step_ = -1;
  std::chrono::steady_clock::time_point last_drawn_;
};

}  // namespace waretwin

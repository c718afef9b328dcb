// Ctrl-C and a polite kill, for commands that have something to tidy up.
#pragma once

namespace waretwin {

// While it lives, SIGINT, SIGTERM and SIGHUP only leave a mark; a second one ends the process as ever.
class InterruptWatch {
 public:
  InterruptWatch();
  ~InterruptWatch();
  InterruptWatch(const InterruptWatch&) = delete;
  InterruptWatch& operator=(const InterruptWatch&) = delete;

  // Throws Error once a signal came, saying what becomes of the work.
  void check(const char* consequence) const;
};

}  // namespace waretwin

#include "harness/program/interrupt.h"

#include <csignal>
#include <string>

#include "core/error.h"

namespace waretwin {

namespace {

volatile std::sig_atomic_t signal_seen = 0;

void mark(int signal) { signal_seen = signal; }

void answer(void (*handler)(int), int flags) {
  struct sigaction action = {};
  action.sa_handler = handler;
  action.sa_flags = flags;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before = {};
    sigaction(signal, nullptr, &before);
    // What whoever started us had us ignore (nohup) stays ignored.
    if (before.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);
  }
}

}  // namespace

InterruptWatch::InterruptWatch() {
  signal_seen = 0;
  answer(mark, static_cast<int>(SA_RESETHAND) | SA_RESTART);
}

InterruptWatch::~InterruptWatch() { answer(SIG_DFL, 0); }

void InterruptWatch::check(const char* consequence) const {
  if (signal_seen != 0) throw Error("stopped by signal " + std::to_string(signal_seen) + "; " + consequence);
}

}  // namespace waretwin

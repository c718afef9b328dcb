#include "harness/program/child_process.h"

#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>

#include "core/error.h"

namespace waretwin {

namespace {

volatile std::sig_atomic_t child = 0;

void pass_on(int signal, siginfo_t* info, void*) {
  if (info->si_code <= 0 && child > 0) kill(static_cast<pid_t>(child), signal);
}

// While it lives, signals go to the child.
class Forwarding {
 public:
  Forwarding() {
    struct sigaction action = {};
    action.sa_sigaction = pass_on;
    action.sa_flags = SA_SIGINFO | SA_RESTART;
    sigaction(SIGINT, &action, &interrupt_);
    sigaction(SIGTERM, &action, &terminate_);
  }
  ~Forwarding() {
    sigaction(SIGINT, &interrupt_, nullptr);
    sigaction(SIGTERM, &terminate_, nullptr);
    child = 0;
  }
  Forwarding(const Forwarding&) = delete;
  Forwarding& operator=(const Forwarding&) = delete;

 private:
  struct sigaction interrupt_ = {}, terminate_ = {};
};

constexpr int kNotStarted = 127;  // as shells say it

}  // namespace

std::filesystem::path own_folder() { return std::filesystem::read_symlink("/proc/self/exe").parent_path(); }

int run_program(const std::filesystem::path& program, const std::vector<std::string>& arguments) {
  std::vector<std::string> words = {program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  // A signal between fork and here must find the child.
  sigset_t both, before;
  sigemptyset(&both);
  sigaddset(&both, SIGINT);
  sigaddset(&both, SIGTERM);
  sigprocmask(SIG_BLOCK, &both, &before);
  const Forwarding forwarding;
  const pid_t parent = getpid(), started = fork();
  if (started == 0) {
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    sigprocmask(SIG_SETMASK, &before, nullptr);
    if (getppid() == parent) execv(argv[0], argv.data());
    _exit(kNotStarted);
  }
  child = started;
  sigprocmask(SIG_SETMASK, &before, nullptr);
  if (started < 0) throw InternalError(program.string() + " cannot be started: " + std::strerror(errno));

  int status = 0;
  while (waitpid(started, &status, 0) < 0) {
    if (errno != EINTR) throw InternalError(program.string() + " was lost: " + std::strerror(errno));
  }
  if (WIFSIGNALED(status)) throw InternalError(program.string() + " was ended by signal " + std::to_string(WTERMSIG(status)));
  if (WEXITSTATUS(status) == kNotStarted) throw InternalError(program.string() + " cannot be started");
  return WEXITSTATUS(status);
}

}  // namespace waretwin

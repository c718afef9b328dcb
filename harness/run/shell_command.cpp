#include "harness/run/shell_command.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>

#include "core/error.h"

namespace waretwin {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// An output file that the child gets.
class Output {
 public:
  explicit Output(const std::filesystem::path& file) : descriptor_(open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)) {
    if (descriptor_ < 0) throw Error(file, "cannot be written: " + std::string(std::strerror(errno)));
  }
  ~Output() { close(descriptor_); }
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;
  int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

// A process group that ends with the scope.
class Group {
 public:
  explicit Group(pid_t leader) : leader_(leader) {}
  ~Group() {
    kill(-leader_, SIGKILL);
    if (!reaped_) wait4(leader_, nullptr, 0, nullptr);
  }
  Group(const Group&) = delete;
  Group& operator=(const Group&) = delete;

  void signal(int number) const { kill(-leader_, number); }
  // Whether the shell is done; then how.
  bool done(int& status, rusage& usage) {
    const pid_t found = wait4(leader_, &status, WNOHANG, &usage);
    reaped_ = found == leader_;
    return reaped_;
  }

 private:
  pid_t leader_;
  bool reaped_ = false;
};

}  // namespace

ShellResult run_shell(const std::string& command, const std::filesystem::path& stdout_file, const std::filesystem::path& stderr_file,
                      double timeout_s, const std::function<void(double)>& waiting) {
  constexpr double kGrace_s = 3.0;
  const Output out(stdout_file), err(stderr_file);
  const int nothing = open("/dev/null", O_RDONLY | O_CLOEXEC);
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child == 0) {
    setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    for (const int number : {SIGINT, SIGTERM, SIGPIPE}) std::signal(number, SIG_DFL);
    dup2(nothing, STDIN_FILENO);
    dup2(out.descriptor(), STDOUT_FILENO);
    dup2(err.descriptor(), STDERR_FILENO);
    if (getppid() == parent) execl("/bin/sh", "sh", "-c", command.c_str(), static_cast<char*>(nullptr));
    _exit(127);
  }
  if (nothing >= 0) close(nothing);
  if (child < 0) throw InternalError("no process can be started: " + std::string(std::strerror(errno)));
  setpgid(child, child);  // whichever of the two comes first

  Group group(child);
  const auto start = Clock::now();
  ShellResult result;
  int status = 0;
  rusage usage{};
  for (bool asked = false; !group.done(status, usage);) {
    const double now = seconds_since(start);
    if (timeout_s > 0.0 && now > timeout_s && !asked) {
      result.timed_out = asked = true;
      group.signal(SIGTERM);
    }
    if (asked && now > timeout_s + kGrace_s) group.signal(SIGKILL);
    if (waiting) waiting(now);
    // Short commands are not kept waiting, long ones not asked too often.
    std::this_thread::sleep_for(std::chrono::duration<double>(std::clamp(now / 10.0, 0.002, 0.1)));
  }
  result.wall_s = seconds_since(start);
  result.exit_code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  result.peak_rss_mb = static_cast<double>(usage.ru_maxrss) / 1024.0;
  return result;
}

std::string shell_word(const std::string& text) {
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? "'\\''" : std::string(1, c);
  return word + "'";
}

}  // namespace waretwin

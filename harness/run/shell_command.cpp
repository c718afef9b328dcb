#include "harness/run/shell_command.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <mutex>
#include <optional>
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

// Says when a child has become its command: until then it holds this program's memory.
class Start {
 public:
  Start() {
    if (pipe2(ends_, O_CLOEXEC) != 0) throw InternalError("no pipe can be made: " + std::string(std::strerror(errno)));
  }
  ~Start() {
    for (const int end : ends_) {
      if (end >= 0) close(end);
    }
  }
  Start(const Start&) = delete;
  Start& operator=(const Start&) = delete;

  // In the parent, once; nobody writes, so what comes is the end.
  void wait() {
    close(ends_[1]);
    ends_[1] = -1;
    char none = 0;
    while (read(ends_[0], &none, 1) < 0 && errno == EINTR) {
    }
  }

 private:
  int ends_[2] = {-1, -1};
};

// The default action of a child's end while any of these lives: commands may run side by side.
class WaitsForChildren {
 public:
  WaitsForChildren() {
    const std::lock_guard lock(mutex());
    if (living()++ > 0) return;
    struct sigaction action = {};
    action.sa_handler = SIG_DFL;
    sigaction(SIGCHLD, &action, &before());
  }
  ~WaitsForChildren() {
    const std::lock_guard lock(mutex());
    if (--living() == 0) sigaction(SIGCHLD, &before(), nullptr);
  }
  WaitsForChildren(const WaitsForChildren&) = delete;
  WaitsForChildren& operator=(const WaitsForChildren&) = delete;

 private:
  static std::mutex& mutex() {
    static std::mutex one;
    return one;
  }
  static int& living() {
    static int count = 0;
    return count;
  }
  static struct sigaction& before() {
    static struct sigaction action = {};
    return action;
  }
};

// A process group that ends with the scope. Its leader, the shell, is not reaped before: so long nobody else gets the group's number.
class Group {
 public:
  explicit Group(pid_t leader) : leader_(leader) {}
  ~Group() {
    kill(-leader_, SIGKILL);
    waitpid(leader_, nullptr, 0);
  }
  Group(const Group&) = delete;
  Group& operator=(const Group&) = delete;

  // Asks it to end and waits so long for the last of it, which may outlive the shell (a mapper in a pipeline): what it started elsewhere (a
  // container) may be ended by it alone. Then it is ended.
  void end_politely(double patience_s) const {
    const auto start = Clock::now();
    kill(-leader_, SIGTERM);
    while (is_living() && seconds_since(start) < patience_s) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    kill(-leader_, SIGKILL);
  }
  // The shell's exit code, of a signal 128 more; nothing while it runs, unless it is waited for.
  std::optional<int> exit_code(bool waits = false) const {
    siginfo_t info = {};
    while (waitid(P_PID, static_cast<id_t>(leader_), &info, WEXITED | WNOWAIT | (waits ? 0 : WNOHANG)) != 0) {
      if (errno != EINTR) throw InternalError("a command was lost: " + std::string(std::strerror(errno)));
    }
    if (info.si_pid == 0) return std::nullopt;
    return info.si_code == CLD_EXITED ? info.si_status : 128 + info.si_status;
  }
  // The most that any of its processes of now has held. (What the kernel says of an ended child counts what this program held when it
  // was started.)
  double peak_rss_mb() const {
    double peak = 0.0;
    each_process([&](const std::filesystem::path& process) {
      std::ifstream status(process / "status");
      for (std::string line; std::getline(status, line);) {
        if (line.rfind("VmHWM:", 0) == 0) peak = std::max(peak, std::strtod(line.c_str() + 6, nullptr) / 1024.0);
      }
    });
    return peak;
  }

 private:
  // With the folder that the kernel keeps of it.
  void each_process(const std::function<void(const std::filesystem::path&)>& look) const {
    std::error_code ignored;
    for (std::filesystem::directory_iterator at("/proc", ignored), end; !ignored && at != end; at.increment(ignored)) {
      const std::string name = at->path().filename().string();
      if (name.find_first_not_of("0123456789") == std::string::npos && getpgid(static_cast<pid_t>(std::stol(name))) == leader_)
        look(at->path());
    }
  }
  // Whether any of it is more than an ended process that nobody has reaped.
  bool is_living() const {
    bool living = false;
    each_process([&](const std::filesystem::path& process) {
      std::ifstream status(process / "status");
      for (std::string line; std::getline(status, line);) {
        if (line.rfind("State:", 0) == 0) living = living || line.find_first_of("ZX", 6) == std::string::npos;
      }
    });
    return living;
  }

  pid_t leader_;
};

// The text as it stands within a shell's quotes.
std::string within_quotes(const std::string& text, char quote) {
  std::string inside;
  for (const char c : text) {
    if (quote == '\'') {
      inside += c == '\'' ? "'\\''" : std::string(1, c);
    } else {
      if (c == '"' || c == '\\' || c == '$' || c == '`') inside += '\\';
      inside += c;
    }
  }
  return inside;
}

}  // namespace

ShellResult run_shell(const std::string& command, const std::filesystem::path& stdout_file, const std::filesystem::path& stderr_file,
                      double timeout_s, const std::function<void(double)>& waiting) {
  constexpr double kGrace_s = 3.0;
  const Output out(stdout_file), err(stderr_file);
  const int nothing = open("/dev/null", O_RDONLY | O_CLOEXEC);
  // Where it is ignored (some daemons leave it so), a child's end could not be waited for.
  const WaitsForChildren children;
  Start started;
  const pid_t parent = getpid();
  const auto start = Clock::now();
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
  started.wait();
  ShellResult result;
  std::optional<int> exit_code;
  while (!(exit_code = group.exit_code())) {
    const double now = seconds_since(start);
    if (timeout_s > 0.0 && now > timeout_s) {
      result.timed_out = true;
      group.end_politely(kGrace_s);
      exit_code = group.exit_code(true);
      break;
    }
    result.peak_rss_mb = std::max(result.peak_rss_mb, group.peak_rss_mb());
    try {
      if (waiting) waiting(now);
    } catch (...) {
      group.end_politely(kGrace_s);
      throw;
    }
    // Short commands are not kept waiting, long ones not asked too often.
    std::this_thread::sleep_for(std::chrono::duration<double>(std::clamp(now / 10.0, 0.002, 0.1)));
  }
  result.wall_s = seconds_since(start);
  result.exit_code = *exit_code;
  return result;
}

std::string shell_word(const std::string& text) { return "'" + within_quotes(text, '\'') + "'"; }

std::string with_words(const std::string& command, const std::map<std::string, std::string>& words) {
  std::string result;
  char quote = 0;  // that the place is within
  for (std::size_t i = 0; i < command.size();) {
    const auto found =
        std::find_if(words.begin(), words.end(), [&](const auto& word) { return command.compare(i, word.first.size(), word.first) == 0; });
    if (found != words.end()) {
      result += quote == 0 ? shell_word(found->second) : within_quotes(found->second, quote);
      i += found->first.size();
      continue;
    }
    const char c = command[i++];
    result += c;
    if (c == '\\' && quote != '\'' && i < command.size()) {
      result += command[i++];
    } else if (quote == 0 && (c == '\'' || c == '"')) {
      quote = c;
    } else if (c == quote) {
      quote = 0;
    }
  }
  return result;
}

}  // namespace waretwin

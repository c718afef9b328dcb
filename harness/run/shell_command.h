// A command line of the user's, run by the shell, watched and timed.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>

namespace waretwin {

struct ShellResult {
  int exit_code = 0;       // of the shell; 128 + signal where one ended it
  bool timed_out = false;  // it was ended because its time was over
  double wall_s = 0.0;
  double peak_rss_mb = 0.0;  // the most that any one of its processes was seen to hold, in MB of 2^20 bytes; looked at ten times a second
};

// Runs `command` by /bin/sh in a process group of its own, its outputs into the two files (made anew), its input empty. After `timeout_s`
// (0: never) the group gets SIGTERM, and what is left of it three seconds later SIGKILL. `waiting` is called some ten times a second with
// the seconds so far; what it throws (an interruption) ends the group in the same way, and is passed on. What it leaves behind of its group
// is ended. Where this program itself is killed, the shell gets SIGTERM, what the shell started goes on. Several may run at a time, from
// threads that outlive them. Throws Error where a file cannot be made, InternalError where no process can be started.
ShellResult run_shell(const std::string& command, const std::filesystem::path& stdout_file, const std::filesystem::path& stderr_file,
                      double timeout_s, const std::function<void(double)>& waiting = {});

// A path as one word of a shell's command line.
std::string shell_word(const std::string& text);

// The command with its placeholders ({recording}) replaced by such words, whether they stand by themselves or within quotes.
std::string with_words(const std::string& command, const std::map<std::string, std::string>& words);

}  // namespace waretwin

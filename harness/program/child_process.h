// Another program of ours as a part of this one.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace waretwin {

// The folder that this program lies in.
std::filesystem::path own_folder();

// Runs a program with the same input and outputs and returns its exit code. SIGINT and SIGTERM that a process sends to this one are passed
// on (a terminal's Ctrl-C reaches both anyway); should this one die, the other is asked to end. Throws InternalError where the program
// cannot be started or was ended by a signal that nobody passed on.
int run_program(const std::filesystem::path& program, const std::vector<std::string>& arguments);

}  // namespace waretwin

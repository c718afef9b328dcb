// A folder that appears under its final name only when it is complete.
#pragma once

#include <filesystem>

namespace waretwin {

// Made as NAME.partial-PROCESS beside its final place. commit() moves it there; without it the destructor removes the folder, and a killed
// process leaves only the partial one, under a name that nobody takes for the result.
class StagedFolder {
 public:
  // Throws Error when the folder cannot be made or a file stands in the final place.
  explicit StagedFolder(const std::filesystem::path& place);
  ~StagedFolder();
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  // Where to write.
  const std::filesystem::path& path() const { return staged_; }

  // Takes the final name; a folder that has it is moved aside first and removed after. Throws Error where that fails: the old folder is
  // then as it was, and the new one stays under its partial name, which the message says.
  void commit();

 private:
  std::filesystem::path place_, staged_;
  bool done_ = false;
};

}  // namespace waretwin

#include "core/staged_folder.h"

#include <string>
#include <system_error>

#include "core/error.h"
#include "core/files.h"
#include "core/process_name.h"

namespace waretwin {

namespace fs = std::filesystem;

namespace {

// Without a slash at the end and through links, so that a name can be put beside the folder itself.
fs::path settled(const fs::path& place) {
  std::error_code failure;
  fs::path path = fs::weakly_canonical(fs::absolute(place), failure);
  if (failure) path = fs::absolute(place).lexically_normal();
  return path.has_filename() ? path : path.parent_path();
}

fs::path beside(const fs::path& place, const std::string& word) {
  fs::path name = place;
  name += "." + word + "-" + process_name();
  return name;
}

}  // namespace

StagedFolder::StagedFolder(const fs::path& place) : place_(settled(place)), staged_(beside(place_, "partial")) {
  std::error_code failure;
  const fs::file_status status = fs::status(place_, failure);
  if (fs::exists(status) && !fs::is_directory(status)) throw Error(place, "is a file; expected a folder or a new name");
  make_folder(place_.parent_path());
  fs::remove_all(staged_, failure);  // of a process long gone that had our number
  if (!fs::create_directory(staged_, failure)) throw Error(place, "cannot make the folder: " + failure.message());
}

StagedFolder::~StagedFolder() {
  std::error_code ignored;
  if (!done_) fs::remove_all(staged_, ignored);
}

void StagedFolder::commit() {
  done_ = true;
  const fs::path aside = beside(place_, "replaced");
  std::error_code failure;
  const bool replaces = fs::exists(place_);
  if (replaces) fs::rename(place_, aside, failure);
  if (!failure) {
    fs::rename(staged_, place_, failure);
    std::error_code ignored;
    if (failure && replaces) fs::rename(aside, place_, ignored);
  }
  if (failure)
    throw Error(place_, "cannot be put in place: " + failure.message() + "; what was made is whole and stays in " + staged_.string());
  if (replaces) fs::remove_all(aside, failure);
  if (failure) throw Error(aside, "cannot be removed: " + failure.message() + "; " + place_.string() + " is complete");
}

}  // namespace waretwin

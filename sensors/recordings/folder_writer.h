// The layouts whose pictures are files. Internal to sensors/recordings.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "sensors/recordings/recording_writer.h"

namespace waretwin {

// tum, 7scenes or scenenn. Throws Error for another format and where the folder cannot be written.
std::unique_ptr<RecordingWriter> make_folder_writer(const std::string& format, const std::filesystem::path& folder, const StreamInfo& info);

}  // namespace waretwin

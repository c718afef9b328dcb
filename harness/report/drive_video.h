// A drive as a video: what the camera saw, and the map that grows from it.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace waretwin {

struct VideoSummary {
  int frames = 0;
  int width = 0, height = 0;  // pixels
  std::string codec;          // "H.264" or "MPEG-4"
};

// Of a run's or a map's folder, from the frames that it kept (frame_log.h), at 8 a second: on the left each picture with its boxes (the
// depth picture where the drive had no colour), on the right the map from above: the surface seen so far, the objects known so far, the
// path driven so far. `progress` gets the share that is done. Throws Error where the build has no OpenCV videoio, the folder has no frames,
// `file` does not end in .mp4, or no encoder is there.
VideoSummary write_drive_video(const std::filesystem::path& folder, const std::filesystem::path& file,
                               const std::function<void(double)>& progress = {});

// Whether the build can write videos.
bool video_available();

}  // namespace waretwin

#include "harness/run/mapping.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "core/error.h"
#include "harness/pictures/frame_pictures.h"
#include "mapper/integrate/tsdf_volume.h"
#include "mapper/output/map_archive.h"

namespace waretwin {

namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Keeps pictures of few frames out of a number that is not known before: when the album is full, every second one goes and the steps
// double.
class Album {
 public:
  bool wants(int frame) const { return frame % step_ == 0; }
  void add(int frame, std::vector<FramePicture> pictures) {
    pages_.push_back({frame, std::move(pictures)});
    if (pages_.size() < kPages) return;
    step_ *= 2;
    std::erase_if(pages_, [this](const Page& page) { return page.frame % step_ != 0; });
  }
  std::vector<FramePicture> take() {
    std::vector<FramePicture> pictures;
    for (Page& page : pages_) {
      char name[48];
      std::snprintf(name, sizeof name, "frame-%04d", page.frame);
      for (FramePicture& picture : page.pictures) pictures.push_back({std::string(name) + picture.name, std::move(picture.image)});
    }
    return pictures;
  }

 private:
  static constexpr std::size_t kPages = 12;
  struct Page {
    int frame;
    std::vector<FramePicture> pictures;
  };
  int step_ = 1;
  std::vector<Page> pages_;
};

}  // namespace

std::optional<LoadedMap> load_resumed(const std::string& file, const TsdfConfig& config) {
  if (file.empty()) return std::nullopt;
  LoadedMap map = load_map(file);
  try {
    map.volume->expect_same_grid(config);
  } catch (const Error& e) {
    throw Error(std::filesystem::path(file), e.what());
  }
  return map;
}

MappingResult map_stream(SensorStream& stream, const MapperConfig& config, Stages stages, int max_frames, const MappingHooks& hooks,
                         std::optional<LoadedMap> resumed) {
  const StreamInfo& info = stream.info();
  MappingResult result;
  Album album;
  FrameLog log;
  double source_ms = 0.0;
  std::vector<double> source_times;
  Mapper mapper(config, std::move(stages), info);
  if (resumed) mapper.resume(std::move(*resumed));
  mapper.on_frame = [&](const Mapper::FrameResult& frame) {
    source_times.push_back(source_ms);
    const int index = static_cast<int>(source_times.size()) - 1;
    if (hooks.on_frame) hooks.on_frame(frame);
    const StreamInfo::Camera& camera = info.cameras.at(frame.frame.sensor);
    if (const std::optional<int> turn = hooks.pictures ? log.turn_of(frame.frame.sensor) : std::nullopt) {
      LoggedFrame kept = logged_frame(index, frame, mapper.map().objects, camera);
      kept.turn = *turn;
      log.add(std::move(kept));
    }
    if (hooks.pictures && album.wants(index)) {
      const double far_m = std::min(camera.depth_max_m, 10.0);
      std::vector<FramePicture> pictures = {{".colour", draw_frame(frame, mapper.map().objects, camera.intrinsics)},
                                            {".depth", draw_depth(frame.frame.depth, camera.depth_min_m, far_m)}};
      if (hooks.true_depth) {
        pictures.push_back({".depth_error", draw_depth_error(frame.frame.depth, hooks.true_depth(frame.frame), camera.depth_min_m, far_m)});
      }
      if (hooks.truth_picture) pictures.push_back({".truth", hooks.truth_picture(frame.frame)});
      album.add(index, std::move(pictures));
    }
  };

  if (info.cameras.empty() && !info.lasers.empty()) result.X_BL = info.lasers.begin()->second.X_BL;
  const auto start = std::chrono::steady_clock::now();
  std::optional<Stamp> first;
  Stamp last = 0;
  int frames = 0;
  while (auto event = stream.next()) {
    const Stamp stamp = stamp_of(*event);
    if (!first) first = stamp;
    last = stamp;
    if (auto* frame = std::get_if<RgbdFrame>(&*event)) {
      ++frames;
      if (frame->load) {
        // Measures what the source takes for the pictures, apart from the mapper's own time.
        frame->load = [load = std::move(frame->load), &source_ms](RgbdFrame& f) {
          const auto before = std::chrono::steady_clock::now();
          load(f);
          source_ms = 1e3 * seconds_since(before);
        };
      }
    }
    if (hooks.on_event) hooks.on_event(*event);
    mapper.consume(std::move(*event));
    if (hooks.progress) {
      double done = 0.0;
      if (info.duration_s && *info.duration_s > 0.0) done = to_seconds(stamp - *first) / *info.duration_s;
      if (info.frame_count && *info.frame_count > 0) done = std::max(done, static_cast<double>(frames) / *info.frame_count);
      if (max_frames > 0) done = std::max(done, static_cast<double>(frames) / max_frames);
      hooks.progress(std::min(done, 1.0), mapper.map());
    }
    // The simulation ends here, too: a recording that goes on gives the same map.
    if (max_frames > 0 && frames == max_frames) break;
  }
  result.wall_s = seconds_since(start);
  result.stream_s = first ? to_seconds(last - *first) : 0.0;
  result.map = mapper.finish();
  for (std::size_t i = 0; i < result.map.frames.size(); ++i) result.frames.push_back({result.map.frames[i], source_times[i]});
  result.pictures = album.take();
  result.kept_frames = log.take();
  return result;
}

}  // namespace waretwin

// What the simulation costs: one 1280x720 frame in a hall of about 300,000 triangles, ideal and with all errors, and one 541-beam scan.
#include <benchmark/benchmark.h>

#include <chrono>
#include <memory>

#include "sensors/camera_config.h"
#include "sensors/colour_model.h"
#include "sensors/rectification.h"
#include "sim/colour_camera.h"
#include "sim/depth_camera.h"
#include "sim/laser_scanner.h"
#include "sim/laser_spot.h"
#include "sim/motion_blur.h"
#include "sim/object_views.h"
#include "sim/renderer.h"
#include "tests/sim/fixtures.h"

namespace {

using namespace waretwin;

std::shared_ptr<const RayCaster> hall() {
  static const auto caster = std::make_shared<const RayCaster>(std::make_shared<const Scene>(fixtures::busy_hall(60)));
  return caster;
}

Pose camera_pose() {
  Mount mount;
  mount.z_m = 1.4;
  mount.pitch_deg = 25.0;
  return make_upright_pose(-4.5, -0.5, 0.0, 0.25) * mount.X_BC();
}

// Driving at half a metre a second and turning by half a radian: three pixels of blur.
Pose driving(Stamp stamp) {
  const double t = to_seconds(stamp);
  return make_upright_pose(0.5 * t, 0.0, 0.0, 0.5 * t) * camera_pose();
}
Pose standing(Stamp) { return camera_pose(); }

void picture(benchmark::State& state, bool colour, bool shadows, bool occlusion) {
  RenderOptions options;
  options.shadows = shadows;
  options.occlusion = occlusion;
  Renderer renderer(hall(), options);
  RenderRequest request;
  request.colour = colour;
  const Intrinsics intrinsics = CameraConfig().intrinsics();
  for (auto _ : state) {
    ++request.stamp;
    benchmark::DoNotOptimize(renderer.render(intrinsics, camera_pose(), request).depth.data);
  }
  state.counters["triangles"] = static_cast<double>(hall()->scene().triangle_count());
}

void depth_only(benchmark::State& state) { picture(state, false, false, false); }
void colour_unshadowed(benchmark::State& state) { picture(state, true, false, false); }
void colour_with_shadows(benchmark::State& state) { picture(state, true, true, false); }
void colour_with_shadows_and_occlusion(benchmark::State& state) { picture(state, true, true, true); }

// What the frame shows and hides of each object, beside the frame itself; compare with depth_only.
void views_of_objects(benchmark::State& state) {
  Renderer renderer(hall(), {});
  RenderRequest request;
  request.colour = false;
  const Intrinsics intrinsics = CameraConfig().intrinsics();
  const cv::Mat instances = renderer.render(intrinsics, camera_pose(), request).instances;
  const PictureRays rays = pinhole_rays(intrinsics, camera_pose(), Ray().time);
  std::size_t views = 0;
  for (auto _ : state) {
    views = object_views(*hall(), rays, instances).size();
    benchmark::DoNotOptimize(views);
  }
  state.counters["objects"] = static_cast<double>(views);
}

void laser_scan(benchmark::State& state) {
  const LaserConfig laser;
  for (auto _ : state) {
    benchmark::DoNotOptimize(ideal_scan(*hall(), laser, "laser", 0, [&](Stamp) { return laser.mount.X_BL(); }).ranges.data());
  }
}

// With the width of the beams: seven rays and their surfaces each.
void laser_scan_with_spot(benchmark::State& state) {
  const LaserConfig laser;
  const Surfaces surfaces(hall());
  for (auto _ : state) {
    benchmark::DoNotOptimize(spot_scan(*hall(), surfaces, laser, "laser", 0, [&](Stamp) { return laser.mount.X_BL(); }).ranges.data());
  }
}

// The depth camera's own picture and its warp into the colour view, beside depth_only (ideal depth, of the colour view alone).
void own_depth(benchmark::State& state, const char* preset) {
  const Surfaces surfaces(hall());
  const auto camera = DepthCamera::make(CameraConfig::make(preset), 1, "camera", hall(), surfaces);
  for (auto _ : state) {
    benchmark::DoNotOptimize(camera->read({}, 0, [](Stamp) { return camera_pose(); }).registered.data);
  }
}

void time_of_flight_depth(benchmark::State& state) { own_depth(state, "azure_kinect"); }
void stereo_depth(benchmark::State& state) { own_depth(state, "realsense_d435"); }

// Colour with all its errors, without depth.
void colour_picture(benchmark::State& state, Pose (*X_WC)(Stamp)) {
  Renderer renderer(hall(), {});
  ColourCamera camera(CameraConfig{}, 1, "camera", renderer);
  for (auto _ : state) benchmark::DoNotOptimize(camera.look(0, X_WC, true).colour.data);
}
void colour_errors_driving(benchmark::State& state) { colour_picture(state, driving); }
void colour_errors_standing(benchmark::State& state) { colour_picture(state, standing); }

// Its parts.
void colour_sensor(benchmark::State& state) {
  const ColourModel model(CameraConfig{}, 1, "camera");
  const cv::Mat radiance(720, 1280, CV_32FC4, cv::Scalar(0.3, 0.2, 0.5, 0));
  for (auto _ : state) benchmark::DoNotOptimize(model.picture(radiance, 0).data);
}
void colour_rectification(benchmark::State& state) {
  const CameraConfig camera;
  const Rectification rectification(camera.colour_lens(), camera.intrinsics());
  const cv::Mat picture(720, 1280, CV_8UC3, cv::Scalar(10, 20, 30)), labels(720, 1280, CV_16UC1, cv::Scalar(1));
  for (auto _ : state) {
    benchmark::DoNotOptimize(rectification.colour(picture).data);
    benchmark::DoNotOptimize(rectification.labels(labels).data);
  }
}
void colour_blur(benchmark::State& state) {
  const ColourModel model(CameraConfig{}, 1, "camera");
  const cv::Mat radiance(720, 1280, CV_32FC4, cv::Scalar(0.3, 0.2, 0.5, 0)), depth(720, 1280, CV_32FC1, cv::Scalar(2));
  PixelRays::Row row;
  row.X_WC_begin = driving(-4'000'000);
  row.X_WC = driving(0);
  row.X_WC_end = driving(4'000'000);
  const std::vector<PixelRays::Row> rows(720, row);
  for (auto _ : state) benchmark::DoNotOptimize(motion_blurred(radiance, depth, model.rays(), rows, 0.0).data);
}

// A frame with every error of colour and depth; beside it, turn by turn, the frame of an ideal camera: `over_ideal` is the ratio.
void sensor_frame(benchmark::State& state) {
  Renderer renderer(hall(), {});
  const auto frame = [&renderer](const char* preset) {
    const CameraConfig config = CameraConfig::make(preset);
    return [colour = std::make_shared<ColourCamera>(config, 1, "camera", renderer),
            depth = std::shared_ptr<DepthCamera>(DepthCamera::make(config, 1, "camera", hall(), renderer.surfaces()))] {
      const auto begin = std::chrono::steady_clock::now();
      const FrameImages images = colour->look(0, driving, true);
      benchmark::DoNotOptimize(depth->read(images.depth, 0, driving).registered.data);
      return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    };
  };
  const auto ideal = frame("ideal"), full = frame("azure_kinect");
  double ideal_s = 0.0, full_s = 0.0;
  for (auto _ : state) {
    ideal_s += ideal();
    const double seconds = full();
    full_s += seconds;
    state.SetIterationTime(seconds);
  }
  state.counters["ideal_ms"] = 1e3 * ideal_s / static_cast<double>(state.iterations());
  state.counters["over_ideal"] = full_s / ideal_s;
}

BENCHMARK(views_of_objects)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();
BENCHMARK(sensor_frame)->Unit(benchmark::kMillisecond)->UseManualTime();
BENCHMARK(colour_errors_driving)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();
BENCHMARK(colour_errors_standing)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();
BENCHMARK(colour_sensor)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();
BENCHMARK(colour_rectification)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();
BENCHMARK(colour_blur)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();
BENCHMARK(depth_only)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();
BENCHMARK(colour_unshadowed)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();
BENCHMARK(colour_with_shadows)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();
BENCHMARK(colour_with_shadows_and_occlusion)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();
BENCHMARK(time_of_flight_depth)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();
BENCHMARK(stereo_depth)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();
BENCHMARK(laser_scan_with_spot)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();
BENCHMARK(laser_scan)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();

}  // namespace

BENCHMARK_MAIN();

// What the simulation costs: one 1280x720 frame in a hall of about 300,000 triangles, and one 541-beam scan.
#include <benchmark/benchmark.h>

#include <memory>

#include "sensors/camera_config.h"
#include "sim/depth_camera.h"
#include "sim/laser_scanner.h"
#include "sim/laser_spot.h"
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

void laser_scan(benchmark::State& state) {
  const LaserConfig laser;
  for (auto _ : state) {
    benchmark::DoNotOptimize(ideal_scan(*hall(), laser, "laser", 0, [](Stamp) { return make_upright_pose(0, 0, 0, 0); }).ranges.data());
  }
}

// With the width of the beams: seven rays and their surfaces each.
void laser_scan_with_spot(benchmark::State& state) {
  const LaserConfig laser;
  const Surfaces surfaces(hall());
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        spot_scan(*hall(), surfaces, laser, "laser", 0, [](Stamp) { return make_upright_pose(0, 0, 0, 0); }).ranges.data());
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

// Integration of 1280 x 720 frames at 2 cm, as `ci/` and the README quote it: mean depth about 1.5 m, 3 % of the pixels missing.
//
// BackProjection is the lower bound: every valid pixel to a point in the world, nothing kept. `vs_back_projection` is the ratio of the
// two in one run, which drifts less from machine to machine than milliseconds do.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <type_traits>

#include "core/parallel.h"
#include "mapper/integrate/depth_pyramid.h"
#include "mapper/integrate/free_space.h"
#include "mapper/integrate/grouped_ray_integrator.h"
#include "mapper/integrate/mesher.h"
#include "mapper/integrate/point_groups.h"
#include "mapper/integrate/projective_integrator.h"
#include "mapper/integrate/surface_patches.h"
#include "tests/mapper/integrate_scene.h"
#ifdef WARETWIN_OPEN3D
#include "tests/bench/open3d_peer.h"
#endif

namespace waretwin {
namespace {

const Intrinsics& camera() {
  static const Intrinsics intrinsics = Intrinsics::from_field_of_view(1280, 720, to_radians(90), to_radians(59));
  return intrinsics;
}

struct View {
  Pose X_WC;
  test::LabelledFrame in;
};

const std::vector<View>& views() {
  static const std::vector<View> all = [] {
    std::vector<View> made;
    for (int i = 0; i < 12; ++i) {
      const double angle = 0.12 * i;
      View v;
      v.X_WC = test::look_at({-0.5 + 0.08 * i, -0.5 + 0.02 * i, 1.35}, {-0.5 + std::sin(angle), 1.0, 0.45});
      v.in = test::view(test::BoxScene(), camera(), v.X_WC, true, i);
      made.push_back(std::move(v));
    }
    return made;
  }();
  return all;
}

float back_project(const View& v) {
  const int width = camera().width;
  std::vector<float> rows(static_cast<std::size_t>(camera().height));
  parallel_for(rows.size(), 16, [&](std::size_t begin, std::size_t end) {
    const Eigen::Matrix3f R = v.X_WC.linear().cast<float>();
    std::vector<float> x(static_cast<std::size_t>(width)), y(x), z(x);
    for (std::size_t row = begin; row < end; ++row) {
      const float* depth = v.in.frame.depth.ptr<float>(static_cast<int>(row));
      const float ry = static_cast<float>((static_cast<double>(row) - camera().cy) / camera().fy);
      const float fx = static_cast<float>(1.0 / camera().fx), cx = static_cast<float>(camera().cx);
      for (int u = 0; u < width; ++u) {
        const float rx = (static_cast<float>(u) - cx) * fx, d = depth[u];
        const auto i = static_cast<std::size_t>(u);
        x[i] = d * (R(0, 0) * rx + R(0, 1) * ry + R(0, 2));
        y[i] = d * (R(1, 0) * rx + R(1, 1) * ry + R(1, 2));
        z[i] = d * (R(2, 0) * rx + R(2, 1) * ry + R(2, 2));
      }
      benchmark::DoNotOptimize(x.data());
      benchmark::DoNotOptimize(y.data());
      benchmark::DoNotOptimize(z.data());
      benchmark::ClobberMemory();
      rows[row] = x[0] + y[0] + z[0];
    }
  });
  return rows.front();
}

template <class SomeIntegrator>
TsdfConfig config_of() {
  TsdfConfig config;
  config.method = std::is_same_v<SomeIntegrator, ProjectiveIntegrator> ? "projection" : "rays";
  return config;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

void BackProjection(benchmark::State& state) {
  std::size_t i = 0;
  views();
  for (auto _ : state) benchmark::DoNotOptimize(back_project(views()[i++ % views().size()]));
}
BENCHMARK(BackProjection)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();

template <class SomeIntegrator>
void Integrate(benchmark::State& state) {
  TsdfConfig config = config_of<SomeIntegrator>();
  config.carve = state.range(0) != 0;
  TsdfVolume volume(config);
  SomeIntegrator integrator(config);
  std::vector<double> frame_ms;
  double bound = 0.0, own = 0.0, valid = 0.0, depth = 0.0;
  for (const View& v : views()) {
    for (int row = 0; row < camera().height; ++row) {
      for (int u = 0; u < camera().width; ++u) {
        const float d = v.in.frame.depth.at<float>(row, u);
        valid += d > 0.0f;
        depth += d;
      }
    }
  }
  std::size_t i = 0;
  for (auto _ : state) {
    const View& v = views()[i++ % views().size()];
    const auto start = std::chrono::steady_clock::now();
    integrator.integrate(v.in.frame, camera(), v.in.labels, v.X_WC, volume);
    frame_ms.push_back(1e3 * seconds_since(start));
    own += 1e-3 * frame_ms.back();
    state.PauseTiming();
    const auto bound_start = std::chrono::steady_clock::now();
    benchmark::DoNotOptimize(back_project(v));
    bound += seconds_since(bound_start);
    state.ResumeTiming();
  }
  state.counters["median_ms"] = median(frame_ms);
  state.counters["vs_back_projection"] = own / bound;
  state.counters["points"] = valid / static_cast<double>(views().size());
  state.counters["mean_depth_m"] = depth / valid;
  state.counters["map_MB"] = static_cast<double>(volume.bytes()) / 1e6;
}
BENCHMARK(Integrate<GroupedRayIntegrator>)
    ->ArgName("carve")
    ->Arg(0)
    ->Arg(1)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->MeasureProcessCPUTime();
BENCHMARK(Integrate<ProjectiveIntegrator>)
    ->ArgName("carve")
    ->Arg(0)
    ->Arg(1)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->MeasureProcessCPUTime();

// The peer on the same frames in the same run: `ours` and `peer` are median milliseconds, frame by frame in turns.
#ifdef WARETWIN_OPEN3D
void AgainstOpen3d(benchmark::State& state) {
  const TsdfConfig config = config_of<ProjectiveIntegrator>();
  TsdfVolume volume(config);
  ProjectiveIntegrator integrator(config);
  bench::Open3dPeer peer(camera());
  std::vector<double> ours, theirs;
  std::size_t i = 0;
  for (auto _ : state) {
    const View& v = views()[i++ % views().size()];
    peer.prepare(v.in.frame, v.X_WC);
    const auto start = std::chrono::steady_clock::now();
    peer.integrate();
    theirs.push_back(1e3 * seconds_since(start));
    const auto middle = std::chrono::steady_clock::now();
    integrator.integrate(v.in.frame, camera(), v.in.labels, v.X_WC, volume);
    const double own = seconds_since(middle);
    ours.push_back(1e3 * own);
    state.SetIterationTime(own);
  }
  state.counters["ours"] = median(ours);
  state.counters["peer"] = median(theirs);
  state.counters["faster"] = median(theirs) / median(ours);
}
BENCHMARK(AgainstOpen3d)->Unit(benchmark::kMillisecond)->UseManualTime()->Iterations(60);
#endif

void MakePatches(benchmark::State& state) {
  const TsdfConfig config = config_of<ProjectiveIntegrator>();
  std::size_t i = 0;
  for (auto _ : state) {
    const View& v = views()[i++ % views().size()];
    benchmark::DoNotOptimize(make_patches(v.in.frame, camera(), v.in.labels, config));
  }
}
BENCHMARK(MakePatches)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();

void MakeDepthPyramid(benchmark::State& state) {
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(DepthPyramid(views()[i++ % views().size()].in.frame.depth).largest());
}
BENCHMARK(MakeDepthPyramid)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();

void GroupPoints(benchmark::State& state) {
  const TsdfConfig config;
  std::size_t i = 0, groups = 0;
  for (auto _ : state) {
    const View& v = views()[i++ % views().size()];
    groups = group_points(v.in.frame, camera(), v.in.labels, v.X_WC, config).size();
  }
  state.counters["groups"] = static_cast<double>(groups);
}
BENCHMARK(GroupPoints)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();

void FindFreeSpace(benchmark::State& state) {
  const TsdfConfig config;
  std::size_t i = 0;
  for (auto _ : state) {
    const View& v = views()[i++ % views().size()];
    benchmark::DoNotOptimize(find_free_space(v.in.frame, camera(), v.X_WC, config));
  }
}
BENCHMARK(FindFreeSpace)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();

void ExtractMesh(benchmark::State& state) {
  const TsdfConfig config;
  TsdfVolume volume(config);
  GroupedRayIntegrator integrator(config);
  for (const View& v : views()) integrator.integrate(v.in.frame, camera(), v.in.labels, v.X_WC, volume);
  std::size_t triangles = 0;
  for (auto _ : state) triangles = extract_mesh(volume).triangles.size();
  state.counters["triangles"] = static_cast<double>(triangles);
}
BENCHMARK(ExtractMesh)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();

}  // namespace
}  // namespace waretwin

BENCHMARK_MAIN();

// The integrator against a plain loop over points, rays and voxels.
#include <gtest/gtest.h>

#include <array>
#include <map>
#include <set>

#include "core/error.h"
#include "mapper/integrate/free_space.h"
#include "mapper/integrate/grouped_ray_integrator.h"
#include "mapper/integrate/point_groups.h"
#include "tests/mapper/integrate_scene.h"

namespace waretwin {
namespace {

using test::BoxScene;
using test::LabelledFrame;
using test::look_at;
using test::view;

using Index = std::array<int, 3>;

Index index_of(const Eigen::Vector3d& p, double voxel) {
  return {static_cast<int>(std::floor(p.x() / voxel)), static_cast<int>(std::floor(p.y() / voxel)),
          static_cast<int>(std::floor(p.z() / voxel))};
}

struct ReferenceVoxel {
  double distance = 0.0, weight = 0.0;
  Eigen::Vector3d colour = Eigen::Vector3d::Zero();
  std::map<std::int32_t, int> labels;
  int frames = 0;
};

// Does the segment from a to b pass through the voxel? Slabs, one axis at a time.
bool crosses(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Index& voxel, double size) {
  double enter = 0.0, leave = 1.0;
  for (int k = 0; k < 3; ++k) {
    const double low = voxel[static_cast<std::size_t>(k)] * size, high = low + size, d = b[k] - a[k];
    if (d == 0.0) {
      if (a[k] < low || a[k] >= high) return false;
      continue;
    }
    const double t0 = (low - a[k]) / d, t1 = (high - a[k]) / d;
    enter = std::max(enter, std::min(t0, t1));
    leave = std::min(leave, std::max(t0, t1));
  }
  return enter < leave;
}

class ReferenceMap {
 public:
  explicit ReferenceMap(const TsdfConfig& config) : config_(config) {}

  void integrate(const LabelledFrame& in, const Intrinsics& camera, const Pose& X_WC) {
    struct Group {
      double weight = 0.0;
      Eigen::Vector3d sum = Eigen::Vector3d::Zero(), colour = Eigen::Vector3d::Zero();
      std::map<std::int32_t, int> labels;
      int points = 0;
    };
    std::map<Index, Group> groups;
    for (int v = 0; v < camera.height; ++v) {
      for (int u = 0; u < camera.width; ++u) {
        const double z = in.frame.depth.at<float>(v, u);
        if (!(z > 0.0) || z > config_.max_depth_m) continue;
        const Eigen::Vector3d p = X_WC * (camera.ray(u, v) * z);
        Group& g = groups[index_of(p, config_.voxel_m)];
        const double w = config_.inverse_square_weight ? 1.0 / (z * z) : 1.0;
        g.weight += w;
        g.sum += w * p;
        const auto bgr = in.frame.colour.at<cv::Vec3b>(v, u);
        g.colour += Eigen::Vector3d(bgr[2], bgr[1], bgr[0]);
        ++g.labels[in.labels[static_cast<std::size_t>(v * camera.width + u)]];
        ++g.points;
      }
    }
    std::map<Index, std::set<std::int32_t>> seen_labels;
    std::set<Index> touched;
    const double t = config_.truncation_m(), size = config_.voxel_m;
    const Eigen::Vector3d o = X_WC.translation();
    for (const auto& [index, g] : groups) {
      std::int32_t label = 0;
      int most = 0;
      for (const auto& [l, n] : g.labels) {
        if (n > most) {
          most = n;
          label = l;
        }
      }
      const Eigen::Vector3d p = g.sum / g.weight;
      const double length = (p - o).norm();
      const Eigen::Vector3d dir = (p - o) / length;
      const Eigen::Vector3d a = o + dir * std::max(0.0, length - t), b = o + dir * (length + t);
      const Index low = index_of(a.cwiseMin(b), size), high = index_of(a.cwiseMax(b), size);
      for (int x = low[0]; x <= high[0]; ++x) {
        for (int y = low[1]; y <= high[1]; ++y) {
          for (int z = low[2]; z <= high[2]; ++z) {
            if (!crosses(a, b, {x, y, z}, size)) continue;
            const Eigen::Vector3d centre = (Eigen::Vector3d(x, y, z).array() + 0.5) * size;
            const double d = length - (centre - o).dot(dir);
            if (std::abs(d) <= config_.label_band_voxels * size) seen_labels[{x, y, z}].insert(label);
            double w = g.weight;
            if (d < -size) w *= std::max(0.0, (t + d) / (t - size));
            if (w <= 0.0) continue;
            touched.insert({x, y, z});
            ReferenceVoxel& voxel = voxels[{x, y, z}];
            voxel.distance = (voxel.distance * voxel.weight + std::clamp(d, -t, t) * w) / (voxel.weight + w);
            voxel.colour = (voxel.colour * voxel.weight + g.colour / g.points * w) / (voxel.weight + w);
            voxel.weight = std::min(voxel.weight + w, config_.max_weight);
          }
        }
      }
    }
    for (const auto& [index, labels] : seen_labels) {
      for (const std::int32_t l : labels) ++voxels[index].labels[l];
    }
    for (const Index& index : touched) ++voxels[index].frames;
  }

  std::map<Index, ReferenceVoxel> voxels;

 private:
  TsdfConfig config_;
};

TEST(GroupedRayIntegrator, EqualsAPlainLoopOverRaysAndVoxels) {
  const Intrinsics camera = Intrinsics::from_field_of_view(72, 54, to_radians(80), to_radians(64));
  const BoxScene scene;
  for (const bool inverse_square : {true, false}) {
    TsdfConfig config;
    config.carve = false;
    config.inverse_square_weight = inverse_square;
    config.voxel_m = inverse_square ? 0.05 : 0.033;
    config.max_depth_m = inverse_square ? 5.0 : 2.1;
    TsdfVolume volume(config);
    ReferenceMap reference(config);
    GroupedRayIntegrator integrator(config);
    for (int i = 0; i < 3; ++i) {
      const Pose X_WC = look_at({-0.31 + 0.37 * i, -1.13, 1.37}, {0.113, 0.913, 0.427 - 0.1 * i});
      const LabelledFrame in = view(scene, camera, X_WC, true, 100 + i);
      integrator.integrate(in.frame, camera, in.labels, X_WC, volume);
      reference.integrate(in, camera, X_WC);
    }
    std::size_t compared = 0, several = 0;
    for (std::size_t b = 0; b < volume.size(); ++b) {
      const TsdfBlock& block = volume.block(b);
      ASSERT_NE(block.surface, nullptr);
      for (int v = 0; v < TsdfVolume::kVoxels; ++v) {
        const Index index{block.index.x() * 8 + v % 8, block.index.y() * 8 + v / 8 % 8, block.index.z() * 8 + v / 64};
        const TsdfVoxel& voxel = block.surface->voxels[static_cast<std::size_t>(v)];
        const auto labels = block.surface->labels.all(v);
        const auto found = reference.voxels.find(index);
        if (found == reference.voxels.end()) {
          ASSERT_EQ(voxel.weight, 0.0f) << index[0] << " " << index[1] << " " << index[2];
          ASSERT_TRUE(labels.empty());
          continue;
        }
        const ReferenceVoxel& expected = found->second;
        ASSERT_NEAR(voxel.weight, expected.weight, 1e-4 * expected.weight + 2e-5);
        // The ramp behind the surface ends at weight 0, where a distance is the ratio of two vanishing sums.
        if (expected.weight > 1e-2) {
          ASSERT_NEAR(voxel.distance, expected.distance, 1e-5);
          // Colours are rounded to whole steps with every ray.
          for (int k = 0; k < 3; ++k) ASSERT_NEAR(voxel.colour[static_cast<std::size_t>(k)], expected.colour[k], 8.0);
        }
        ASSERT_EQ(voxel.surface_frames, expected.frames);
        ASSERT_EQ(labels.size(), expected.labels.size());
        for (const auto& [label, count] : labels) ASSERT_EQ(static_cast<int>(count), expected.labels.at(label));
        several += labels.size() > 1;
        ++compared;
      }
    }
    EXPECT_EQ(compared, reference.voxels.size());
    EXPECT_GT(compared, 10000u);
    EXPECT_GT(several, 5u);
  }
}

TEST(GroupedRayIntegrator, SameBytesAtAnyThreadCount) {
  const Intrinsics camera = Intrinsics::from_field_of_view(320, 180, to_radians(80), to_radians(50));
  const BoxScene scene;
  std::vector<std::string> digests;
  for (const int threads : {1, 2, 4}) {
    set_thread_count(threads);
    TsdfConfig config;
    TsdfVolume volume(config);
    GroupedRayIntegrator integrator(config);
    for (int i = 0; i < 4; ++i) {
      const Pose X_WC = look_at({-0.3 + 0.2 * i, -1.1, 1.4}, {0.1, 0.9, 0.4});
      const LabelledFrame in = view(scene, camera, X_WC, true, i);
      integrator.integrate(in.frame, camera, in.labels, X_WC, volume);
    }
    Digest digest;
    volume.add_to(digest);
    digests.push_back(digest.hex());
  }
  set_thread_count(0);
  EXPECT_EQ(digests[0], digests[1]);
  EXPECT_EQ(digests[0], digests[2]);
}

TEST(GroupedRayIntegrator, RefusesAMapOfAnotherVoxelSize) {
  TsdfConfig config;
  TsdfVolume volume(config);
  config.voxel_m = 0.05;
  GroupedRayIntegrator integrator(config);
  const Intrinsics camera = Intrinsics::from_field_of_view(16, 12, 1.0, 0.8);
  const LabelledFrame in = view(BoxScene(), camera, look_at({0, -1, 1}, {0, 1, 1}), false);
  try {
    integrator.integrate(in.frame, camera, in.labels, look_at({0, -1, 1}, {0, 1, 1}), volume);
    FAIL();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("voxel_m"), std::string::npos) << e.what();
  }
}

TEST(GroupedRayIntegrator, RefusesAPoseBeyondTheMap) {
  TsdfConfig config;
  TsdfVolume volume(config);
  const Intrinsics camera = Intrinsics::from_field_of_view(16, 12, 1.0, 0.8);
  const LabelledFrame in = view(BoxScene(), camera, look_at({0, -1, 1}, {0, 1, 1}), false);
  for (const double x : {1e6, -1e300, std::numeric_limits<double>::quiet_NaN()}) {
    Pose X_WC = Pose::Identity();
    X_WC.translation().x() = x;
    EXPECT_THROW(GroupedRayIntegrator(config).integrate(in.frame, camera, in.labels, X_WC, volume), Error);
  }
}

TEST(GroupedRayIntegrator, InvalidDepthDoesNothing) {
  const Intrinsics camera = Intrinsics::from_field_of_view(32, 24, 1.0, 0.8);
  RgbdFrame frame;
  frame.depth = cv::Mat(24, 32, CV_32FC1, cv::Scalar(0));
  frame.depth.at<float>(3, 3) = std::numeric_limits<float>::quiet_NaN();
  frame.depth.at<float>(4, 3) = -1.0f;
  frame.depth.at<float>(5, 3) = 1e9f;
  frame.colour = cv::Mat(24, 32, CV_8UC3, cv::Scalar(1, 2, 3));
  TsdfConfig config;
  TsdfVolume volume(config);
  GroupedRayIntegrator(config).integrate(frame, camera, {}, Pose::Identity(), volume);
  EXPECT_EQ(volume.size(), 0u);
}

TEST(FreeSpace, EqualsASlowTestOfEveryVoxel) {
  const Intrinsics camera = Intrinsics::from_field_of_view(160, 120, to_radians(80), to_radians(64));
  const BoxScene scene;
  TsdfConfig config;
  config.voxel_m = 0.05;
  const Pose X_WC = look_at({-0.31, -1.13, 1.37}, {0.113, 0.913, 0.427});
  const LabelledFrame in = view(scene, camera, X_WC, false);
  std::set<Index> free;
  for (const FreeBlock& block : find_free_space(in.frame, camera, X_WC, config)) {
    for (int v = 0; v < 512; ++v) {
      if (block.voxels[static_cast<std::size_t>(v / 64)] >> (v % 64) & 1u) {
        free.insert({block.index.x() * 8 + v % 8, block.index.y() * 8 + v / 8 % 8, block.index.z() * 8 + v / 64});
      }
    }
  }
  // Sound: the ray to a free voxel's centre goes on for the truncation distance at least. Complete, but for the rims: a voxel is found
  // free when all of its surroundings of two footprints are.
  const Pose X_CW = X_WC.inverse();
  std::size_t should = 0, found = 0;
  for (int x = -45; x < 45; ++x) {
    for (int y = -45; y < 45; ++y) {
      for (int z = -5; z < 60; ++z) {
        const Eigen::Vector3d p_C = X_CW * ((Eigen::Vector3d(x, y, z).array() + 0.5) * config.voxel_m).matrix();
        const bool is_free = free.contains({x, y, z});
        if (p_C.z() < config.voxel_m) {
          ASSERT_FALSE(is_free);
          continue;
        }
        const Eigen::Vector2d pixel = camera.project(p_C);
        if (!camera.contains(pixel.x(), pixel.y())) {
          // Blocks decided at once lie whole in the picture.
          ASSERT_FALSE(is_free);
          continue;
        }
        const auto at = [&](double u, double v) {
          const int iu = std::clamp(static_cast<int>(std::round(u)), 0, camera.width - 1);
          const int iv = std::clamp(static_cast<int>(std::round(v)), 0, camera.height - 1);
          return static_cast<double>(in.frame.depth.at<float>(iv, iu));
        };
        if (is_free) {
          ASSERT_GT(at(pixel.x(), pixel.y()), p_C.z() + config.truncation_m() - 0.01) << x << " " << y << " " << z;
        }
        const double reach = 4.0 * camera.fx * config.voxel_m / p_C.z() + 4.0;
        bool all = true;
        for (double u = pixel.x() - reach; u <= pixel.x() + reach; u += 1.0) {
          for (double v = pixel.y() - reach; v <= pixel.y() + reach; v += 1.0)
            all = all && at(u, v) > p_C.z() + config.truncation_m() + 0.01;
        }
        should += all;
        found += all && is_free;
      }
    }
  }
  EXPECT_GT(should, 5000u);
  EXPECT_EQ(found, should);
}

TEST(FreeSpace, NeverClearsWhatTheSameFrameSeesAsSurface) {
  const Intrinsics camera = Intrinsics::from_field_of_view(320, 240, to_radians(80), to_radians(64));
  TsdfConfig config;
  // Low over the floor, where rays graze.
  const Pose X_WC = look_at({0.0, -1.5, 0.12}, {0.0, 1.5, 0.05});
  const LabelledFrame in = view(BoxScene(), camera, X_WC, true);
  TsdfVolume volume(config);
  GroupedRayIntegrator(config).integrate(in.frame, camera, in.labels, X_WC, volume);
  std::size_t groups = 0;
  for (const PointGroup& group : group_points(in.frame, camera, in.labels, X_WC, config)) {
    const TsdfBlock* block = volume.find_block(TsdfVolume::block_of(group.voxel));
    ASSERT_NE(block, nullptr);
    ASSERT_EQ(block->free_frames[static_cast<std::size_t>(TsdfVolume::offset_of(group.voxel))], 0);
    ++groups;
  }
  EXPECT_GT(groups, 3000u);
}

TEST(TsdfVolume, TakesOutWhatWasSeenThroughOften) {
  const Intrinsics camera = Intrinsics::from_field_of_view(160, 120, to_radians(70), to_radians(55));
  const Pose X_WC = look_at({0.0, -1.3, 1.2}, {0.0, 1.5, 0.3});
  const BoxScene full;
  BoxScene empty = full;
  empty.boxes.clear();
  TsdfConfig config;
  config.voxel_m = 0.04;
  TsdfVolume volume(config);
  GroupedRayIntegrator integrator(config);
  const auto add = [&](const BoxScene& scene, int times) {
    const LabelledFrame in = view(scene, camera, X_WC, false);
    for (int i = 0; i < times; ++i) integrator.integrate(in.frame, camera, in.labels, X_WC, volume);
  };
  const Eigen::Vector3d front(-0.5, 0.5 + 0.01, 0.7), before(-0.5, 0.2, 0.7), behind(-0.5, 1.6, 0.2);
  add(full, 2);
  EXPECT_EQ(volume.state_at(front), VoxelState::occupied);
  EXPECT_EQ(volume.label(volume.voxel_at(front)), 1);
  EXPECT_EQ(volume.state_at(before), VoxelState::free);
  EXPECT_EQ(volume.state_at(behind), VoxelState::unknown);
  EXPECT_EQ(volume.state_at({50, 50, 50}), VoxelState::unknown);
  EXPECT_EQ(volume.state_at({1e300, 0, 0}), VoxelState::unknown);
  add(empty, 4);
  EXPECT_EQ(volume.state_at(front), VoxelState::occupied);
  add(empty, 1);
  EXPECT_EQ(volume.state_at(front), VoxelState::free);
  EXPECT_EQ(volume.find_voxel(volume.voxel_at(front)), nullptr);
  add(full, 1);
  EXPECT_EQ(volume.state_at(front), VoxelState::occupied);
}

TEST(TsdfVolume, MergesLabels) {
  const Intrinsics camera = Intrinsics::from_field_of_view(160, 120, to_radians(70), to_radians(55));
  const Pose X_WC = look_at({0.0, -1.3, 1.2}, {0.0, 1.5, 0.3});
  TsdfConfig config;
  TsdfVolume volume(config);
  const LabelledFrame in = view(BoxScene(), camera, X_WC, false);
  GroupedRayIntegrator(config).integrate(in.frame, camera, in.labels, X_WC, volume);
  const Eigen::Vector3i on_one = volume.voxel_at({-0.5, 0.51, 0.5}), on_two = volume.voxel_at({0.6, 0.71, 0.3});
  ASSERT_EQ(volume.label(on_one), 1);
  ASSERT_EQ(volume.label(on_two), 2);
  volume.merge_labels(1, 2);
  EXPECT_EQ(volume.label(on_one), 2);
  EXPECT_EQ(volume.label(on_two), 2);
}

}  // namespace
}  // namespace waretwin

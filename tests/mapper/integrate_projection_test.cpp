// Integration by projection against plain loops over voxels, and what it does with things that move.
#include <gtest/gtest.h>

#include <array>
#include <map>
#include <set>

#include "core/error.h"
#include "mapper/integrate/mesher.h"
#include "mapper/integrate/projective_integrator.h"
#include "mapper/integrate/surface_patches.h"
#include "mapper/output/map_archive.h"
#include "tests/mapper/integrate_scene.h"
#include "tests/support/test_data.h"

namespace waretwin {
namespace {

using test::BoxScene;
using test::LabelledFrame;
using test::look_at;
using test::view;

using Index = std::array<int, 3>;

TsdfConfig projection_config() {
  TsdfConfig config;
  config.method = "projection";
  config.mesh_min_weight = 0.02;
  return config;
}

std::string digest(const TsdfVolume& volume) {
  Digest d;
  volume.add_to(d);
  return d.hex();
}

// Random labels in squares of random size, each pixel changed now and then.
std::vector<std::int32_t> random_labels(const Intrinsics& camera, std::uint64_t seed, int labels) {
  const RandomStream random(seed, "labels", "test");
  std::vector<std::int32_t> out;
  const int square = 3 + static_cast<int>(seed % 7);
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const auto pixel = static_cast<std::uint64_t>(v * camera.width + u);
      const auto cell = static_cast<std::uint64_t>(1000000 + v / square * 1000 + u / square);
      out.push_back(static_cast<std::int32_t>(random.uniform(random.uniform(pixel) < 0.2 ? pixel + 5000000 : cell) * labels));
    }
  }
  return out;
}

TEST(SurfacePatches, LieInAPlaneSeenAtAnyAngle) {
  const Intrinsics camera = Intrinsics::from_field_of_view(640, 360, to_radians(90), to_radians(59));
  BoxScene scene;
  scene.boxes.clear();
  scene.room.low = {-50, -50, 0};
  scene.room.high = {50, 50, 50};
  TsdfConfig config = projection_config();
  config.projection.grow_weight = 0.0;
  for (const double ahead : {0.1, 1.0, 3.0}) {
    const Pose X_WC = look_at({0, 0, 1.4}, {0, ahead, 0});
    const PatchImage image = make_patches(view(scene, camera, X_WC, false).frame, camera, {}, config);
    const Eigen::Vector3f normal = (X_WC.linear().transpose() * Eigen::Vector3d(0, 0, -1)).cast<float>();
    int patches = 0;
    for (int y = 1; y + 1 < image.height; ++y) {
      for (int x = 1; x + 1 < image.width; ++x) {
        const SurfacePatch& patch = image.at(x, y);
        if (patch.weight <= 0.0f) continue;
        ++patches;
        // Depth comes in whole millimetres.
        ASSERT_NEAR(patch.h, 1.4f, 0.03f);
        const float z = patch.depth;
        const Eigen::Vector3f p = z * camera.ray((x + 0.5) * image.patch_px - 0.5, (y + 0.5) * image.patch_px - 0.5).cast<float>();
        ASSERT_NEAR(normal.dot(p), 1.4f, 0.002f);
        ASSERT_GT(normal.dot(Eigen::Vector3f(patch.nx, patch.ny, patch.nz)), std::cos(to_radians(3.0)));
        ASSERT_NEAR(patch.weight, normal.dot(p) / p.norm() / (z * z), 0.02f / (z * z));
      }
    }
    EXPECT_GT(patches, image.width * image.height / 4) << ahead;
  }
}

TEST(SurfacePatches, MakeNoSurfaceOfFlyingPixels) {
  const Intrinsics camera = Intrinsics::from_field_of_view(1280, 720, to_radians(90), to_radians(59));
  RgbdFrame frame;
  frame.depth = cv::Mat(720, 1280, CV_32FC1, cv::Scalar(1.0f));
  frame.colour = cv::Mat(720, 1280, CV_8UC3, cv::Scalar(0, 0, 0));
  // A near half and a far half, and three columns that mix both.
  for (int v = 0; v < 720; ++v) {
    for (int u = 640; u < 1280; ++u) frame.depth.at<float>(v, u) = 2.0f;
    for (int u = 638; u < 641; ++u) frame.depth.at<float>(v, u) = 1.25f + 0.25f * static_cast<float>(u - 638);
  }
  for (const int px : {1, 2, 4}) {
    TsdfConfig config = projection_config();
    config.projection.patch_px = px;
    const PatchImage image = make_patches(frame, camera, {}, config);
    int near = 0, far = 0;
    for (const SurfacePatch& patch : image.patches) {
      if (patch.weight <= 0.0f) continue;
      ASSERT_TRUE(std::abs(patch.h - 1.0f) < 0.01f || std::abs(patch.h - 2.0f) < 0.01f) << px << ": " << patch.h;
      (patch.h < 1.5f ? near : far) += 1;
    }
    EXPECT_GT(near, (620 / px) * (710 / px));
    EXPECT_GT(far, (620 / px) * (710 / px));
  }
}

// A plate before nothing.
TEST(SurfacePatches, GrowByOneOverTheRim) {
  const Intrinsics camera = Intrinsics::from_field_of_view(1280, 720, to_radians(90), to_radians(59));
  RgbdFrame frame;
  frame.depth = cv::Mat(720, 1280, CV_32FC1, cv::Scalar(0.0f));
  frame.colour = cv::Mat(720, 1280, CV_8UC3, cv::Scalar(10, 20, 30));
  frame.depth(cv::Rect(400, 200, 400, 300)).setTo(1.5f);  // patches of 4 pixels: columns 100 to 199, rows 50 to 124
  std::vector<std::int32_t> labels(std::size_t{1280} * 720, 7);
  TsdfConfig config = projection_config();
  config.projection.patch_px = 4;
  config.projection.grow_weight = 0.0;
  const PatchImage measured = make_patches(frame, camera, labels, config);
  config.projection.grow_weight = 0.1;
  const PatchImage grown = make_patches(frame, camera, labels, config);
  int rim = 0;
  for (int y = 0; y < grown.height; ++y) {
    for (int x = 0; x < grown.width; ++x) {
      const bool across = x >= 100 && x < 200, down = y >= 50 && y < 125;
      const bool beside = (across && (y == 49 || y == 125)) || (down && (x == 99 || x == 200));
      const SurfacePatch& patch = grown.at(x, y);
      ASSERT_EQ(measured.at(x, y).weight > 0.0f, across && down) << x << " " << y;
      if (across && down) {
        ASSERT_EQ(patch.weight, measured.at(x, y).weight);
      } else if (beside) {
        const SurfacePatch& from = grown.at(std::clamp(x, 100, 199), std::clamp(y, 50, 124));
        ASSERT_FLOAT_EQ(patch.weight, 0.1f * from.weight);
        ASSERT_NEAR(patch.h, 1.5f, 1e-4f);
        ASSERT_EQ(patch.label, 7);
        ASSERT_EQ(patch.red, 30);
        ++rim;
      } else {
        ASSERT_EQ(patch.weight, 0.0f) << x << " " << y;
      }
    }
  }
  EXPECT_EQ(rim, 2 * 100 + 2 * 75);
}

TEST(SurfacePatches, CarryTheLabelOfMostOfTheirPixels) {
  const Intrinsics camera = Intrinsics::from_field_of_view(323, 181, to_radians(80), to_radians(50));
  TsdfConfig config = projection_config();
  config.projection.patch_px = 4;
  config.projection.grow_weight = 0.0;
  const Pose X_WC = look_at({-0.31, -1.13, 1.37}, {0.113, 0.913, 0.427});
  const LabelledFrame in = view(BoxScene(), camera, X_WC, true);
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    const std::vector<std::int32_t> labels = random_labels(camera, seed, 2 + static_cast<int>(seed) * 3);
    const PatchImage image = make_patches(in.frame, camera, labels, config);
    int compared = 0, mixed = 0;
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        if (image.at(x, y).weight <= 0.0f) continue;
        std::map<std::int32_t, int> counts;
        double near = 1e9, far = 0.0;
        for (int v = 4 * y; v < std::min(camera.height, 4 * y + 4); ++v) {
          for (int u = 4 * x; u < std::min(camera.width, 4 * x + 4); ++u) {
            const double z = in.frame.depth.at<float>(v, u);
            if (!(z > 0.0) || z > config.max_depth_m) continue;
            near = std::min(near, z);
            far = std::max(far, z);
            ++counts[labels[static_cast<std::size_t>(v * camera.width + u)]];
          }
        }
        if (far - near > 0.04) continue;  // may be cut in two
        std::int32_t best = 0;
        int most = 0;
        for (const auto& [label, count] : counts) {
          if (count > most) {
            most = count;
            best = label;
          }
        }
        ++compared;
        mixed += counts.size() > 1;
        // Pixels without depth have no say, but where all sixteen agree.
        ASSERT_EQ(image.at(x, y).label, best);
      }
    }
    EXPECT_GT(compared, 500);
    EXPECT_GT(mixed, 300);
  }
}

struct ReferenceVoxel {
  double distance = 0.0, weight = 0.0;
  std::map<std::int32_t, int> labels;
  int frames = 0;
  bool borderline = false;  // rounding decides about it in some frame
};

// Every voxel of a box of space, one after the other, in doubles.
class ReferenceMap {
 public:
  explicit ReferenceMap(const TsdfConfig& config) : config_(config) {}

  void integrate(const PatchImage& image, const Intrinsics& camera, const Pose& X_WC) {
    const Pose X_CW = X_WC.inverse();
    const double voxel = config_.voxel_m, truncation = config_.truncation_m(), behind = config_.projection.behind_voxels * voxel;
    const double band = config_.label_band_voxels * voxel;
    const int n = static_cast<int>(std::ceil(2.8 / voxel));
    for (int x = -n; x < n; ++x) {
      for (int y = -n; y < n; ++y) {
        for (int z = -n / 8; z < n; ++z) {
          const Eigen::Vector3d p = X_CW * ((Eigen::Vector3d(x, y, z).array() + 0.5) * voxel).matrix();
          if (p.z() <= voxel) continue;
          const Eigen::Vector2d pixel = camera.project(p);
          if (!camera.contains(pixel.x(), pixel.y())) continue;
          const double across = (pixel.x() + 0.5) / image.patch_px, down = (pixel.y() + 0.5) / image.patch_px;
          const SurfacePatch& patch = image.at(static_cast<int>(across), static_cast<int>(down));
          const auto by_a_hair = [](double a) { return std::abs(a - std::round(a)) < 1e-3; };
          bool borderline = by_a_hair(across) || by_a_hair(down);
          if (patch.weight <= 0.0f) {
            if (borderline) voxels[{x, y, z}].borderline = true;
            continue;
          }
          const double ahead = Eigen::Vector3d(patch.nx, patch.ny, patch.nz).dot(p), d = patch.h - ahead;
          for (const double limit : {-behind, truncation, band, -band, -voxel}) borderline = borderline || std::abs(d - limit) < 1e-5;
          const double reach = config_.projection.along_truncations * (d > 0.0 ? truncation : behind);
          borderline = borderline || std::abs(p.z() * std::abs(d) - reach * ahead) < 1e-4;
          if (borderline) voxels[{x, y, z}].borderline = true;
          if (d < -behind || d > truncation || p.z() * std::abs(d) > reach * ahead) continue;
          ReferenceVoxel& v = voxels[{x, y, z}];
          if (std::abs(d) <= band) ++v.labels[patch.label];
          double w = patch.weight;
          if (d < -voxel) w *= (behind + d) / (behind - voxel);
          v.distance = (v.distance * v.weight + d * w) / (v.weight + w);
          v.weight += w;
          if (d >= -voxel) ++v.frames;
        }
      }
    }
  }

  std::map<Index, ReferenceVoxel> voxels;

 private:
  TsdfConfig config_;
};

TEST(ProjectiveIntegrator, EqualsAPlainLoopOverVoxels) {
  const Intrinsics camera = Intrinsics::from_field_of_view(160, 120, to_radians(80), to_radians(64));
  for (const bool plane : {true, false}) {
    TsdfConfig config = projection_config();
    config.voxel_m = plane ? 0.05 : 0.04;
    config.carve = false;
    config.projection.forget = false;
    config.projection.plane_distance = plane;
    config.projection.behind_voxels = plane ? 2.0 : 3.0;
    config.projection.patch_px = plane ? 2 : 1;
    TsdfVolume volume(config);
    ReferenceMap reference(config);
    ProjectiveIntegrator integrator(config);
    for (int i = 0; i < 4; ++i) {
      const Pose X_WC = look_at({-0.31 + 0.37 * i, -1.13, 1.37}, {0.113, 0.913, 0.427 - 0.1 * i});
      LabelledFrame in = view(BoxScene(), camera, X_WC, true, 100 + i);
      in.labels = random_labels(camera, static_cast<std::uint64_t>(i), 40);
      integrator.integrate(in.frame, camera, in.labels, X_WC, volume);
      reference.integrate(make_patches(in.frame, camera, in.labels, config), camera, X_WC);
    }
    std::size_t compared = 0, several = 0, borderline = 0;
    std::set<Index> left;
    for (const auto& [index, v] : reference.voxels) {
      if (!v.borderline && v.frames + static_cast<int>(v.labels.size()) > 0) left.insert(index);
    }
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
        if (expected.borderline) {
          ++borderline;
          continue;
        }
        left.erase(index);
        ASSERT_NEAR(voxel.weight, expected.weight, 1e-4 * expected.weight + 2e-5);
        if (expected.weight > 1e-2) {
          ASSERT_NEAR(voxel.distance, expected.distance, 2e-5);
        }
        ASSERT_EQ(voxel.surface_frames, expected.frames);
        ASSERT_EQ(labels.size(), expected.labels.size());
        for (const auto& [label, count] : labels) ASSERT_EQ(static_cast<int>(count), expected.labels.at(label));
        several += labels.size() > 2;
        ++compared;
      }
    }
    EXPECT_TRUE(left.empty()) << left.size() << " voxels were not updated";
    EXPECT_GT(compared, 10000u);
    EXPECT_GT(several, 300u);
    EXPECT_LT(borderline, compared / 20);
  }
}

TEST(ProjectiveIntegrator, SameBytesAtAnyThreadCount) {
  const Intrinsics camera = Intrinsics::from_field_of_view(320, 180, to_radians(80), to_radians(50));
  std::vector<std::string> digests;
  for (const int threads : {1, 2, 4}) {
    set_thread_count(threads);
    const TsdfConfig config = projection_config();
    TsdfVolume volume(config);
    ProjectiveIntegrator integrator(config);
    for (int i = 0; i < 4; ++i) {
      const Pose X_WC = look_at({-0.3 + 0.2 * i, -1.1, 1.4}, {0.1, 0.9, 0.4});
      const LabelledFrame in = view(BoxScene(), camera, X_WC, true, i);
      integrator.integrate(in.frame, camera, in.labels, X_WC, volume);
    }
    digests.push_back(digest(volume));
  }
  set_thread_count(0);
  EXPECT_EQ(digests[0], digests[1]);
  EXPECT_EQ(digests[0], digests[2]);
}

TEST(ProjectiveIntegrator, GoesOnFromASavedMap) {
  const Intrinsics camera = Intrinsics::from_field_of_view(160, 120, to_radians(80), to_radians(64));
  TsdfConfig config = projection_config();
  config.voxel_m = 0.04;
  TsdfVolume whole(config);
  auto part = std::make_unique<TsdfVolume>(config);
  ProjectiveIntegrator integrator(config);
  const test::TemporaryFolder folder;
  for (int i = 0; i < 8; ++i) {
    const Pose X_WC = look_at({-0.3 + 0.1 * i, -1.1, 1.4}, {0.1, 0.9, 0.4});
    BoxScene scene;
    if (i >= 3) scene.boxes.resize(1);  // so that the second half forgets what the first half saw
    const LabelledFrame in = view(scene, camera, X_WC, true, i);
    integrator.integrate(in.frame, camera, in.labels, X_WC, whole);
    integrator.integrate(in.frame, camera, in.labels, X_WC, *part);
    if (i != 3) continue;
    save_map(folder.path() / "map.waretwin", {}, *part, 4);
    LoadedMap loaded = load_map(folder.path() / "map.waretwin");
    EXPECT_EQ(loaded.frames, 4);
    loaded.volume->configure(config);
    part = std::move(loaded.volume);
  }
  EXPECT_EQ(digest(whole), digest(*part));
}

// What a voxel counts as seen through lies before the measured depth by more than the truncation; what lies well before it is found.
TEST(ProjectiveIntegrator, SeesThroughWhatIsFree) {
  const Intrinsics camera = Intrinsics::from_field_of_view(160, 120, to_radians(80), to_radians(64));
  TsdfConfig config = projection_config();
  config.voxel_m = 0.05;
  TsdfVolume volume(config);
  const Pose X_WC = look_at({-0.31, -1.13, 1.37}, {0.113, 0.913, 0.427});
  const LabelledFrame in = view(BoxScene(), camera, X_WC, false);
  ProjectiveIntegrator(config).integrate(in.frame, camera, in.labels, X_WC, volume);
  const Pose X_CW = X_WC.inverse();
  std::size_t should = 0, found = 0;
  for (int x = -45; x < 45; ++x) {
    for (int y = -45; y < 45; ++y) {
      for (int z = -5; z < 60; ++z) {
        const Eigen::Vector3i voxel(x, y, z);
        const Eigen::Vector3d p_C = X_CW * volume.voxel_centre(voxel);
        const TsdfBlock* block = volume.find_block(TsdfVolume::block_of(voxel));
        const bool is_free = block && block->free_frames[static_cast<std::size_t>(TsdfVolume::offset_of(voxel))] > 0;
        if (p_C.z() < 0.45 * config.voxel_m) {
          ASSERT_FALSE(is_free);
          continue;
        }
        const Eigen::Vector2d pixel = camera.project(p_C);
        if (!camera.contains(pixel.x(), pixel.y())) {
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
        // Farther than a plane's reach from every surface around it.
        const double reach = 8.0 * camera.fx * config.voxel_m / p_C.z() + 8.0;
        const double margin = config.projection.along_truncations * config.truncation_m() + 0.01;
        bool all = true;
        for (double u = pixel.x() - reach; u <= pixel.x() + reach && all; u += 1.0) {
          for (double v = pixel.y() - reach; v <= pixel.y() + reach && all; v += 1.0) all = at(u, v) > p_C.z() + margin;
        }
        should += all;
        found += all && is_free;
      }
    }
  }
  EXPECT_GT(should, 1500u);
  EXPECT_EQ(found, should);
}

// Share of the mesh's vertices that lie more than 3 cm from the scene's surfaces.
double ghosts(const TsdfVolume& volume, const BoxScene& scene) {
  const SurfaceMesh mesh = extract_mesh(volume);
  EXPECT_GT(mesh.vertices.size(), 1000u);
  std::size_t off = 0;
  for (const Eigen::Vector3f& p : mesh.vertices) off += scene.distance(p.cast<double>()) > 0.03;
  return static_cast<double>(off) / static_cast<double>(mesh.vertices.size());
}

TEST(ProjectiveIntegrator, KeepsNoGhostOfABoxThatMoved) {
  const Intrinsics camera = Intrinsics::from_field_of_view(160, 120, to_radians(80), to_radians(64));
  TsdfConfig config = projection_config();
  config.voxel_m = 0.04;
  TsdfVolume volume(config), still(config);  // still: sees the end alone
  ProjectiveIntegrator integrator(config);
  int frame = 0;
  const auto look = [&](const BoxScene& scene, bool is_end = false) {
    const Pose X_WC = look_at({-0.2 + 0.01 * (frame % 20), -1.3, 1.3}, {0.0, 1.0, 0.2});
    const LabelledFrame in = view(scene, camera, X_WC, true, frame++);
    integrator.integrate(in.frame, camera, in.labels, X_WC, volume);
    if (is_end) integrator.integrate(in.frame, camera, in.labels, X_WC, still);
  };
  const auto moved = [](double x) {
    BoxScene scene;
    scene.boxes = {{{x, 0.2, 0.0}, {x + 0.4, 0.6, 0.5}, 9}};
    return scene;
  };
  // Stands for long, goes across the picture, and stands again.
  for (int i = 0; i < 25; ++i) look(moved(-1.2));
  // Not so far that it would hide from then on where it had been.
  for (int i = 0; i < 11; ++i) look(moved(-1.2 + 0.12 * i));
  const double before = ghosts(volume, moved(0.6));
  EXPECT_GT(before, 0.03);  // else the test shows nothing
  for (int i = 0; i < 35; ++i) look(moved(0.6), true);
  const double floor = ghosts(still, moved(0.6));
  EXPECT_LT(ghosts(volume, moved(0.6)) - floor, before / 5.0) << before << " before, " << floor << " without anything that moved";
  // It is where it stopped, and no label of it is left where it was.
  EXPECT_EQ(volume.state_at({0.8, 0.21, 0.3}), VoxelState::occupied);
  EXPECT_EQ(volume.label(volume.voxel_at({0.8, 0.21, 0.3})), 9);
  EXPECT_EQ(volume.state_at({-1.0, 0.21, 0.3}), VoxelState::free);
  EXPECT_EQ(volume.label(volume.voxel_at({-1.0, 0.21, 0.3})), 0);
}

TEST(ProjectiveIntegrator, MemoryGrowsWithTheSurfaceSeen) {
  const Intrinsics camera = Intrinsics::from_field_of_view(320, 180, to_radians(60), to_radians(36));
  const TsdfConfig config = projection_config();
  TsdfVolume volume(config);
  BoxScene floor;
  floor.boxes.clear();
  floor.room = {{-50, -50, 0}, {50, 50, 50}, 0};
  ProjectiveIntegrator integrator(config);
  std::vector<std::size_t> bytes;
  for (int i = 0; i < 4; ++i) {
    // Straight down, places that do not overlap; the same place again costs nothing.
    Pose X_WC = look_at({0, 0, 1.5}, {0, 1e-3, 0});
    X_WC.translation() = Eigen::Vector3d(4.0 * i, 0, 1.5);
    for (int k = 0; k < 3; ++k) integrator.integrate(view(floor, camera, X_WC, false, k).frame, camera, {}, X_WC, volume);
    bytes.push_back(volume.bytes());
  }
  const auto first = static_cast<double>(bytes[0]);
  EXPECT_NEAR(static_cast<double>(bytes[1]), 2.0 * first, 0.1 * first);
  EXPECT_NEAR(static_cast<double>(bytes[3]), 4.0 * first, 0.2 * first);
  std::size_t free_only = 0;
  for (std::size_t b = 0; b < volume.size(); ++b) free_only += volume.block(b).surface ? 0 : sizeof(TsdfBlock);
  EXPECT_LT(static_cast<double>(free_only), 0.25 * static_cast<double>(bytes.back()));
}

TEST(ProjectiveIntegrator, InvalidDepthDoesNothing) {
  const Intrinsics camera = Intrinsics::from_field_of_view(32, 24, 1.0, 0.8);
  RgbdFrame frame;
  frame.depth = cv::Mat(24, 32, CV_32FC1, cv::Scalar(0));
  frame.depth.at<float>(3, 3) = std::numeric_limits<float>::quiet_NaN();
  frame.depth.at<float>(4, 3) = -1.0f;
  frame.depth.at<float>(5, 3) = 1e9f;
  frame.depth.at<float>(6, 3) = std::numeric_limits<float>::infinity();
  frame.colour = cv::Mat(24, 32, CV_8UC3, cv::Scalar(1, 2, 3));
  const TsdfConfig config = projection_config();
  TsdfVolume volume(config);
  ProjectiveIntegrator(config).integrate(frame, camera, {}, Pose::Identity(), volume);
  EXPECT_EQ(volume.size(), 0u);
}

TEST(ProjectiveIntegrator, RefusesAnotherGridAndAPoseBeyondTheMap) {
  TsdfConfig config = projection_config();
  TsdfVolume volume(config);
  const Intrinsics camera = Intrinsics::from_field_of_view(16, 12, 1.0, 0.8);
  const LabelledFrame in = view(BoxScene(), camera, look_at({0, -1, 1}, {0, 1, 1}), false);
  for (const double x : {1e6, -1e300, std::numeric_limits<double>::quiet_NaN()}) {
    Pose X_WC = Pose::Identity();
    X_WC.translation().x() = x;
    EXPECT_THROW(ProjectiveIntegrator(config).integrate(in.frame, camera, in.labels, X_WC, volume), Error);
  }
  config.voxel_m = 0.05;
  try {
    ProjectiveIntegrator(config).integrate(in.frame, camera, in.labels, look_at({0, -1, 1}, {0, 1, 1}), volume);
    FAIL();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("voxel_m"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace waretwin

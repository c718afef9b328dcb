#include <gtest/gtest.h>
#include <zlib.h>

#include <cstring>
#include <random>

#include "core/digest.h"
#include "core/error.h"
#include "core/files.h"
#include "mapper/integrate/grouped_ray_integrator.h"
#include "mapper/output/map_archive.h"
#include "tests/mapper/integrate_scene.h"
#include "tests/support/test_data.h"

namespace waretwin {
namespace {

constexpr std::size_t kHeader = 20;

struct Map {
  ObjectList objects;
  TsdfVolume volume;
};

Map make_map(double voxel_m) {
  TsdfConfig config;
  config.voxel_m = voxel_m;
  Map map{{}, TsdfVolume(config)};
  const Intrinsics camera = Intrinsics::from_field_of_view(64, 48, to_radians(80), to_radians(64));
  GroupedRayIntegrator integrator(config);
  for (int i = 0; i < 2; ++i) {
    const Pose X_WC = test::look_at({-0.3 + 0.5 * i, -1.1, 1.4}, {0.1, 0.9, 0.4});
    const test::LabelledFrame in = test::view(test::BoxScene(), camera, X_WC, true, i);
    integrator.integrate(in.frame, camera, in.labels, X_WC, map.volume);
  }
  MappedObject o;
  o.id = 3;
  o.class_name = "conveyor";
  o.cuboid.centre = {1.0, 2.0, 3.0};
  o.cuboid.size = {0.3, 0.2, 0.1};
  o.cuboid.yaw = 0.1;
  o.score = 0.6f;
  o.first_frame = 2;
  o.last_frame = 9;
  o.observations = 5;
  o.box = {1.0f, 2.0f, 30.0f, 40.0f};
  o.hsv = {0.1f, 0.2f, 0.7f};
  o.points_W = {{1.0f, 2.0f, 3.0f}, {-0.5f, 0.0f, 0.25f}};
  map.objects = {o, o};
  map.objects[1].id = 4;
  map.objects[1].hsv.clear();
  return map;
}

std::string digest(const TsdfVolume& volume) {
  Digest d;
  volume.add_to(d);
  return d.hex();
}

TEST(MapArchive, ComesBackBitForBit) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "map.waretwin";
  const Map map = make_map(0.05);
  save_map(file, map.objects, map.volume);
  const LoadedMap loaded = load_map(file);
  EXPECT_EQ(digest(*loaded.volume), digest(map.volume));
  EXPECT_EQ(loaded.volume->size(), map.volume.size());
  ASSERT_EQ(loaded.objects.size(), 2u);
  const MappedObject &a = map.objects[0], &b = loaded.objects[0];
  EXPECT_EQ(b.id, a.id);
  EXPECT_EQ(b.class_name, a.class_name);
  EXPECT_EQ(b.cuboid.centre, a.cuboid.centre);
  EXPECT_EQ(b.cuboid.size, a.cuboid.size);
  EXPECT_EQ(b.cuboid.yaw, a.cuboid.yaw);
  EXPECT_EQ(b.cuboid.frame, a.cuboid.frame);
  EXPECT_EQ(b.score, a.score);
  EXPECT_EQ(b.first_frame, a.first_frame);
  EXPECT_EQ(b.last_frame, a.last_frame);
  EXPECT_EQ(b.observations, a.observations);
  EXPECT_EQ(b.box, a.box);
  EXPECT_EQ(b.hsv, a.hsv);
  EXPECT_EQ(b.points_W, a.points_W);
  // Written again, the same bytes; going on with the loaded map ends where going on with the first one does.
  const auto again = folder.path() / "again.waretwin";
  save_map(again, loaded.objects, *loaded.volume);
  EXPECT_EQ(read_file(again), read_file(file));
}

TEST(MapArchive, GoesOnWhereItStopped) {
  const test::TemporaryFolder folder;
  Map map = make_map(0.05);
  save_map(folder.path() / "map.waretwin", map.objects, map.volume);
  LoadedMap loaded = load_map(folder.path() / "map.waretwin");
  const Intrinsics camera = Intrinsics::from_field_of_view(64, 48, to_radians(80), to_radians(64));
  const Pose X_WC = test::look_at({0.5, -1.3, 1.2}, {0.0, 0.9, 0.4});
  const test::LabelledFrame in = test::view(test::BoxScene(), camera, X_WC, true, 7);
  GroupedRayIntegrator integrator(map.volume.config());
  integrator.integrate(in.frame, camera, in.labels, X_WC, map.volume);
  integrator.integrate(in.frame, camera, in.labels, X_WC, *loaded.volume);
  EXPECT_EQ(digest(*loaded.volume), digest(map.volume));
}

TEST(MapArchive, EveryCutAndFlipIsAnError) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "map.waretwin";
  const Map map = make_map(0.2);
  save_map(file, map.objects, map.volume);
  const std::string bytes = read_file(file);
  std::mt19937 random(3);
  for (int i = 0; i < 300; ++i) {
    std::string bad = bytes;
    if (i % 2 == 0) {
      bad.resize(i < 60 ? static_cast<std::size_t>(i) : random() % bytes.size());
    } else {
      bad[i < 60 ? static_cast<std::size_t>(i) : random() % bytes.size()] ^= static_cast<char>(1 << random() % 8);
    }
    write_file(file, bad);
    try {
      load_map(file);
      FAIL() << "case " << i;
    } catch (const Error& e) {
      const std::string message = e.what();
      EXPECT_NE(message.find("map.waretwin"), std::string::npos) << message;
      EXPECT_EQ(message.find('\n'), std::string::npos);
    }
  }
  EXPECT_THROW(load_map(folder.path() / "none.waretwin"), Error);
}

// Damage under a valid fingerprint, as a hostile file would have it: an Error or a readable map, never a crash or a huge allocation.
TEST(MapArchive, HostileContentIsChecked) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "map.waretwin";
  const Map map = make_map(0.3);
  save_map(file, map.objects, map.volume);
  const std::string bytes = read_file(file);
  std::string body(64 << 20, '\0');
  uLongf size = body.size();
  ASSERT_EQ(uncompress(reinterpret_cast<Bytef*>(body.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()) + kHeader,
                       bytes.size() - kHeader),
            Z_OK);
  body.resize(size);
  const auto sealed = [&](const std::string& content) {
    std::string packed(compressBound(content.size()), '\0');
    uLongf length = packed.size();
    compress2(reinterpret_cast<Bytef*>(packed.data()), &length, reinterpret_cast<const Bytef*>(content.data()), content.size(), 1);
    packed.resize(length);
    Digest d;
    d.add_bytes(packed.data(), packed.size());
    const std::uint64_t print = d.value();
    std::string out = bytes.substr(0, kHeader);
    std::memcpy(out.data() + 12, &print, sizeof print);
    return out + packed;
  };
  write_file(file, sealed(body));
  EXPECT_EQ(digest(*load_map(file).volume), digest(map.volume));
  std::mt19937 random(4);
  int refused = 0;
  for (int i = 0; i < 200; ++i) {
    std::string bad = body;
    if (i % 4 == 0) {
      bad.resize(random() % body.size());
    } else {
      // The head of the body, with all its counts and limits, gets most of the damage.
      const std::size_t at = i % 4 == 1 ? random() % body.size() : random() % 600;
      for (std::size_t k = at; k < std::min(body.size(), at + 1 + random() % 8); ++k) bad[k] = static_cast<char>(random());
    }
    write_file(file, sealed(bad));
    try {
      load_map(file);
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 60);
  write_file(file, sealed(body + "x"));
  EXPECT_THROW(load_map(file), Error);
}

}  // namespace
}  // namespace waretwin

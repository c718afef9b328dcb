#include "harness/report/page_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "core/error.h"
#include "core/files.h"
#include "mapper/output/map_files.h"
#include "tests/support/test_data.h"

namespace waretwin {
namespace {

// A wavy sheet of n x n vertices over 4 m x 4 m; the half with x > 2 belongs to object 7.
PageMesh sheet(int n) {
  PageMesh mesh;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const float x = 4.0f * static_cast<float>(i) / static_cast<float>(n - 1),
                  y = 4.0f * static_cast<float>(j) / static_cast<float>(n - 1);
      mesh.vertices.emplace_back(x, y, 0.2f * std::sin(3.0f * x));
      mesh.colours.push_back({static_cast<std::uint8_t>(i % 256), static_cast<std::uint8_t>(j % 256), 9});
      mesh.labels.push_back(x > 2.0f ? 7 : 0);
    }
  }
  for (int j = 0; j + 1 < n; ++j) {
    for (int i = 0; i + 1 < n; ++i) {
      const auto at = [n](int x, int y) { return static_cast<std::uint32_t>(y * n + x); };
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
      mesh.triangles.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

template <class T>
T number(const std::string& bytes, std::size_t index) {
  T value;
  std::memcpy(&value, bytes.data() + index * sizeof(T), sizeof(T));
  return value;
}

TEST(PackedMesh, IsOffByAtMostHalfAStep) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> far(-30.0f, 50.0f);
  PageMesh mesh;
  for (int i = 0; i < 3000; ++i) {
    mesh.vertices.emplace_back(far(random), far(random), 0.1f * far(random));
    mesh.colours.push_back({static_cast<std::uint8_t>(i), 2, 3});
    mesh.labels.push_back(i % 3 == 0 ? 0 : i % 3 == 1 ? 5 : 1000000);
  }
  for (std::uint32_t i = 0; i + 2 < 3000; ++i) mesh.triangles.push_back({i, i + 1, i + 2});
  const PackedMesh bytes = packed(mesh);
  EXPECT_LE(bytes.step, 80.0f / 65535.0f + 1e-6f);
  ASSERT_EQ(bytes.positions.size(), 6u * 3000u);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const int axis = static_cast<int>(k);
      const float back = bytes.low[axis] + bytes.step * static_cast<float>(number<std::uint16_t>(bytes.positions, 3 * i + k));
      // Half a step, and what float itself rounds at 50 m.
      EXPECT_NEAR(back, mesh.vertices[i][axis], 0.5f * bytes.step + 1e-5f);
    }
    EXPECT_EQ(bytes.label_ids.at(number<std::uint16_t>(bytes.labels, i)), mesh.labels[i]);
  }
  EXPECT_EQ(bytes.label_ids, (std::vector<std::int32_t>{0, 5, 1000000}));
  ASSERT_EQ(bytes.indices.size(), 2998u * 6u) << "few vertices have short indices";
  EXPECT_EQ(number<std::uint16_t>(bytes.indices, 4), 2);
}

TEST(PackedMesh, TakesLongIndicesForManyVertices) {
  const PackedMesh bytes = packed(sheet(300));
  EXPECT_EQ(bytes.indices.size(), 2u * 299u * 299u * 12u);
  EXPECT_TRUE(packed(PageMesh{}).positions.empty());
}

TEST(ThinnedMesh, KeepsToItsBudgetAndNearTheSurface) {
  const PageMesh mesh = sheet(200);
  for (const std::size_t most : {20000u, 3000u, 200u}) {
    const PageMesh few = thinned(mesh, most);
    EXPECT_LE(few.triangles.size(), most);
    EXPECT_GE(few.triangles.size(), most / 4) << "no thinner than needed";
    for (const auto& t : few.triangles) {
      EXPECT_TRUE(t[0] != t[1] && t[1] != t[2] && t[2] != t[0]);
      for (const std::uint32_t v : t) ASSERT_LT(v, few.vertices.size());
    }
    const double cell = std::sqrt(2.0 * 18.0 / static_cast<double>(most));
    for (const Eigen::Vector3f& p : few.vertices) {
      EXPECT_NEAR(p.z(), 0.2f * std::sin(3.0f * p.x()), 2.0 * cell * cell + 0.01) << "a mean of points of the sheet";
    }
  }
  EXPECT_EQ(thinned(mesh, mesh.triangles.size()).vertices.size(), mesh.vertices.size()) << "small enough comes back as it is";
  EXPECT_EQ(thinned(PageMesh{}, 10).triangles.size(), 0u);
}

TEST(ThinnedMesh, NeverMixesObjects) {
  const PageMesh few = thinned(sheet(200), 500);
  float largest_background = 0.0f, smallest_object = 4.0f;
  for (std::size_t i = 0; i < few.vertices.size(); ++i) {
    if (few.labels[i] == 0) largest_background = std::max(largest_background, few.vertices[i].x());
    if (few.labels[i] == 7) smallest_object = std::min(smallest_object, few.vertices[i].x());
  }
  EXPECT_LE(largest_background, 2.0f);
  EXPECT_GT(smallest_object, 2.0f);
}

TEST(FirstSeen, SaysWhichCameraHadAVertexInViewFirst) {
  PageMesh mesh;
  mesh.vertices = {{0, 0, 2}, {0, 0, 3}, {0, 0, 9}, {5, 0, 2}, {0, 0, -2}};  // before, behind it, too far, aside, behind the camera
  SeeingCamera camera{Pose::Identity(), 100, 100, 64, 48, 128, 96, 5.0};
  SeeingCamera aside = camera;
  aside.X_WC.translation().x() = 5.0;
  EXPECT_EQ(first_seen(mesh, {camera, aside}), (std::vector<std::uint8_t>{0, 1, 1, 1, 1}));
  EXPECT_EQ(first_seen(mesh, {aside, camera}), (std::vector<std::uint8_t>{1, 1, 1, 0, 1}));
  EXPECT_EQ(first_seen(mesh, {}), std::vector<std::uint8_t>(5, 255));
}

TEST(PageMeshFile, ReadsWhatARunWrites) {
  const test::TemporaryFolder folder;
  SurfaceMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0.5f}};
  mesh.normals.assign(3, {0, 0, 1});
  mesh.colours = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  mesh.labels = {0, 4, 4};
  mesh.triangles = {{0, 1, 2}};
  write_ply(folder.path() / "map.ply", mesh);
  write_cloud_ply(folder.path() / "cloud.ply", mesh);
  const PageMesh read = read_page_mesh(folder.path());
  EXPECT_EQ(read.vertices, mesh.vertices);
  EXPECT_EQ(read.colours, mesh.colours);
  EXPECT_EQ(read.labels, mesh.labels);
  EXPECT_EQ(read.triangles, mesh.triangles);
  EXPECT_TRUE(read.errors.empty());
  write_surface_errors(folder.path(), mesh.vertices, {0.0f, 0.0101f, 1.0f});
  const PageMesh with_errors = read_page_mesh(folder.path());
  EXPECT_EQ(with_errors.errors, (std::vector<float>{0.0f, 0.0101f, 1.0f}));
  EXPECT_EQ(packed(with_errors).errors, std::string("\0\x14\xff", 3)) << "in half millimetres";

  mesh.colours.assign(3, {0, 0, 0});
  write_ply(folder.path() / "map.ply", mesh);
  EXPECT_GT(read_page_mesh(folder.path()).colours[0][0], 100) << "black is no colour to see a surface in";
}

TEST(PageMeshFile, RefusesWhatIsDamaged) {
  const test::TemporaryFolder folder;
  SurfaceMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0.5f}};
  mesh.normals.assign(3, {0, 0, 1});
  mesh.colours.assign(3, {1, 2, 3});
  mesh.labels = {0, 4, 4};
  mesh.triangles = {{0, 1, 2}};
  const std::filesystem::path file = folder.path() / "map.ply";
  write_ply(file, mesh);
  write_cloud_ply(folder.path() / "cloud.ply", mesh);
  const std::string good = read_file(file);
  const auto expect_refused = [&](const std::string& bytes) {
    write_file(file, bytes);
    try {
      read_page_mesh(folder.path());
      ADD_FAILURE() << "was read";
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find("map.ply"), std::string::npos) << e.what();
    }
  };
  expect_refused("");
  expect_refused("solid");
  expect_refused(good.substr(0, good.size() - 1));
  expect_refused(good + "x");
  std::string wrong = good;
  wrong[wrong.size() - 1] = 127;  // a vertex that is not there
  expect_refused(wrong);
  std::string many = good;
  many.replace(many.find("vertex 3"), 8, "vertex 9999999999999999999");
  expect_refused(many);
}

}  // namespace
}  // namespace waretwin

#include "scenes/gltf_loader.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/scenes/gltf_writer.h"
#include "tests/support/test_data.h"

namespace waretwin::test {
namespace {

Scene load(const GltfWriter& writer) {
  TemporaryFolder folder;
  put_file(folder.path() / "m.glb", writer.glb());
  return load_gltf(folder.path() / "m.glb");
}

TEST(GltfLoader, TurnsYUpToZUp) {
  GltfWriter w;
  w.show(w.triangle(), {{"translation", {1, 2, 3}}});
  const Scene scene = load(w);
  ASSERT_EQ(scene.instances.size(), 1u);
  EXPECT_TRUE((scene.instances[0].X_WM * Eigen::Vector3f(0, 0, 0)).isApprox(Eigen::Vector3f(1, -3, 2)));
  // The mesh's own y, up in the file, points along world z.
  EXPECT_TRUE((scene.instances[0].X_WM.linear() * Eigen::Vector3f::UnitY()).isApprox(Eigen::Vector3f::UnitZ()));
}

TEST(GltfLoader, GltfWithDataUriEqualsGlb) {
  GltfWriter w;
  w.show(w.cube());
  TemporaryFolder folder;
  put_file(folder.path() / "a.glb", w.glb());
  put_file(folder.path() / "a.gltf", w.gltf());
  const Scene a = load_gltf(folder.path() / "a.glb"), b = load_gltf(folder.path() / "a.gltf");
  EXPECT_EQ(a.triangle_count(), 12u);
  EXPECT_EQ(a.meshes[0].triangles, b.meshes[0].triangles);
  EXPECT_EQ(a.meshes[0].positions, b.meshes[0].positions);
}

}  // namespace
}  // namespace waretwin::test

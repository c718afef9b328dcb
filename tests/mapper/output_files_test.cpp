#include <gtest/gtest.h>
#include <tiny_gltf.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/error.h"
#include "core/files.h"
#include "mapper/output/map_files.h"
#include "tests/support/test_data.h"

namespace waretwin {
namespace {

// Two triangles of object 5 and one of the background.
SurfaceMesh small_mesh() {
  SurfaceMesh mesh;
  for (int i = 0; i < 7; ++i) {
    mesh.vertices.emplace_back(static_cast<float>(i), 0.25f * static_cast<float>(i * i), -0.5f * static_cast<float>(i));
    mesh.normals.emplace_back(0.0f, 0.0f, 1.0f);
    mesh.colours.push_back({255, static_cast<std::uint8_t>(i), 0});
    mesh.labels.push_back(i < 4 ? 5 : 0);
  }
  mesh.triangles = {{0, 1, 2}, {1, 2, 3}, {4, 5, 6}};
  return mesh;
}

MappedObject object(int id, const std::string& class_name) {
  MappedObject o;
  o.id = id;
  o.class_name = class_name;
  o.cuboid.centre = {1.5, 2.0, 0.45};
  o.cuboid.size = {0.5, 2.0, 0.9};
  o.cuboid.yaw = 0.3;
  o.score = 0.75f;
  return o;
}

template <class T>
T take(const std::string& bytes, std::size_t& at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  at += sizeof value;
  return value;
}

TEST(MapFiles, PlyHoldsMeshBitForBit) {
  const test::TemporaryFolder folder;
  const SurfaceMesh mesh = small_mesh();
  write_ply(folder.path() / "map.ply", mesh);
  const std::string bytes = read_file(folder.path() / "map.ply");
  std::size_t at = bytes.find("end_header\n") + 11;
  EXPECT_EQ(bytes.substr(0, 40), "ply\nformat binary_little_endian 1.0\nelem");
  EXPECT_NE(bytes.find("element vertex 7\n"), std::string::npos);
  EXPECT_NE(bytes.find("element face 3\n"), std::string::npos);
  ASSERT_EQ(bytes.size() - at, 7u * 27u + 3u * 13u);
  for (std::size_t i = 0; i < 7; ++i) {
    for (int k = 0; k < 3; ++k) EXPECT_EQ(take<float>(bytes, at), mesh.vertices[i][k]);
    for (int k = 0; k < 3; ++k) EXPECT_EQ(take<float>(bytes, at), mesh.normals[i][k]);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(take<std::uint8_t>(bytes, at), mesh.colours[i][k]);
  }
  for (const auto& triangle : mesh.triangles) {
    EXPECT_EQ(take<std::uint8_t>(bytes, at), 3);
    for (const auto v : triangle) EXPECT_EQ(take<std::uint32_t>(bytes, at), v);
  }
}

TEST(MapFiles, CloudCarriesObjectIds) {
  const test::TemporaryFolder folder;
  const SurfaceMesh mesh = small_mesh();
  write_cloud_ply(folder.path() / "cloud.ply", mesh);
  const std::string bytes = read_file(folder.path() / "cloud.ply");
  std::size_t at = bytes.find("end_header\n") + 11;
  ASSERT_EQ(bytes.size() - at, 7u * 19u);
  EXPECT_EQ(bytes.find("element face"), std::string::npos);
  for (std::size_t i = 0; i < 7; ++i) {
    at += 15;
    EXPECT_EQ(take<std::int32_t>(bytes, at), mesh.labels[i]);
  }
}

TEST(MapFiles, ObjectsGetAFileEachAndOldOnesGo) {
  const test::TemporaryFolder folder;
  const auto objects = folder.path() / "objects";
  std::filesystem::create_directory(objects);
  write_file(objects / "77.ply", "old");
  write_file(objects / "notes.txt", "mine");
  write_object_plys(objects, small_mesh(), {object(5, "conveyor"), object(6, "chair")});
  EXPECT_TRUE(std::filesystem::exists(objects / "5.ply"));
  EXPECT_FALSE(std::filesystem::exists(objects / "6.ply"));
  EXPECT_FALSE(std::filesystem::exists(objects / "77.ply"));
  EXPECT_TRUE(std::filesystem::exists(objects / "notes.txt"));
  EXPECT_NE(read_file(objects / "5.ply").find("element face 2\n"), std::string::npos);
}

TEST(MapFiles, GlbHasANodePerObject) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "map.glb";
  const SurfaceMesh mesh = small_mesh();
  write_map_glb(file, mesh, {object(5, "conveyor"), object(6, "chair")});
  tinygltf::Model model;
  tinygltf::TinyGLTF reader;
  std::string error, warning;
  ASSERT_TRUE(reader.LoadBinaryFromFile(&model, &error, &warning, file.string())) << error;
  EXPECT_EQ(error + warning, "");
  ASSERT_EQ(model.nodes.size(), 3u);
  EXPECT_EQ(model.nodes[0].name, "background");
  EXPECT_EQ(model.nodes[1].name, "conveyor_5");
  EXPECT_EQ(model.nodes[2].mesh, -1);
  const auto& own = model.nodes[1].extras.Get("waretwin");
  EXPECT_EQ(own.Get("id").GetNumberAsInt(), 5);
  EXPECT_EQ(own.Get("class").Get<std::string>(), "conveyor");
  EXPECT_EQ(own.Get("cuboid").Get("frame").Get<std::string>(), "world");
  // Canonical: the long side first.
  EXPECT_DOUBLE_EQ(own.Get("cuboid").Get("size").Get(0).GetNumberAsDouble(), 2.0);
  EXPECT_DOUBLE_EQ(own.Get("cuboid").Get("centre").Get(2).GetNumberAsDouble(), 0.45);

  const auto& primitive = model.meshes[static_cast<std::size_t>(model.nodes[1].mesh)].primitives[0];
  const auto data = [&](int accessor) {
    const auto& a = model.accessors[static_cast<std::size_t>(accessor)];
    return model.buffers[0].data.data() + model.bufferViews[static_cast<std::size_t>(a.bufferView)].byteOffset;
  };
  ASSERT_EQ(model.accessors[static_cast<std::size_t>(primitive.indices)].count, 6u);
  ASSERT_EQ(model.accessors[static_cast<std::size_t>(primitive.attributes.at("POSITION"))].count, 4u);
  const auto* positions = reinterpret_cast<const float*>(data(primitive.attributes.at("POSITION")));
  for (std::size_t i = 0; i < 4; ++i) {  // y up
    EXPECT_EQ(positions[3 * i], mesh.vertices[i].x());
    EXPECT_EQ(positions[3 * i + 1], mesh.vertices[i].z());
    EXPECT_EQ(positions[3 * i + 2], -mesh.vertices[i].y());
  }
  const auto* colours = reinterpret_cast<const std::uint16_t*>(data(primitive.attributes.at("COLOR_0")));
  EXPECT_EQ(colours[0], 65535);
  EXPECT_EQ(colours[1], 0);
  EXPECT_EQ(colours[3], 65535);
}

TEST(MapFiles, GlbOfAnEmptyMapIsReadable) {
  const test::TemporaryFolder folder;
  write_map_glb(folder.path() / "map.glb", SurfaceMesh(), {});
  tinygltf::Model model;
  tinygltf::TinyGLTF reader;
  std::string error, warning;
  EXPECT_TRUE(reader.LoadBinaryFromFile(&model, &error, &warning, (folder.path() / "map.glb").string())) << error;
  EXPECT_EQ(model.nodes.size(), 1u);
}

TEST(MapFiles, OccupancyAsMapServerReadsIt) {
  const test::TemporaryFolder folder;
  OccupancyGrid grid;
  grid.resolution_m = 0.02;
  grid.origin = {-1.28, 0.16};
  grid.width = 3;
  grid.height = 2;
  grid.cells = {VoxelState::occupied, VoxelState::free, VoxelState::unknown, VoxelState::free, VoxelState::free, VoxelState::occupied};
  write_occupancy(folder.path() / "occupancy.pgm", grid);
  EXPECT_EQ(read_file(folder.path() / "occupancy.pgm"),
            std::string("P5\n3 2\n255\n") + "\xfe\xfe" + std::string(1, '\0') + std::string(1, '\0') + "\xfe\xcd");
  EXPECT_EQ(read_file(folder.path() / "occupancy.yaml"),
            "image: occupancy.pgm\nmode: trinary\nresolution: 0.02\norigin: [-1.280000000, 0.160000000, 0.0]\nnegate: 0\n"
            "occupied_thresh: 0.65\nfree_thresh: 0.196\n");
}

TEST(MapFiles, CuboidsAreCanonicalAndOrderedById) {
  const test::TemporaryFolder folder;
  write_cuboids(folder.path() / "cuboids.json", "world", {object(6, "chair"), object(5, "conveyor")});
  const auto json = nlohmann::json::parse(read_file(folder.path() / "cuboids.json"));
  EXPECT_EQ(json["frame"], "world");
  ASSERT_EQ(json["objects"].size(), 2u);
  const auto& first = json["objects"][0];
  EXPECT_EQ(first["id"], 5);
  EXPECT_EQ(first["class"], "conveyor");
  EXPECT_EQ(first["size"], nlohmann::json({2.0, 0.5, 0.9}));
  EXPECT_NEAR(first["yaw"].get<double>(), 0.3 + M_PI / 2, 1e-12);
  EXPECT_EQ(first["score"], 0.75);
}

TEST(MapFiles, MissingFolderIsAnError) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(write_ply(folder.path() / "no" / "map.ply", small_mesh()), Error);
  EXPECT_THROW(write_map_glb(folder.path() / "no" / "map.glb", small_mesh(), {}), Error);
}

}  // namespace
}  // namespace waretwin

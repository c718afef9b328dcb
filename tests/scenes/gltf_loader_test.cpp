#include "scenes/gltf_loader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgcodecs.hpp>

#include "tests/scenes/gltf_writer.h"
#include "tests/support/expect_error.h"
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

TEST(GltfLoader, TransformsComposeFromTrsAndMatrix) {
  GltfWriter w;
  const double h = std::sqrt(0.5);
  // A quarter turn about y, twice as large, on a parent that a matrix moves by (10, 0, 0).
  w.show(w.triangle(), {{"rotation", {0, h, 0, h}}, {"scale", {2, 2, 2}}, {"translation", {0, 1, 0}}});
  w.add("nodes", {{"children", {0}}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 10, 0, 0, 1}}});
  const Scene scene = load(w);
  // x in the file goes to -z there, which is +y here.
  EXPECT_TRUE((scene.instances[0].X_WM * Eigen::Vector3f(1, 0, 0)).isApprox(Eigen::Vector3f(10, 2, 1), 1e-5f));
}

TEST(GltfLoader, SharesMeshesBetweenNodes) {
  GltfWriter w;
  w.show(w.cube());
  w.add("nodes", {{"mesh", 0}, {"translation", {5, 0, 0}}});
  const Scene scene = load(w);
  EXPECT_EQ(scene.meshes.size(), 1u);
  EXPECT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.triangle_count(), 24u);
  EXPECT_FLOAT_EQ(scene.bounds().max().x(), 6.0f);
}

TEST(GltfLoader, ReadsEveryIndexTypeAndNone) {
  for (const int kind : {0, 1, 2, 3}) {
    GltfWriter w;
    json primitive = w.triangle();
    if (kind == 1) primitive["indices"] = w.accessor(std::vector<std::uint8_t>{2, 0, 1}, "SCALAR");
    if (kind == 2) primitive["indices"] = w.accessor(std::vector<std::uint16_t>{2, 0, 1}, "SCALAR");
    if (kind == 3) primitive["indices"] = w.accessor(std::vector<std::uint32_t>{2, 0, 1}, "SCALAR");
    w.show(primitive);
    const Scene scene = load(w);
    const Mesh& mesh = scene.meshes[0];
    EXPECT_EQ(mesh.positions[mesh.triangles[0]], kind == 0 ? Eigen::Vector3f(0, 0, 0) : Eigen::Vector3f(0, 1, 0)) << kind;
    EXPECT_TRUE(mesh.normals[0].isApprox(Eigen::Vector3f::UnitZ()));
  }
}

TEST(GltfLoader, TurnsStripsAndFansIntoTriangles) {
  for (const int mode : {5, 6}) {
    GltfWriter w;
    const std::vector<float> strip = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, fan = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    w.show({{"attributes", {{"POSITION", w.accessor(mode == 5 ? strip : fan, "VEC3")}}}, {"mode", mode}});
    const Scene scene = load(w);
    const Mesh& mesh = scene.meshes[0];
    ASSERT_EQ(mesh.triangles.size(), 6u);
    double area = 0;
    for (std::size_t t = 0; t < 6; t += 3) {
      const Eigen::Vector3f a = mesh.positions[mesh.triangles[t]], b = mesh.positions[mesh.triangles[t + 1]],
                            c = mesh.positions[mesh.triangles[t + 2]];
      area += 0.5 * static_cast<double>((b - a).cross(c - a).z());  // both wind to the left, so that both count positive
    }
    EXPECT_NEAR(area, 1.0, 1e-6) << mode;
  }
}

TEST(GltfLoader, ReadsStridedAndSparseAccessors) {
  GltfWriter w;
  const int strided = w.view(bytes_of(std::vector<float>{0, 0, 0, 9, 1, 0, 0, 9, 0, 1, 0, 9}), 16);
  const int where = w.view(bytes_of(std::vector<std::uint16_t>{2}));
  const int what = w.view(bytes_of(std::vector<float>{0, 4, 0}));
  const int accessor = w.add(
      "accessors",
      {{"bufferView", strided},
       {"componentType", 5126},
       {"count", 3},
       {"type", "VEC3"},
       {"sparse", {{"count", 1}, {"indices", {{"bufferView", where}, {"componentType", 5123}}}, {"values", {{"bufferView", what}}}}}});
  w.show({{"attributes", {{"POSITION", accessor}}}});
  const Scene scene = load(w);
  EXPECT_EQ(scene.meshes[0].positions[1], Eigen::Vector3f(1, 0, 0));
  EXPECT_EQ(scene.meshes[0].positions[2], Eigen::Vector3f(0, 4, 0));
}

TEST(GltfLoader, NormalisesIntegers) {
  GltfWriter w;
  json primitive = w.triangle();
  primitive["attributes"]["TEXCOORD_0"] = w.accessor(std::vector<std::uint16_t>{0, 65535, 65535, 0, 13107, 0}, "VEC2", true);
  primitive["attributes"]["COLOR_0"] = w.accessor(std::vector<std::uint8_t>{255, 0, 51, 0, 255, 0, 102, 255, 0, 0, 0, 255}, "VEC4", true);
  w.show(primitive);
  const Scene scene = load(w);
  EXPECT_EQ(scene.meshes[0].uv[0][0], Eigen::Vector2f(0, 1));
  EXPECT_FLOAT_EQ(scene.meshes[0].uv[0][2].x(), 0.2f);
  EXPECT_FLOAT_EQ(scene.meshes[0].colours[0].z(), 0.2f);
  EXPECT_FLOAT_EQ(scene.meshes[0].colours[1].z(), 0.4f);
}

TEST(GltfLoader, ReadsMaterials) {
  GltfWriter w;
  cv::Mat picture(2, 3, CV_8UC3, cv::Scalar(10, 20, 30));  // blue, green, red
  std::vector<std::uint8_t> png;
  cv::imencode(".png", picture, png);
  w.add("images", {{"bufferView", w.view(std::string(png.begin(), png.end()))}, {"mimeType", "image/png"}});
  w.add("samplers", {{"magFilter", 9728}, {"wrapS", 33071}, {"wrapT", 33648}});
  w.add("textures", {{"source", 0}, {"sampler", 0}});
  const double angle = 0.3;
  const json transform = {{"KHR_texture_transform", {{"offset", {0.5, 0.25}}, {"rotation", angle}, {"scale", {2, 3}}, {"texCoord", 1}}}};
  w.add("materials", {{"name", "m"},
                      {"pbrMetallicRoughness",
                       {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}},
                        {"metallicFactor", 0.5},
                        {"roughnessFactor", 0.25},
                        {"baseColorTexture", {{"index", 0}, {"extensions", transform}}}}},
                      {"emissiveFactor", {1, 0.5, 0}},
                      {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 4}}}}},
                      {"alphaMode", "MASK"},
                      {"alphaCutoff", 0.7},
                      {"doubleSided", true},
                      {"extras", {{"waretwin", {{"reflectivity_850nm", 0.6}}}}}});
  json primitive = w.triangle();
  primitive["material"] = 0;
  w.show(primitive);
  const Scene scene = load(w);
  const Material& m = scene.materials[static_cast<std::size_t>(scene.meshes[0].material)];
  EXPECT_EQ(m.name, "m");
  EXPECT_FLOAT_EQ(m.base_colour[3], 0.4f);
  EXPECT_FLOAT_EQ(m.metallic, 0.5f);
  EXPECT_FLOAT_EQ(m.roughness, 0.25f);
  EXPECT_FLOAT_EQ(m.emissive.y(), 2.0f);
  EXPECT_TRUE(m.alpha_mask && m.double_sided);
  EXPECT_FLOAT_EQ(m.alpha_cutoff, 0.7f);
  EXPECT_FLOAT_EQ(m.reflectivity_850nm, 0.6f);
  EXPECT_EQ(m.retroreflection, 0.0f);
  EXPECT_EQ(m.base_colour_texture.uv_set, 1);
  const Eigen::Vector2f uv = m.base_colour_texture.uv_transform * Eigen::Vector3f(1, 0, 1);
  EXPECT_NEAR(uv.x(), 0.5 + 2 * std::cos(angle), 1e-6);
  EXPECT_NEAR(uv.y(), 0.25 - 2 * std::sin(angle), 1e-6);
  ASSERT_EQ(scene.textures.size(), 1u);
  const Texture& t = scene.textures[0];
  EXPECT_EQ(t.width, 3);
  EXPECT_EQ(t.height, 2);
  EXPECT_EQ((std::vector<std::uint8_t>(t.rgba.begin(), t.rgba.begin() + 4)), (std::vector<std::uint8_t>{30, 20, 10, 255}));
  EXPECT_TRUE(t.nearest);
  EXPECT_EQ(t.wrap_u, Texture::Wrap::kClampToEdge);
  EXPECT_EQ(t.wrap_v, Texture::Wrap::kMirroredRepeat);
}

TEST(GltfLoader, RetroreflectorsAreMarkedInTheExtrasOfTheirMaterials) {
  for (const auto& [value, expected] : {std::pair<json, float>{true, 220.0f}, {false, 0.0f}, {750, 750.0f}, {0.5, 0.5f}}) {
    GltfWriter w;
    w.add("materials", {{"name", "tape"}, {"extras", {{"waretwin", {{"retroreflective", value}}}}}});
    json primitive = w.triangle();
    primitive["material"] = 0;
    w.show(primitive);
    const Scene scene = load(w);
    EXPECT_EQ(scene.materials[static_cast<std::size_t>(scene.meshes[0].material)].retroreflection, expected) << value;
  }
}

TEST(GltfLoader, PlacesLights) {
  GltfWriter w;
  w.root["extensionsUsed"] = {"KHR_lights_punctual"};
  w.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "spot"},
                                                            {"color", {1, 0.5, 0}},
                                                            {"intensity", 20},
                                                            {"range", 7},
                                                            {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.4}}},
                                                            {"extras", {{"waretwin", {{"radius_m", 0.15}}}}}}};
  w.add("nodes", {{"translation", {0, 3, 0}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  const Scene scene = load(w);
  ASSERT_EQ(scene.lights.size(), 1u);
  const Light& light = scene.lights[0];
  EXPECT_EQ(light.kind, Light::Kind::kSpot);
  EXPECT_TRUE(light.position.isApprox(Eigen::Vector3f(0, 0, 3)));
  EXPECT_TRUE(light.direction.isApprox(Eigen::Vector3f::UnitY()));  // -z of the file
  EXPECT_TRUE(light.intensity.isApprox(Eigen::Vector3f(20, 10, 0)));
  EXPECT_FLOAT_EQ(light.range, 7.0f);
  EXPECT_FLOAT_EQ(light.outer_cone, 0.4f);
  EXPECT_FLOAT_EQ(light.radius, 0.15f);
}

TEST(GltfLoader, NamesWhatItReadsOver) {
  GltfWriter w;
  w.add("materials", {{"alphaMode", "BLEND"}});
  w.add("animations", {{"channels", json::array()}, {"samplers", json::array()}});
  w.root["extensionsUsed"] = {"KHR_materials_clearcoat"};
  json primitive = w.triangle();
  w.show(primitive);
  primitive["mode"] = 1;
  w.show(primitive);
  const Scene scene = load(w);
  EXPECT_EQ(scene.instances.size(), 1u);
  std::string notes;
  for (const std::string& note : scene.notes) notes += note + "\n";
  for (const char* word : {"BLEND", "animations", "KHR_materials_clearcoat", "lines"})
    EXPECT_NE(notes.find(word), std::string::npos) << word;
}

TEST(TrueCuboids, ComeFromExtrasWithNestedObjectsApart) {
  GltfWriter w;
  // A 4 x 2 x 1 conveyor turned by 30 deg, a parcel on it that belongs to nothing, and a robot arm that is its own object.
  const double half = 15.0 * 3.14159265358979 / 180.0;
  w.show(w.cube(), {{"scale", {4, 1, 2}}, {"translation", {-2, 0, -1}}});
  w.show(w.cube(), {{"translation", {0, 1, 0}}, {"extras", {{"waretwin", {{"class", ""}}}}}});
  w.show(w.cube(), {{"translation", {0, 3, 0}}, {"extras", {{"waretwin", {{"class", "arm"}}}}}});
  w.add("nodes", {{"children", {0, 1, 2}},
                  {"rotation", {0, std::sin(half), 0, std::cos(half)}},
                  {"extras", {{"waretwin", {{"class", "conveyor"}, {"name", "A1"}}}}}});
  const Scene scene = load(w);
  ASSERT_EQ(scene.objects.size(), 2u);
  const Cuboid& c = scene.objects[0].cuboid;
  EXPECT_EQ(scene.objects[0].name, "A1");
  EXPECT_EQ(scene.objects[0].class_name, "conveyor");
  EXPECT_TRUE(c.size.isApprox(Eigen::Vector3d(4, 2, 1), 1e-5)) << c.size.transpose();
  EXPECT_NEAR(c.yaw, 30.0 * 3.14159265358979 / 180.0, 1e-5);
  EXPECT_TRUE((c.centre - Eigen::Vector3d(0, 0, 0.5)).norm() < 1e-5) << c.centre.transpose();
  EXPECT_EQ(scene.objects[1].class_name, "arm");
  EXPECT_NEAR(scene.objects[1].cuboid.bottom(), 3.0, 1e-5);
  EXPECT_EQ(scene.instances[0].object, 0);
  EXPECT_EQ(scene.instances[1].object, -1);
  EXPECT_EQ(scene.instances[2].object, 1);
}

TEST(TrueCuboids, RefuseTiltBeyondOneDegree) {
  const auto tilted = [](double degrees) {
    GltfWriter w;
    const double half = 0.5 * degrees * 3.14159265358979 / 180.0;
    w.show(w.cube(), {{"name", "c"}, {"rotation", {std::sin(half), 0, 0, std::cos(half)}}, {"extras", {{"waretwin", {{"class", "box"}}}}}});
    return load(w);
  };
  EXPECT_EQ(tilted(0.9).objects.size(), 1u);
  EXPECT_ERROR(tilted(1.2), "node 'c'", "tilted by 1.2 deg");
}

TEST(GltfLoader, ReadsModelsByOthers) {
  WARETWIN_NEED_DATA("gltf_kenney");
  struct Row {
    const char* file;
    std::size_t triangles, instances;
    Eigen::Vector3f low, high;
  };
  // Triangles and extents from the files' own accessor counts and min/max.
  const std::vector<Row> rows = {{"box-large", 28, 1, {-0.5f, -0.5f, 0}, {0.5f, 0.5f, 0.5f}},
                                 {"box-long", 28, 1, {-0.5f, -0.25f, 0}, {0.5f, 0.25f, 0.5f}},
                                 {"conveyor-bars", 164, 1, {-0.5f, -0.5f, 0}, {0.5f, 0.5f, 0.25f}},
                                 {"conveyor-long", 92, 1, {-1, -0.5f, 0}, {1, 0.5f, 0.4f}},
                                 {"conveyor-stripe", 124, 1, {-0.5f, -0.5f, 0}, {0.5f, 0.5f, 0.4f}},
                                 {"conveyor", 92, 1, {-0.5f, -0.5f, 0}, {0.5f, 0.5f, 0.4f}},
                                 {"robot-arm-a", 472, 9, {-0.5f, -0.5f, 0}, {0.5f, 0.5f, 3.2f}},
                                 {"shelf-boxes", 436, 11, {-0.4f, -0.35f, 0}, {0.4f, 0.35f, 0.85f}}};
  for (const Row& row : rows) {
    const Scene scene = load_gltf(shared_data("gltf_kenney") / (std::string(row.file) + ".glb"));
    EXPECT_EQ(scene.triangle_count(), row.triangles) << row.file;
    EXPECT_EQ(scene.instances.size(), row.instances) << row.file;
    EXPECT_LT((scene.bounds().min() - row.low).norm(), 2e-3f) << row.file << " " << scene.bounds().min().transpose();
    EXPECT_LT((scene.bounds().max() - row.high).norm(), 2e-3f) << row.file << " " << scene.bounds().max().transpose();
    ASSERT_EQ(scene.textures.size(), 1u) << row.file;
    EXPECT_GT(scene.textures[0].width, 100) << row.file;
    EXPECT_TRUE(scene.notes.empty()) << row.file;
  }
}

}  // namespace
}  // namespace waretwin::test

// Damaged and hostile files: every one ends in one Error, or loads; none crashes, hangs or reaches outside its folder.
#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "scenes/gltf_loader.h"
#include "tests/scenes/gltf_writer.h"
#include "tests/support/expect_error.h"
#include "tests/support/test_data.h"

namespace waretwin::test {
namespace {

struct Case {
  const char* name;
  std::vector<std::string> expected;  // parts of the message
  std::function<void(GltfWriter&)> damage;
};

TEST(HostileGltf, EndsInOneErrorThatNamesTheElement) {
  const std::vector<Case> cases = {
      {"offset beyond the view", {"accessor 0", "leave bufferView"}, [](GltfWriter& w) { w.root["accessors"][0]["byteOffset"] = 1000; }},
      {"count beyond the view", {"accessor 0", "leave bufferView"}, [](GltfWriter& w) { w.root["accessors"][0]["count"] = 9; }},
      {"absurd count", {"vertices"}, [](GltfWriter& w) { w.root["accessors"][0]["count"] = 4000000000000ull; }},
      {"absurd count of indices", {"accessor 1", "at most"}, [](GltfWriter& w) { w.root["accessors"][1]["count"] = 9007199254740991ull; }},
      {"view beyond the buffer",
       {"bufferView 0", "leave buffer 0"},
       [](GltfWriter& w) { w.root["bufferViews"][0]["byteLength"] = 1 << 20; }},
      {"overflowing view", {"bufferView 0"}, [](GltfWriter& w) { w.root["bufferViews"][0]["byteOffset"] = 9007199254740991ull; }},
      {"buffer longer than its bytes",
       {"buffer 0", "byteLength"},
       [](GltfWriter& w) {
         w.root["buffers"] = {{{"byteLength", 1 << 30}}};
       }},
      {"no such buffer", {"bufferView 0", "buffer 7"}, [](GltfWriter& w) { w.root["bufferViews"][0]["buffer"] = 7; }},
      {"negative offset", {"accessors 0", "byteOffset"}, [](GltfWriter& w) { w.root["accessors"][0]["byteOffset"] = -4; }},
      {"stride below the element", {"accessor 0", "stride"}, [](GltfWriter& w) { w.root["bufferViews"][0]["byteStride"] = 4; }},
      {"unknown component type", {"accessor 0", "component type"}, [](GltfWriter& w) { w.root["accessors"][0]["componentType"] = 5124; }},
      {"index out of range", {"mesh 0", "index"}, [](GltfWriter& w) { w.binary[w.binary.size() - 1] = '\x7f'; }},
      {"NaN", {"accessor 0", "not a finite number"}, [](GltfWriter& w) { w.binary.replace(0, 4, std::string("\0\0\xc0\x7f", 4)); }},
      {"infinity", {"accessor 0", "not a finite number"}, [](GltfWriter& w) { w.binary.replace(0, 4, std::string("\0\0\x80\x7f", 4)); }},
      {"far away",
       {"node 0", "1000 km"},
       [](GltfWriter& w) {
         w.root["nodes"][0]["translation"] = {1e9, 0, 0};
       }},
      {"cycle",
       {"own ancestor"},
       [](GltfWriter& w) {
         w.root["nodes"] = {{{"children", {1}}}, {{"children", {0}}}};
       }},
      {"own child", {"own ancestor"}, [](GltfWriter& w) { w.root["nodes"][0]["children"] = {0}; }},
      {"two parents",
       {"node 0", "two parents"},
       [](GltfWriter& w) {
         w.add("nodes", {{"children", {0, 0}}});
       }},
      {"root that is a child",
       {"node 0 'n'", "root"},
       [](GltfWriter& w) {
         w.root["nodes"][0]["name"] = "n";
         w.add("nodes", {{"children", {0}}});
         w.add("scenes", {{"nodes", {0, 1}}});
       }},
      {"no such child", {"node 0", "child 9"}, [](GltfWriter& w) { w.root["nodes"][0]["children"] = {9}; }},
      {"no such mesh", {"node 0", "mesh 5"}, [](GltfWriter& w) { w.root["nodes"][0]["mesh"] = 5; }},
      {"no such scene",
       {"scene"},
       [](GltfWriter& w) {
         w.root["scene"] = 3, w.add("scenes", {{"nodes", {0}}});
       }},
      {"no such material", {"mesh 0", "material 3"}, [](GltfWriter& w) { w.root["meshes"][0]["primitives"][0]["material"] = 3; }},
      {"no such accessor", {"accessor 77"}, [](GltfWriter& w) { w.root["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 77; }},
      {"zero scale",
       {"node 0", "flattens"},
       [](GltfWriter& w) {
         w.root["nodes"][0]["scale"] = {1, 0, 1};
       }},
      {"zero matrix", {"node 0"}, [](GltfWriter& w) { w.root["nodes"][0]["matrix"] = std::vector<int>(16, 0); }},
      {"short matrix",
       {"nodes 0", "matrix"},
       [](GltfWriter& w) {
         w.root["nodes"][0]["matrix"] = {1, 2};
       }},
      {"zero rotation",
       {"node 0", "rotation"},
       [](GltfWriter& w) {
         w.root["nodes"][0]["rotation"] = {0, 0, 0, 0};
       }},
      {"nodes that are no list", {"nodes"}, [](GltfWriter& w) { w.root["nodes"] = 3; }},
      {"a node that is no object", {"nodes 0"}, [](GltfWriter& w) { w.root["nodes"] = {3}; }},
      {"version 1", {"asset", "1.0"}, [](GltfWriter& w) { w.root["asset"]["version"] = "1.0"; }},
      {"a required extension", {"KHR_draco"}, [](GltfWriter& w) { w.root["extensionsRequired"] = {"KHR_draco_mesh_compression"}; }},
      {"extension names that are numbers", {"extensionsUsed"}, [](GltfWriter& w) { w.root["extensionsUsed"] = {1}; }},
      {"deep nesting",
       {"nested"},
       [](GltfWriter& w) {
         json deep = 1;
         for (int i = 0; i < 500; ++i) deep = json::array({deep});
         w.root["extras"] = deep;
       }},
      {"a retroreflector of words",
       {"material 0 'm'", "retroreflective"},
       [](GltfWriter& w) {
         w.add("materials", {{"name", "m"}, {"extras", {{"waretwin", {{"retroreflective", "yes"}}}}}});
       }},
      {"a retroreflector below nothing",
       {"material 0", "retroreflective", "0 to 100000"},
       [](GltfWriter& w) {
         w.add("materials", {{"extras", {{"waretwin", {{"retroreflective", -1}}}}}});
       }},
      {"a retroreflector beyond reason",
       {"material 0", "retroreflective"},
       [](GltfWriter& w) {
         w.add("materials", {{"extras", {{"waretwin", {{"retroreflective", 1e6}}}}}});
       }},
      {"class that is no text", {"node 0", "class"}, [](GltfWriter& w) { w.root["nodes"][0]["extras"]["waretwin"]["class"] = 3; }},
      {"no such light", {"node 0", "light 4"}, [](GltfWriter& w) { w.root["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 4; }},
      {"a picture that is none",
       {"image 0", "PNG"},
       [](GltfWriter& w) {
         w.add("images", {{"bufferView", 0}});
         w.add("textures", {{"source", 0}});
         w.add("materials", {{"emissiveTexture", {{"index", 0}}}});
       }},
      {"a picture of absurd size",
       {"image 0", "2147483647"},
       [](GltfWriter& w) {
         std::string png = "\x89PNG\r\n\x1a\n";
         png += std::string("\0\0\0\rIHDR\x7f\xff\xff\xff\x7f\xff\xff\xff\x08\x02\0\0\0", 21) + std::string(64, '\0');
         w.add("images", {{"bufferView", w.view(png)}});
         w.add("textures", {{"source", 0}});
         w.add("materials", {{"emissiveTexture", {{"index", 0}}}});
       }},
  };
  for (const Case& c : cases) {
    GltfWriter w;
    w.show(w.cube());
    c.damage(w);
    TemporaryFolder folder;
    const auto file = folder.path() / "hostile.glb";
    put_file(file, w.glb());
    std::string message = "nothing was thrown";
    try {
      load_gltf(file);
    } catch (const Error& error) {
      message = error.what();
    }
    EXPECT_NE(message.find("hostile.glb"), std::string::npos) << c.name << ": " << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << c.name << ": " << message;
    for (const std::string& part : c.expected) EXPECT_NE(message.find(part), std::string::npos) << c.name << ": " << message;
  }
}

TEST(HostileGltf, UrisStayInTheFolder) {
  TemporaryFolder outside, folder;
  put_file(outside.path() / "secret.bin", std::string(4096, 'x'));
  std::filesystem::create_symlink(outside.path() / "secret.bin", folder.path() / "link.bin");
  std::filesystem::create_directory(folder.path() / "sub");
  const std::string secret = (outside.path() / "secret.bin").string(), up = "../" + outside.path().filename().string() + "/secret.bin";
  std::string encoded = up;
  encoded.replace(0, 2, "%2e%2E");
  for (const std::string& uri : {up, encoded, "sub/../../" + up.substr(3), secret, "file://" + secret, std::string("http://a/b.bin"),
                                 std::string("link.bin"), std::string("%zz.bin"), std::string("missing.bin"), std::string("sub")}) {
    GltfWriter w;
    w.show(w.cube());
    json root = w.finished();
    root["buffers"][0]["uri"] = uri;
    put_file(folder.path() / "m.gltf", root.dump());
    EXPECT_ERROR(load_gltf(folder.path() / "m.gltf"), "m.gltf", "buffer 0", "URI");
  }
  // The same buffer inside the folder, its name percent-encoded, is fine.
  GltfWriter w;
  w.show(w.cube());
  put_file(folder.path() / "sub" / "my data.bin", w.binary);
  json root = w.finished();
  root["buffers"][0]["uri"] = "sub/my%20data.bin";
  put_file(folder.path() / "m.gltf", root.dump());
  EXPECT_EQ(load_gltf(folder.path() / "m.gltf").triangle_count(), 12u);
}

std::string sample() {
  GltfWriter w;
  json primitive = w.triangle();
  primitive["indices"] = w.accessor(std::vector<std::uint8_t>{0, 1, 2}, "SCALAR");
  w.add("materials", {{"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 1}}}}});
  primitive["material"] = 0;
  w.show(primitive, {{"name", "n"}, {"scale", {1, 2, 3}}, {"extras", {{"waretwin", {{"class", "box"}}}}}});
  return w.glb();
}

TEST(HostileGltf, EveryTruncationIsAnError) {
  TemporaryFolder folder;
  const std::string whole = sample();
  for (std::size_t length = 0; length < whole.size(); ++length) {
    put_file(folder.path() / "cut.glb", whole.substr(0, length));
    EXPECT_THROW(load_gltf(folder.path() / "cut.glb"), Error) << length;
  }
}

TEST(HostileGltf, FlippedBytesNeverCrash) {
  TemporaryFolder folder;
  const std::string whole = sample();
  std::mt19937 random(7);
  int errors = 0, loads = 0;
  for (int i = 0; i < 2000; ++i) {
    std::string damaged = whole;
    for (unsigned flips = 1 + random() % 4; flips > 0; --flips) damaged[random() % damaged.size()] = static_cast<char>(random());
    put_file(folder.path() / "flip.glb", damaged);
    try {
      load_gltf(folder.path() / "flip.glb");
      ++loads;
    } catch (const Error&) {
      ++errors;
    }
  }
  EXPECT_GT(errors, 100);
  EXPECT_GT(loads, 20);
}

}  // namespace
}  // namespace waretwin::test

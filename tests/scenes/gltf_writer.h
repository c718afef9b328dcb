// Writes small glTF files by hand: JSON text and little-endian buffers, so that the reader is tested against the format and not against
// a library's idea of it.
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace waretwin::test {

using nlohmann::json;

template <class T>
std::string bytes_of(const std::vector<T>& values) {
  return std::string(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

class GltfWriter {
 public:
  json root = {{"asset", {{"version", "2.0"}}}};
  std::string binary;

  // Adds a buffer view; returns its index.
  int view(const std::string& bytes, int stride = 0) {
    while (binary.size() % 4 != 0) binary += '\0';
    json v = {{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes.size()}};
    if (stride > 0) v["byteStride"] = stride;
    binary += bytes;
    return add("bufferViews", v);
  }

  // Adds an accessor over a new buffer view; returns its index.
  template <class T>
  int accessor(const std::vector<T>& values, const std::string& type, bool normalised = false) {
    const std::size_t components = type == "SCALAR" ? 1 : static_cast<std::size_t>(type.back() - '0');
    json a = {{"bufferView", view(bytes_of(values))},
              {"componentType", component_type<T>()},
              {"count", values.size() / components},
              {"type", type}};
    if (normalised) a["normalized"] = true;
    return add("accessors", a);
  }

  int add(const char* list, const json& element) {
    root[list].push_back(element);
    return static_cast<int>(root[list].size()) - 1;
  }

  // A mesh of one primitive, shown by a new root node; returns the primitive for further keys.
  json& show(const json& primitive, const json& node = json::object()) {
    const int mesh = add("meshes", {{"primitives", {primitive}}});
    json n = node;
    n["mesh"] = mesh;
    add("nodes", n);
    return root["meshes"][static_cast<std::size_t>(mesh)]["primitives"][0];
  }

  // The unit cube from 0 to 1 on all axes, without normals; returns the primitive.
  json cube() {
    std::vector<float> p;
    for (int i = 0; i < 8; ++i) p.insert(p.end(), {float(i & 1), float(i >> 1 & 1), float(i >> 2 & 1)});
    const std::vector<std::uint16_t> t = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                          2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
    return {{"attributes", {{"POSITION", accessor(p, "VEC3")}}}, {"indices", accessor(t, "SCALAR")}};
  }

  // One triangle (0 0 0), (1 0 0), (0 1 0) without indices.
  json triangle() { return {{"attributes", {{"POSITION", accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3")}}}}; }

  json finished() const {
    json out = root;
    if (!binary.empty() && !out.contains("buffers")) out["buffers"] = {{{"byteLength", binary.size()}}};
    return out;
  }

  std::string glb() const {
    std::string text = finished().dump();
    while (text.size() % 4 != 0) text += ' ';
    std::string bin = binary;
    while (bin.size() % 4 != 0) bin += '\0';
    std::string out = "glTF" + u32(2) + u32(0) + u32(text.size()) + "JSON" + text;
    if (!bin.empty()) out += u32(bin.size()) + std::string("BIN\0", 4) + bin;
    const std::string length = u32(out.size());
    out.replace(8, 4, length);
    return out;
  }

  // .gltf with the buffer as a data URI.
  std::string gltf() const {
    json out = finished();
    if (!binary.empty()) out["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64(binary);
    return out.dump();
  }

  static std::string u32(std::size_t value) {
    const std::uint32_t v = static_cast<std::uint32_t>(value);
    return bytes_of(std::vector<std::uint32_t>{v});
  }

  static std::string base64(const std::string& bytes) {
    static const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
      std::uint32_t bits = 0;
      for (std::size_t k = 0; k < 3; ++k) bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
      for (std::size_t k = 0; k < 4; ++k) out += i + k > bytes.size() ? '=' : digits[bits >> (18 - 6 * k) & 63];
    }
    return out;
  }

 private:
  template <class T>
  static int component_type() {
    if (std::is_same_v<T, std::int8_t>) return 5120;
    if (std::is_same_v<T, std::uint8_t>) return 5121;
    if (std::is_same_v<T, std::int16_t>) return 5122;
    if (std::is_same_v<T, std::uint16_t>) return 5123;
    if (std::is_same_v<T, std::uint32_t>) return 5125;
    return 5126;
  }
};

inline void put_file(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

}  // namespace waretwin::test

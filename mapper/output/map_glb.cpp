#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>

#include "core/error.h"
#include "core/files.h"
#include "mapper/output/map_files.h"

namespace waretwin {

namespace {

// 8-bit sRGB to 16-bit linear (IEC 61966-2-1).
const std::array<std::uint16_t, 256>& linear_colours() {
  static const std::array<std::uint16_t, 256> table = [] {
    std::array<std::uint16_t, 256> linear;
    for (std::size_t i = 0; i < 256; ++i) {
      const double s = static_cast<double>(i) / 255.0;
      const double value = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
      linear[i] = static_cast<std::uint16_t>(std::lround(value * 65535.0));
    }
    return linear;
  }();
  return table;
}

Eigen::Vector3f turned(const Eigen::Vector3f& v_W) { return {v_W.x(), v_W.z(), -v_W.y()}; }

class Builder {
 public:
  Builder() {
    model_.asset.version = "2.0";
    model_.asset.generator = "waretwin";
    model_.buffers.emplace_back();
    tinygltf::Material material;
    material.name = "scanned";
    material.pbrMetallicRoughness.metallicFactor = 0.0;
    material.pbrMetallicRoughness.roughnessFactor = 1.0;
    material.doubleSided = true;
    model_.materials.push_back(material);
    model_.scenes.emplace_back().name = "map";
    model_.defaultScene = 0;
  }

  void add_node(const std::string& name, const SurfaceMesh* mesh, tinygltf::Value extras) {
    tinygltf::Node node;
    node.name = name;
    node.extras = std::move(extras);
    if (mesh && !mesh->triangles.empty()) node.mesh = add_mesh(name, *mesh);
    model_.scenes[0].nodes.push_back(static_cast<int>(model_.nodes.size()));
    model_.nodes.push_back(std::move(node));
  }

  std::string bytes() {
    if (model_.buffers[0].data.empty()) model_.buffers.clear();
    std::ostringstream stream;
    tinygltf::TinyGLTF writer;
    if (!writer.WriteGltfSceneToStream(&model_, stream, false, true)) throw InternalError("the map could not be put into glTF");
    return std::move(stream).str();
  }

 private:
  template <class T>
  int add_accessor(const std::vector<T>& values, int component, int type, int target, bool normalised = false) {
    std::vector<unsigned char>& data = model_.buffers[0].data;
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = data.size();
    view.byteLength = values.size() * sizeof(T);
    view.target = target;
    data.resize(data.size() + view.byteLength);
    std::memcpy(data.data() + view.byteOffset, values.data(), view.byteLength);
    tinygltf::Accessor accessor;
    accessor.bufferView = static_cast<int>(model_.bufferViews.size());
    accessor.componentType = component;
    accessor.type = type;
    accessor.count = values.size();
    accessor.normalized = normalised;
    model_.bufferViews.push_back(std::move(view));
    model_.accessors.push_back(std::move(accessor));
    return static_cast<int>(model_.accessors.size()) - 1;
  }

  int add_mesh(const std::string& name, const SurfaceMesh& mesh) {
    std::vector<std::array<float, 3>> positions, normals;
    std::vector<std::array<std::uint16_t, 4>> colours;
    std::vector<std::uint32_t> indices;
    Eigen::Vector3f low = Eigen::Vector3f::Constant(std::numeric_limits<float>::infinity()), high = -low;
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
      const Eigen::Vector3f p = turned(mesh.vertices[i]), n = turned(mesh.normals[i]);
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
      positions.push_back({p.x(), p.y(), p.z()});
      normals.push_back({n.x(), n.y(), n.z()});
      const auto& c = mesh.colours[i];
      colours.push_back({linear_colours()[c[0]], linear_colours()[c[1]], linear_colours()[c[2]], 65535});
    }
    for (const auto& triangle : mesh.triangles) indices.insert(indices.end(), triangle.begin(), triangle.end());

    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.material = 0;
    const int position = add_accessor(positions, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3, TINYGLTF_TARGET_ARRAY_BUFFER);
    for (int k = 0; k < 3; ++k) {
      model_.accessors[static_cast<std::size_t>(position)].minValues.push_back(low[k]);
      model_.accessors[static_cast<std::size_t>(position)].maxValues.push_back(high[k]);
    }
    primitive.attributes["POSITION"] = position;
    primitive.attributes["NORMAL"] = add_accessor(normals, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3, TINYGLTF_TARGET_ARRAY_BUFFER);
    primitive.attributes["COLOR_0"] =
        add_accessor(colours, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_VEC4, TINYGLTF_TARGET_ARRAY_BUFFER, true);
    primitive.indices =
        add_accessor(indices, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    tinygltf::Mesh out;
    out.name = name;
    out.primitives.push_back(std::move(primitive));
    model_.meshes.push_back(std::move(out));
    return static_cast<int>(model_.meshes.size()) - 1;
  }

  tinygltf::Model model_;
};

using Object = tinygltf::Value::Object;

tinygltf::Value triple(const Eigen::Vector3d& v) {
  return tinygltf::Value(tinygltf::Value::Array{tinygltf::Value(v.x()), tinygltf::Value(v.y()), tinygltf::Value(v.z())});
}

// The class is given to objects with a surface only: readers take it as an object to be boxed, which needs triangles.
tinygltf::Value extras_of(const MappedObject& object, bool has_surface) {
  const Cuboid box = canonical(object.cuboid);
  Object cuboid{
      {"frame", tinygltf::Value(box.frame)}, {"centre", triple(box.centre)}, {"yaw", tinygltf::Value(box.yaw)}, {"size", triple(box.size)}};
  Object own{{"id", tinygltf::Value(object.id)},
             {"score", tinygltf::Value(static_cast<double>(object.score))},
             {"cuboid", tinygltf::Value(cuboid)}};
  own[has_surface ? "class" : "class_without_surface"] = tinygltf::Value(object.class_name);
  return tinygltf::Value(Object{{"waretwin", tinygltf::Value(own)}});
}

}  // namespace

void write_map_glb(const std::filesystem::path& file, const SurfaceMesh& mesh, const ObjectList& objects) {
  // Labels that no object has any more belong to the background.
  SurfaceMesh relabelled = mesh;
  for (std::int32_t& label : relabelled.labels) {
    const auto same = [&](const MappedObject& object) { return object.id == label; };
    if (label != 0 && std::none_of(objects.begin(), objects.end(), same)) label = 0;
  }
  const auto parts = split_by_label(relabelled);
  const auto part = [&](std::int32_t label) -> const SurfaceMesh* {
    for (const auto& [part_label, part_mesh] : parts) {
      if (part_label == label) return &part_mesh;
    }
    return nullptr;
  };
  Builder builder;
  builder.add_node("background", part(0), tinygltf::Value(Object{{"waretwin", tinygltf::Value(Object{{"id", tinygltf::Value(0)}})}}));
  for (const MappedObject& object : objects) {
    const SurfaceMesh* surface = part(object.id);
    const bool has_surface = surface && !surface->triangles.empty();
    builder.add_node(object.class_name + "_" + std::to_string(object.id), surface, extras_of(object, has_surface));
  }
  write_file(file, builder.bytes());
}

}  // namespace waretwin

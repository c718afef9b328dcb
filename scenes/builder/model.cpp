#include "scenes/builder/model.h"

#include <tiny_gltf.h>

#include <cmath>
#include <cstring>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "core/error.h"
#include "core/parallel.h"
#include "core/pose.h"

namespace waretwin::builder {
namespace {

using tinygltf::Value;

// Lengths and directions are rounded to what matters (10 um, 1e-4), so that the last bits of libm's sine do not reach the file.
float rounded(double value, double step) {
  const double r = std::round(value / step) * step;
  return static_cast<float>(r == 0 ? 0.0 : r);
}
double rounded_json(double value) {
  const double r = std::round(value * 1e6) / 1e6;
  return r == 0 ? 0.0 : r;
}

Eigen::Vector3d linear(const Eigen::Vector3d& srgb) {
  return srgb.unaryExpr([](double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); });
}

std::vector<double> numbers(const Eigen::Vector3d& v) { return {rounded_json(v.x()), rounded_json(v.y()), rounded_json(v.z())}; }

Eigen::Vector3d y_up(const Eigen::Vector3d& p) { return {p.x(), p.z(), -p.y()}; }

Value waretwin_extras(Value::Object ours) { return Value(Value::Object{{"waretwin", Value(std::move(ours))}}); }
Value waretwin_extras(const std::string& key, Value value) { return waretwin_extras({{key, std::move(value)}}); }

// The one buffer of a .glb, filled piece by piece.
class Buffer {
 public:
  explicit Buffer(tinygltf::Model& model) : model_(model) { model_.buffers.emplace_back(); }

  int add_view(const void* data, std::size_t size, int target) {
    std::vector<unsigned char>& bytes = model_.buffers[0].data;
    bytes.resize((bytes.size() + 3) / 4 * 4);
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = bytes.size();
    view.byteLength = size;
    view.target = target;
    const auto* first = static_cast<const unsigned char*>(data);
    bytes.insert(bytes.end(), first, first + size);
    model_.bufferViews.push_back(view);
    return static_cast<int>(model_.bufferViews.size() - 1);
  }

  int add_accessor(const std::vector<float>& values, int components, bool with_bounds) {
    tinygltf::Accessor a;
    a.bufferView = add_view(values.data(), values.size() * sizeof(float), TINYGLTF_TARGET_ARRAY_BUFFER);
    a.componentType = TINYGLTF_COMPONENT_TYPE_FLOAT;
    a.type = components == 3 ? TINYGLTF_TYPE_VEC3 : TINYGLTF_TYPE_VEC2;
    const auto n = static_cast<std::size_t>(components);
    a.count = values.size() / n;
    if (with_bounds) {
      for (std::size_t k = 0; k < n; ++k) {
        float low = values[k], high = values[k];
        for (std::size_t i = k; i < values.size(); i += n) {
          low = std::min(low, values[i]);
          high = std::max(high, values[i]);
        }
        a.minValues.push_back(static_cast<double>(low));
        a.maxValues.push_back(static_cast<double>(high));
      }
    }
    model_.accessors.push_back(a);
    return static_cast<int>(model_.accessors.size() - 1);
  }

  int add_indices(const std::vector<std::uint32_t>& indices, std::size_t vertices) {
    tinygltf::Accessor a;
    if (vertices <= 65535) {
      const std::vector<std::uint16_t> narrow(indices.begin(), indices.end());
      a.bufferView = add_view(narrow.data(), narrow.size() * 2, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
      a.componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
    } else {
      a.bufferView = add_view(indices.data(), indices.size() * 4, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
      a.componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    }
    a.type = TINYGLTF_TYPE_SCALAR;
    a.count = indices.size();
    model_.accessors.push_back(a);
    return static_cast<int>(model_.accessors.size() - 1);
  }

 private:
  tinygltf::Model& model_;
};

tinygltf::Primitive to_primitive(Buffer& buffer, int material, const Finish& finish, const Shape& shape) {
  std::vector<float> positions, normals, uv;
  for (const Vector3d& p : shape.positions) {
    const Vector3d q = y_up(p);
    for (int k = 0; k < 3; ++k) positions.push_back(rounded(q[k], 1e-5));
  }
  for (const Vector3d& n : shape.normals) {
    const Vector3d q = y_up(n);
    for (int k = 0; k < 3; ++k) normals.push_back(rounded(q[k], 1e-4));
  }
  for (const Vector2d& t : shape.uv) {
    uv.push_back(rounded(t.x() / finish.texture_width_m, 1e-4));
    uv.push_back(rounded(t.y() / finish.texture_height_m, 1e-4));
  }
  tinygltf::Primitive primitive;
  primitive.mode = TINYGLTF_MODE_TRIANGLES;
  primitive.material = material;
  primitive.attributes["POSITION"] = buffer.add_accessor(positions, 3, true);
  primitive.attributes["NORMAL"] = buffer.add_accessor(normals, 3, false);
  if (!finish.texture.empty()) primitive.attributes["TEXCOORD_0"] = buffer.add_accessor(uv, 2, false);
  primitive.indices = buffer.add_indices(shape.triangles, shape.positions.size());
  return primitive;
}

struct DrawnFinish {
  Finish finish;
  std::vector<unsigned char> image;  // encoded; empty: no texture
  std::string mime_type;
};

DrawnFinish drawn(const std::string& name, const std::function<Finish()>& make) {
  DrawnFinish result{make(), {}, ""};
  result.finish.name = name;
  if (result.finish.texture.empty()) return result;
  const bool lossless = result.finish.picture || result.finish.alpha_mask;
  const bool done = lossless ? cv::imencode(".png", result.finish.texture, result.image, {cv::IMWRITE_PNG_COMPRESSION, 9})
                             : cv::imencode(".jpg", result.finish.texture, result.image, {cv::IMWRITE_JPEG_QUALITY, 85});
  WARETWIN_CHECK(done, "a drawn texture can be encoded");
  result.mime_type = lossless ? "image/png" : "image/jpeg";
  return result;
}

}  // namespace

void MeshDraft::add(int material, const Shape& shape) { parts_[material].append(shape); }

Eigen::Isometry3d Placement::pose() const { return make_upright_pose(x, y, z, to_radians(yaw_deg)); }

int Model::add_material(const std::string& name, std::function<Finish()> finish) {
  materials_.push_back({name, std::move(finish)});
  return static_cast<int>(materials_.size() - 1);
}

int Model::add_mesh(const std::string& name, const MeshDraft& draft) {
  WARETWIN_CHECK(!draft.empty(), "a mesh has triangles");
  meshes_.push_back({name, draft.parts()});
  return static_cast<int>(meshes_.size() - 1);
}

int Model::add_node(const std::string& name, int parent, const Eigen::Isometry3d& pose, int mesh) {
  WARETWIN_CHECK(parent < static_cast<int>(nodes_.size()) && mesh < static_cast<int>(meshes_.size()), "parent and mesh exist");
  nodes_.push_back({name, parent, mesh, -1, pose, ""});
  return static_cast<int>(nodes_.size() - 1);
}

void Model::set_class(int node, const std::string& class_name) { nodes_[static_cast<std::size_t>(node)].class_name = class_name; }

int Model::add_lamp(int parent, const Eigen::Isometry3d& pose, const Lamp& lamp) {
  const int node = add_node(lamp.name, parent, pose);
  lamps_.push_back(lamp);
  nodes_.back().lamp = static_cast<int>(lamps_.size() - 1);
  return node;
}

std::size_t Model::triangle_count() const {
  std::size_t count = 0;
  for (const StoredNode& node : nodes_) {
    if (node.mesh < 0) continue;
    for (const auto& [material, shape] : meshes_[static_cast<std::size_t>(node.mesh)].parts) count += shape.triangles.size() / 3;
  }
  return count;
}

Eigen::AlignedBox3d Model::bounds() const {
  Eigen::AlignedBox3d box;
  std::vector<Eigen::Isometry3d> X_TN;  // a parent comes before its children
  for (const StoredNode& node : nodes_) {
    X_TN.push_back(node.parent < 0 ? node.pose : X_TN[static_cast<std::size_t>(node.parent)] * node.pose);
    if (node.mesh < 0) continue;
    for (const auto& [material, shape] : meshes_[static_cast<std::size_t>(node.mesh)].parts) {
      for (const Vector3d& p : shape.positions) box.extend(X_TN.back() * p);
    }
  }
  return box;
}

std::string Model::to_glb(const std::string& title) const {
  tinygltf::Model gltf;
  gltf.asset.version = "2.0";
  gltf.asset.generator = "waretwin_build_halls";
  Buffer buffer(gltf);

  tinygltf::Sampler repeat;
  repeat.wrapS = repeat.wrapT = TINYGLTF_TEXTURE_WRAP_REPEAT;
  repeat.magFilter = TINYGLTF_TEXTURE_FILTER_LINEAR;
  tinygltf::Sampler clamp = repeat;
  clamp.wrapS = clamp.wrapT = TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
  gltf.samplers = {repeat, clamp};

  std::vector<DrawnFinish> finishes(materials_.size());
  parallel_for(materials_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) finishes[i] = drawn(materials_[i].name, materials_[i].finish);
  });
  for (const DrawnFinish& stored : finishes) {
    const Finish& finish = stored.finish;
    tinygltf::Material m;
    m.name = finish.name;
    const std::vector<double> colour = numbers(linear(finish.colour));
    m.pbrMetallicRoughness.baseColorFactor = {colour[0], colour[1], colour[2], 1.0};
    m.pbrMetallicRoughness.metallicFactor = finish.metallic;
    m.pbrMetallicRoughness.roughnessFactor = finish.roughness;
    m.emissiveFactor = numbers(finish.emissive);
    m.doubleSided = finish.double_sided;
    if (finish.alpha_mask) m.alphaMode = "MASK";
    Value::Object extras{{"reflectivity_850nm", Value(finish.reflectivity_850nm)}};
    if (finish.retroreflective) extras["retroreflective"] = Value(true);
    m.extras = waretwin_extras(std::move(extras));
    if (!stored.image.empty()) {
      tinygltf::Image image;
      image.name = finish.name;
      image.mimeType = stored.mime_type;
      image.bufferView = buffer.add_view(stored.image.data(), stored.image.size(), 0);
      gltf.images.push_back(image);
      tinygltf::Texture texture;
      texture.source = static_cast<int>(gltf.images.size() - 1);
      texture.sampler = finish.picture ? 1 : 0;
      gltf.textures.push_back(texture);
      m.pbrMetallicRoughness.baseColorTexture.index = static_cast<int>(gltf.textures.size() - 1);
      if (finish.texture_glows) m.emissiveTexture.index = m.pbrMetallicRoughness.baseColorTexture.index;
    }
    gltf.materials.push_back(m);
  }

  for (const StoredMesh& stored : meshes_) {
    tinygltf::Mesh mesh;
    mesh.name = stored.name;
    for (const auto& [material, shape] : stored.parts) {
      mesh.primitives.push_back(to_primitive(buffer, material, finishes[static_cast<std::size_t>(material)].finish, shape));
    }
    gltf.meshes.push_back(mesh);
  }

  for (const Lamp& lamp : lamps_) {
    tinygltf::Light light;
    light.name = lamp.name;
    light.type = lamp.spot ? "spot" : "point";
    light.color = numbers(lamp.colour);
    light.intensity = lamp.intensity_cd;
    light.spot.innerConeAngle = rounded_json(to_radians(lamp.inner_cone_deg));
    light.spot.outerConeAngle = rounded_json(to_radians(lamp.outer_cone_deg));
    light.extras = waretwin_extras("radius_m", Value(lamp.radius_m));
    gltf.lights.push_back(light);
  }
  if (!lamps_.empty()) gltf.extensionsUsed.push_back("KHR_lights_punctual");

  tinygltf::Scene scene;
  scene.name = title;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const StoredNode& stored = nodes_[i];
    tinygltf::Node node;
    node.name = stored.name;
    node.mesh = stored.mesh;
    if (!stored.pose.translation().isZero()) node.translation = numbers(y_up(stored.pose.translation()));
    Eigen::Quaterniond q(stored.pose.linear());
    Eigen::Vector3d axis = y_up(q.vec());
    if (stored.lamp >= 0) {
      // A glTF light shines along its node's -z, ours along -z of a z-up node, which is -y there.
      const Eigen::Quaterniond turned = Eigen::Quaterniond(q.w(), axis.x(), axis.y(), axis.z()) *
                                        Eigen::Quaterniond(Eigen::AngleAxisd(to_radians(-90), Eigen::Vector3d::UnitX()));
      q.w() = turned.w();
      axis = turned.vec();
      Value::Object reference{{"light", Value(stored.lamp)}};
      node.extensions["KHR_lights_punctual"] = Value(reference);
    }
    if (!axis.isZero(1e-12)) {
      node.rotation = numbers(axis);
      node.rotation.push_back(rounded_json(q.w()));
    }
    if (!stored.class_name.empty()) node.extras = waretwin_extras("class", Value(stored.class_name));
    gltf.nodes.push_back(node);
    if (stored.parent < 0) {
      scene.nodes.push_back(static_cast<int>(i));
    } else {
      gltf.nodes[static_cast<std::size_t>(stored.parent)].children.push_back(static_cast<int>(i));
    }
  }
  gltf.scenes.push_back(scene);
  gltf.defaultScene = 0;

  std::ostringstream out;
  tinygltf::TinyGLTF writer;
  WARETWIN_CHECK(writer.WriteGltfSceneToStream(&gltf, out, false, true), "a model in memory can be written");
  return out.str();
}

}  // namespace waretwin::builder

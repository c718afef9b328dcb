#include "scenes/gltf_meshes.h"

#include <algorithm>
#include <cmath>

#include "scenes/gltf_accessors.h"

namespace waretwin {

namespace {

// Strips and fans as lists; triangles of a strip that only stitch (two equal corners) are left out.
std::vector<std::uint32_t> as_triangle_list(std::vector<std::uint32_t> indices, int mode) {
  if (mode == TINYGLTF_MODE_TRIANGLES) return indices;
  std::vector<std::uint32_t> list;
  for (std::size_t i = 0; i + 2 < indices.size(); ++i) {
    std::uint32_t a = indices[i], b = indices[i + 1], c = indices[i + 2];
    if (mode == TINYGLTF_MODE_TRIANGLE_FAN) {
      a = indices[i + 1], b = indices[i + 2], c = indices[0];
    } else if (i % 2 == 1) {
      std::swap(b, c);
      // glTF 2.0, section 3.7.2.1: triangle i is {i, i + (1 + i % 2), i + (2 - i % 2)}.
    }
    if (a == b || b == c || c == a) continue;
    list.insert(list.end(), {a, b, c});
  }
  return list;
}

template <int N>
Eigen::Matrix<float, N, 1> vector_at(const AccessorValues& values, std::size_t i) {
  return Eigen::Map<const Eigen::Matrix<float, N, 1>>(values.values.data() + i * N);
}

Eigen::Vector3f scaled_normal(const Mesh& mesh, std::size_t triangle) {
  const Eigen::Vector3f& a = mesh.positions[mesh.triangles[3 * triangle]];
  const Eigen::Vector3f& b = mesh.positions[mesh.triangles[3 * triangle + 1]];
  const Eigen::Vector3f& c = mesh.positions[mesh.triangles[3 * triangle + 2]];
  return (b - a).cross(c - a);
}

Eigen::Vector3f unit_or_up(const Eigen::Vector3f& v) {
  // Far from float's ends, so that tiny triangles keep their direction.
  const Eigen::Vector3d wide = v.cast<double>();
  const double length = wide.norm();
  return length > 0.0 && std::isfinite(length) ? Eigen::Vector3f((wide / length).cast<float>()) : Eigen::Vector3f(Eigen::Vector3f::UnitY());
}

template <class T>
void unshare(std::vector<T>& values, const std::vector<std::uint32_t>& triangles) {
  if (values.empty()) return;
  std::vector<T> split(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) split[i] = values[triangles[i]];
  values = std::move(split);
}

// Each triangle gets corners and a normal of its own: glTF 2.0, section 3.7.2.1, "when normals are not specified, client implementations
// MUST calculate flat normals and the provided tangents (if present) MUST be ignored".
void make_flat(Mesh& mesh) {
  mesh.tangents.clear();
  unshare(mesh.positions, mesh.triangles);
  unshare(mesh.uv[0], mesh.triangles);
  unshare(mesh.uv[1], mesh.triangles);
  unshare(mesh.colours, mesh.triangles);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) mesh.triangles[i] = static_cast<std::uint32_t>(i);
  mesh.normals.resize(mesh.positions.size());
  for (std::size_t t = 0; 3 * t < mesh.triangles.size(); ++t) {
    const Eigen::Vector3f normal = unit_or_up(scaled_normal(mesh, t));
    for (std::size_t corner = 0; corner < 3; ++corner) mesh.normals[3 * t + corner] = normal;
  }
}

// Files hold normals of length zero and not quite one. Returns how many had no direction and took that of their triangles.
std::size_t repair_normals(Mesh& mesh) {
  std::size_t repaired = 0;
  std::vector<Eigen::Vector3f> from_faces;
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
    if (mesh.normals[i].squaredNorm() > 1e-12f) {
      mesh.normals[i] = unit_or_up(mesh.normals[i]);
      continue;
    }
    if (from_faces.empty()) {
      from_faces.assign(mesh.positions.size(), Eigen::Vector3f::Zero());
      for (std::size_t t = 0; 3 * t < mesh.triangles.size(); ++t) {
        const Eigen::Vector3f normal = scaled_normal(mesh, t);
        for (std::size_t corner = 0; corner < 3; ++corner) from_faces[mesh.triangles[3 * t + corner]] += normal;
      }
    }
    mesh.normals[i] = unit_or_up(from_faces[i]);
    ++repaired;
  }
  return repaired;
}

}  // namespace

const std::vector<int>& MeshLoader::primitives(int mesh, const std::string& used_by) {
  const auto& meshes = document_.model().meshes;
  if (mesh < 0 || static_cast<std::size_t>(mesh) >= meshes.size()) {
    document_.fail(used_by, "names mesh " + std::to_string(mesh) + " of " + std::to_string(meshes.size()));
  }
  const auto known = loaded_.find(mesh);
  if (known != loaded_.end()) return known->second;
  const tinygltf::Mesh& source = meshes[static_cast<std::size_t>(mesh)];
  const std::string element = element_name("mesh", static_cast<std::size_t>(mesh), source.name);
  std::vector<int>& result = loaded_[mesh];
  for (std::size_t i = 0; i < source.primitives.size(); ++i) {
    Mesh loaded;
    if (!load_primitive(source.primitives[i], source.name, element + " primitive " + std::to_string(i), loaded)) continue;
    content_.meshes.push_back(std::move(loaded));
    result.push_back(static_cast<int>(content_.meshes.size()) - 1);
  }
  return result;
}

bool MeshLoader::load_primitive(const tinygltf::Primitive& primitive, const std::string& name, const std::string& element, Mesh& result) {
  const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
  if (mode > TINYGLTF_MODE_TRIANGLE_FAN) document_.fail(element, "mode " + std::to_string(mode) + " is not known");
  if (mode < TINYGLTF_MODE_TRIANGLES) {
    notes_.push_back(element + ": points and lines are read over");
    return false;
  }
  if (!primitive.targets.empty()) notes_.push_back(element + ": morph targets are read over");
  if (primitive.extensions.count("KHR_draco_mesh_compression") > 0 && primitive.attributes.count("POSITION") == 0) {
    document_.fail(element, "is compressed with Draco, which is not supported");
  }

  const auto attribute = [&](const char* key) {
    const auto found = primitive.attributes.find(key);
    return found == primitive.attributes.end() ? -1 : found->second;
  };
  const int positions = attribute("POSITION");
  if (positions < 0) document_.fail(element, "has no POSITION");
  const std::size_t count = accessor_count(document_, positions);
  vertices_ += std::min(count, GltfLimits::kVertices + 1);
  if (vertices_ > GltfLimits::kVertices) {
    document_.fail(element, "brings this file beyond " + std::to_string(GltfLimits::kVertices) + " vertices");
  }
  const auto read = [&](const char* key, std::size_t min_components, std::size_t max_components) {
    AccessorValues values = read_accessor(document_, attribute(key));
    if (values.count != count) {
      document_.fail(element,
                     std::string(key) + " has " + std::to_string(values.count) + " elements but POSITION " + std::to_string(count));
    }
    if (values.components < min_components || values.components > max_components) {
      document_.fail(element, std::string(key) + " has " + std::to_string(values.components) + " numbers an element");
    }
    return values;
  };

  result.name = name;
  const AccessorValues p = read("POSITION", 3, 3);
  result.positions.resize(count);
  for (std::size_t i = 0; i < count; ++i) result.positions[i] = vector_at<3>(p, i);

  std::vector<std::uint32_t> indices;
  if (primitive.indices >= 0) {
    indices = read_indices(document_, primitive.indices);
    const auto largest = std::max_element(indices.begin(), indices.end());
    if (largest != indices.end() && *largest >= count) {
      document_.fail(element, "index " + std::to_string(*largest) + " is out of range; there are " + std::to_string(count) + " vertices");
    }
  } else {
    indices.resize(count);
    for (std::size_t i = 0; i < count; ++i) indices[i] = static_cast<std::uint32_t>(i);
  }
  if (mode == TINYGLTF_MODE_TRIANGLES && indices.size() % 3 != 0) {
    document_.fail(element, "has " + std::to_string(indices.size()) + " indices; triangles need a multiple of 3");
  }
  const std::size_t most = mode == TINYGLTF_MODE_TRIANGLES ? indices.size() / 3 : indices.size();
  triangles_ += most;
  if (triangles_ > GltfLimits::kTriangles) {
    document_.fail(element, "brings this file beyond " + std::to_string(GltfLimits::kTriangles) + " triangles");
  }
  result.triangles = as_triangle_list(std::move(indices), mode);
  if (result.triangles.empty()) {
    notes_.push_back(element + ": has no triangles");
    return false;
  }

  for (const auto& [key, set] : {std::pair{"TEXCOORD_0", 0}, std::pair{"TEXCOORD_1", 1}}) {
    if (attribute(key) < 0) continue;
    const AccessorValues uv = read(key, 2, 2);
    result.uv[set].resize(count);
    for (std::size_t i = 0; i < count; ++i) result.uv[set][i] = vector_at<2>(uv, i);
  }
  if (attribute("COLOR_0") >= 0) {
    const AccessorValues colours = read("COLOR_0", 3, 4);
    result.colours.resize(count, Eigen::Vector4f::Ones());
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t c = 0; c < colours.components; ++c) {
        result.colours[i][static_cast<Eigen::Index>(c)] = std::clamp(colours.values[i * colours.components + c], 0.0f, 1.0f);
      }
    }
  }
  if (attribute("NORMAL") >= 0) {
    const AccessorValues normals = read("NORMAL", 3, 3);
    result.normals.resize(count);
    for (std::size_t i = 0; i < count; ++i) result.normals[i] = vector_at<3>(normals, i);
    const std::size_t repaired = repair_normals(result);
    if (repaired > 0) notes_.push_back(element + ": " + std::to_string(repaired) + " normals of length 0 were made from the triangles");
    if (attribute("TANGENT") >= 0) {
      const AccessorValues tangents = read("TANGENT", 4, 4);
      result.tangents.resize(count);
      for (std::size_t i = 0; i < count; ++i) result.tangents[i] = vector_at<4>(tangents, i);
    }
  } else {
    vertices_ += result.triangles.size();
    if (vertices_ > GltfLimits::kVertices) {
      document_.fail(element, "brings this file beyond " + std::to_string(GltfLimits::kVertices) + " vertices");
    }
    make_flat(result);
  }

  const int plain = static_cast<int>(document_.model().materials.size());
  if (primitive.material >= plain) {
    document_.fail(element, "names material " + std::to_string(primitive.material) + " of " + std::to_string(plain));
  }
  result.material = primitive.material < 0 ? plain : primitive.material;
  return true;
}

}  // namespace waretwin

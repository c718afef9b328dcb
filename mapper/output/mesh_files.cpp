#include <bit>
#include <string>

#include "core/error.h"
#include "core/files.h"
#include "mapper/output/map_files.h"

namespace waretwin {

namespace {

static_assert(std::endian::native == std::endian::little, "PLY files are written as the memory holds them");

template <class T>
void append(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string header(const std::string& properties, std::size_t vertices, std::size_t faces) {
  std::string text = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(vertices) + "\n" + properties;
  if (faces > 0) text += "element face " + std::to_string(faces) + "\nproperty list uchar int vertex_indices\n";
  return text + "end_header\n";
}

constexpr const char* kPosition = "property float x\nproperty float y\nproperty float z\n";
constexpr const char* kNormal = "property float nx\nproperty float ny\nproperty float nz\n";
constexpr const char* kColour = "property uchar red\nproperty uchar green\nproperty uchar blue\n";

}  // namespace

void write_ply(const std::filesystem::path& file, const SurfaceMesh& mesh) {
  std::string bytes = header(std::string(kPosition) + kNormal + kColour, mesh.vertices.size(), mesh.triangles.size());
  bytes.reserve(bytes.size() + 27 * mesh.vertices.size() + 13 * mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    for (int k = 0; k < 3; ++k) append(bytes, mesh.vertices[i][k]);
    for (int k = 0; k < 3; ++k) append(bytes, mesh.normals[i][k]);
    append(bytes, mesh.colours[i]);
  }
  for (const auto& triangle : mesh.triangles) {
    append(bytes, std::uint8_t{3});
    append(bytes, triangle);
  }
  write_file(file, bytes);
}

void write_object_plys(const std::filesystem::path& folder, const SurfaceMesh& mesh, const ObjectList& objects) {
  make_folder(folder);
  std::vector<std::filesystem::path> old;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string stem = entry.path().stem().string();
    const bool numbered = !stem.empty() && stem.find_first_not_of("0123456789") == std::string::npos;
    if (entry.is_regular_file() && entry.path().extension() == ".ply" && numbered) old.push_back(entry.path());
  }
  for (const auto& path : old) std::filesystem::remove(path);
  for (const auto& [label, part] : split_by_label(mesh)) {
    for (const MappedObject& object : objects) {
      if (object.id == label) write_ply(folder / (std::to_string(object.id) + ".ply"), part);
    }
  }
}

void write_cloud_ply(const std::filesystem::path& file, const SurfaceMesh& mesh) {
  std::string bytes = header(std::string(kPosition) + kColour + "property int object\n", mesh.vertices.size(), 0);
  bytes.reserve(bytes.size() + 19 * mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    for (int k = 0; k < 3; ++k) append(bytes, mesh.vertices[i][k]);
    append(bytes, mesh.colours[i]);
    append(bytes, mesh.labels[i]);
  }
  write_file(file, bytes);
}

}  // namespace waretwin

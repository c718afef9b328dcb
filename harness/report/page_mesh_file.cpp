// Reading the PLY files of a run's folder (mapper/output/mesh_files.cpp writes them).
#include <algorithm>
#include <bit>
#include <cstring>
#include <sstream>
#include <string_view>

#include "core/error.h"
#include "core/files.h"
#include "harness/report/page_mesh.h"

namespace waretwin {

namespace {

static_assert(std::endian::native == std::endian::little, "PLY files are read as they stand");

struct PlyHeader {
  std::size_t vertices = 0, faces = 0, size = 0;
  std::string properties;  // the names of a vertex's, with spaces between
};

PlyHeader read_header(const std::filesystem::path& file, const std::string& bytes) {
  PlyHeader header;
  const std::size_t end = bytes.find("end_header\n");
  if (!bytes.starts_with("ply\nformat binary_little_endian 1.0\n") || end == std::string::npos)
    throw Error(file, "is no mesh that waretwin wrote; expected a binary PLY file");
  header.size = end + std::string_view("end_header\n").size();
  std::istringstream lines(bytes.substr(0, end));
  std::string line;
  bool in_vertex = false;
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    std::string word, what;
    words >> word >> what;
    if (word == "element") {
      in_vertex = what == "vertex";
      words >> (in_vertex ? header.vertices : header.faces);
    } else if (word == "property" && in_vertex) {
      words >> word;
      header.properties += (header.properties.empty() ? "" : " ") + word;
    }
  }
  return header;
}

void expect_size(const std::filesystem::path& file, std::size_t expected, std::size_t found) {
  if (expected != found)
    throw Error(file, "has " + std::to_string(found) + " bytes; expected " + std::to_string(expected) + " as its header says");
}

template <class T>
T take(const char*& at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  at += sizeof value;
  return value;
}

// No more elements than the bytes could hold, so that sizes in a damaged header do not overflow.
void expect_possible(const std::filesystem::path& file, const PlyHeader& header, std::size_t bytes) {
  if (header.vertices > bytes || header.faces > bytes) throw Error(file, "names more vertices or faces than it can hold");
}

void read_errors(const std::filesystem::path& file, PageMesh& mesh) {
  const std::string bytes = read_file(file);
  const PlyHeader header = read_header(file, bytes);
  if (header.properties != "x y z error" || header.vertices != mesh.vertices.size())
    throw Error(file, "does not hold the errors of map.ply's vertices; expected files of one run");
  expect_size(file, header.size + 16 * header.vertices, bytes.size());
  const char* at = bytes.data() + header.size;
  for (std::size_t i = 0; i < header.vertices; ++i) {
    at += 3 * sizeof(float);
    mesh.errors.push_back(take<float>(at));
    if (!(mesh.errors.back() >= 0.0f)) throw Error(file, "error " + std::to_string(i) + " is not a distance");
  }
}

}  // namespace

void write_surface_errors(const std::filesystem::path& folder, const std::vector<Eigen::Vector3f>& vertices,
                          const std::vector<float>& errors) {
  WARETWIN_CHECK(vertices.size() == errors.size(), "an error a vertex");
  std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(vertices.size()) +
                      "\nproperty float x\nproperty float y\nproperty float z\nproperty float error\nend_header\n";
  bytes.reserve(bytes.size() + 16 * vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const std::array<float, 4> row = {vertices[i].x(), vertices[i].y(), vertices[i].z(), errors[i]};
    bytes.append(reinterpret_cast<const char*>(row.data()), sizeof row);
  }
  write_file(folder / "surface_error.ply", bytes);
}

PageMesh read_page_mesh(const std::filesystem::path& folder) {
  PageMesh mesh;
  {
    const std::filesystem::path file = folder / "map.ply";
    const std::string bytes = read_file(file);
    const PlyHeader header = read_header(file, bytes);
    if (header.properties != "x y z nx ny nz red green blue")
      throw Error(file, "has vertices of '" + header.properties + "'; expected x y z nx ny nz red green blue");
    expect_possible(file, header, bytes.size());
    expect_size(file, header.size + 27 * header.vertices + 13 * header.faces, bytes.size());
    const char* at = bytes.data() + header.size;
    mesh.vertices.reserve(header.vertices);
    mesh.colours.reserve(header.vertices);
    for (std::size_t i = 0; i < header.vertices; ++i) {
      Eigen::Vector3f p;
      for (int k = 0; k < 3; ++k) p[k] = take<float>(at);
      at += 3 * sizeof(float);
      if (!p.allFinite()) throw Error(file, "vertex " + std::to_string(i) + " is not finite");
      mesh.vertices.push_back(p);
      mesh.colours.push_back(take<std::array<std::uint8_t, 3>>(at));
    }
    mesh.triangles.reserve(header.faces);
    for (std::size_t i = 0; i < header.faces; ++i) {
      const auto corners = take<std::uint8_t>(at);
      const auto triangle = take<std::array<std::uint32_t, 3>>(at);
      for (const std::uint32_t v : triangle) {
        if (corners != 3 || v >= header.vertices) throw Error(file, "face " + std::to_string(i) + " is no triangle of its vertices");
      }
      mesh.triangles.push_back(triangle);
    }
  }
  const std::filesystem::path file = folder / "cloud.ply";
  const std::string bytes = read_file(file);
  const PlyHeader header = read_header(file, bytes);
  if (header.properties != "x y z red green blue object" || header.vertices != mesh.vertices.size())
    throw Error(file, "does not hold the vertices of map.ply with their objects; expected files of one run");
  expect_size(file, header.size + 19 * header.vertices, bytes.size());
  const char* at = bytes.data() + header.size;
  mesh.labels.reserve(header.vertices);
  for (std::size_t i = 0; i < header.vertices; ++i) {
    at += 15;
    mesh.labels.push_back(take<std::int32_t>(at));
  }
  const auto is_black = [](const std::array<std::uint8_t, 3>& c) { return c[0] == 0 && c[1] == 0 && c[2] == 0; };
  if (std::all_of(mesh.colours.begin(), mesh.colours.end(), is_black)) mesh.colours.assign(mesh.colours.size(), {178, 182, 186});
  std::error_code error;
  if (std::filesystem::is_regular_file(folder / "surface_error.ply", error)) read_errors(folder / "surface_error.ply", mesh);
  return mesh;
}

}  // namespace waretwin

// The map's mesh on its way into a page: read from a run's folder, thinned, and packed into few bytes.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/pose.h"

namespace waretwin {

struct PageMesh {
  std::vector<Eigen::Vector3f> vertices;             // metres
  std::vector<std::array<std::uint8_t, 3>> colours;  // red, green, blue; one a vertex
  std::vector<std::int32_t> labels;                  // map id of each vertex, 0 = background
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<float> errors;  // distance of each vertex to the true surface, metres; empty where that is not known
};

// map.ply with the object ids of cloud.ply and, where there is one, the errors of surface_error.ply, as waretwin writes them. The black
// surface of a drive without colour comes back grey. Throws Error naming the file where one is missing or is not that.
PageMesh read_page_mesh(const std::filesystem::path& folder);

// surface_error.ply in a run's folder: a binary PLY point cloud of x, y, z, error (metres).
void write_surface_errors(const std::filesystem::path& folder, const std::vector<Eigen::Vector3f>& vertices,
                          const std::vector<float>& errors);

// At most `max_triangles` triangles: vertices of one label in one cell become one, at their mean, with their mean colour; cells are made
// larger until the triangles are few enough. Triangles that fall together to a line or onto another are left out. A mesh that is
// small enough comes back as it is. Labels of vertices never mix.
PageMesh thinned(const PageMesh& mesh, std::size_t max_triangles);

// The same mesh as bytes, little-endian.
struct PackedMesh {
  Eigen::Vector3f low = Eigen::Vector3f::Zero();  // metres; a coordinate is low + step * number
  float step = 0.0f;                              // metres, the same along all axes; a coordinate is off by at most half of it
  std::string positions;                          // 3 uint16 a vertex
  std::string colours;                            // 3 uint8 a vertex
  std::string labels;                             // a uint16 a vertex, into label_ids
  std::vector<std::int32_t> label_ids;            // ascending
  std::string errors;                             // a uint8 a vertex, in steps of kErrorStep, at most 255; empty where not known
  std::string indices;                            // 3 a triangle, uint16 up to 65536 vertices, else uint32
};

inline constexpr float kErrorStep = 0.0005f;  // metres

// Throws Error for more than 65536 labels.
PackedMesh packed(const PageMesh& mesh);

// A kept frame's camera, for first_seen.
struct SeeingCamera {
  Pose X_WC = Pose::Identity();
  double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0;  // pixels
  int width = 0, height = 0;                      // pixels
  double range_m = 5.0;
};

// Of each vertex the first camera in the list that has it in view and within range, with no vertex far before it in the same direction (a
// coarse depth image of the vertices decides); the last camera where none has, for the whole surface is there at the end. 255 without
// cameras, of which there are at most 255.
std::vector<std::uint8_t> first_seen(const PageMesh& mesh, const std::vector<SeeingCamera>& cameras);

}  // namespace waretwin

// Triangles of the surface where the volume's distance is 0, by marching cubes (Lorensen and Cline 1987).
//
// The table of cases is built from one rule (faces with two opposite corners inside keep these apart), which neighbouring cubes
// share, so that the mesh has no cracks: inside the observed space each edge belongs to two triangles.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "mapper/integrate/tsdf_volume.h"

namespace waretwin {

struct SurfaceMesh {
  std::vector<Eigen::Vector3f> vertices;                // metres, frame of the volume (W)
  std::vector<Eigen::Vector3f> normals;                 // unit length, towards free space
  std::vector<std::array<std::uint8_t, 3>> colours;     // red, green, blue
  std::vector<std::int32_t> labels;                     // L(v) of the voxel nearest to the vertex
  std::vector<std::array<std::uint32_t, 3>> triangles;  // counter-clockwise seen from free space
};

// The whole mesh; vertices are shared. Cubes of eight voxels make triangles where all eight have a surface near (has_surface) and the
// distances along no crossed edge differ by more than the truncation distance: larger steps are where two views met, not surfaces.
// Ordered by blocks: the same at any number of threads.
SurfaceMesh extract_mesh(const TsdfVolume& volume);

// The label of a triangle: the one that most of its vertices carry, the smallest where all three differ. So every triangle belongs to
// exactly one object or to the background (0).
std::int32_t triangle_label(const SurfaceMesh& mesh, std::size_t triangle);

// The triangles of one label, with the vertices that they use.
SurfaceMesh object_mesh(const SurfaceMesh& mesh, std::int32_t label);

// The same for every label that occurs, in ascending order.
std::vector<std::pair<std::int32_t, SurfaceMesh>> split_by_label(const SurfaceMesh& mesh);

}  // namespace waretwin

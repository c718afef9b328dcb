// The map as files that other programs read. Every writer replaces its file as a whole (core/files.h) and throws Error when it cannot.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mapper/integrate/distance_field.h"
#include "mapper/integrate/mesher.h"
#include "mapper/integrate/occupancy.h"
#include "mapper/object_list.h"

namespace waretwin {

// Binary little-endian PLY: vertices with x, y, z, nx, ny, nz, red, green, blue, and faces. World frame, metres.
void write_ply(const std::filesystem::path& file, const SurfaceMesh& mesh);

// ID.ply in `folder`: the part of the mesh that carries each object's label; objects without a triangle get no file. A folder from an
// earlier run loses its files ID.ply first.
void write_object_plys(const std::filesystem::path& folder, const SurfaceMesh& mesh, const ObjectList& objects);

// The mesh's vertices as a coloured point cloud, binary PLY: x, y, z, red, green, blue, object (the map id, 0 = background).
void write_cloud_ply(const std::filesystem::path& file, const SurfaceMesh& mesh);

// One node an object, named CLASS_ID, with extras {"waretwin": {"id", "class", "score", "cuboid": {"frame", "centre", "yaw", "size"}}}
// (the cuboid in the z-up world), and a node "background" with all other triangles. Vertices are turned to glTF's y up: (x, z, -y).
// Vertex colours are linear, as glTF wants them.
void write_map_glb(const std::filesystem::path& file, const SurfaceMesh& mesh, const ObjectList& objects);

// FILE.pgm and FILE.yaml as ROS map_server reads them (trinary mode): 0 occupied, 254 free, 205 unknown; the picture's first row is
// the grid's last. `file` is the .pgm.
void write_occupancy(const std::filesystem::path& file, const OccupancyGrid& grid);

// NRRD (one file, text header, then the cells): millimetres as little-endian int16, x fastest; -32768 where unknown. `space origin` is the
// centre of the first cell in the world, metres.
void write_distance_field(const std::filesystem::path& file, const DistanceField& field);

// {"frame":"world","objects":[{"id","class","centre","yaw","size","score"}]}, canonical cuboids, ascending by id.
void write_cuboids(const std::filesystem::path& file, const std::string& frame, const ObjectList& objects);

}  // namespace waretwin

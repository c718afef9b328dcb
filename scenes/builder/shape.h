// A small kit to build meshes from: boxes, cylinders, tubes, extruded and turned profiles.
// Everything is z up in metres, triangles counter-clockwise seen from outside. Texture coordinates are metres along the surface (v grows
// downwards, as in images), so that every material keeps its true scale; a picture's quad has them from 0 to 1.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

namespace waretwin::builder {

using Eigen::Vector2d;
using Eigen::Vector3d;

struct Shape {
  std::vector<Vector3d> positions;
  std::vector<Vector3d> normals;  // unit, as many as positions
  std::vector<Vector2d> uv;       // as many as positions
  std::vector<std::uint32_t> triangles;

  Shape& append(const Shape& other);
  Shape& move(double x, double y, double z);
  Shape& rotate(const Vector3d& axis, double degrees);  // about the origin
  Shape& transform(const Eigen::Isometry3d& X);
};

// A polygon in a plane, counter-clockwise, simple (it may be concave).
using Profile = std::vector<Vector2d>;

// A box with its centre at the origin.
Shape box(double dx, double dy, double dz);
// The same with edges rounded by one chamfer of the given width and shaded smoothly.
Shape bevelled_box(double dx, double dy, double dz, double bevel);
// A box that stands on z = 0, bevelled where bevel > 0.
Shape standing_box(double dx, double dy, double dz, double bevel = 0.0);

// Between two points, smooth sides, flat ends.
Shape cylinder(const Vector3d& from, const Vector3d& to, double radius, int sides, bool caps = true);
// A profile of (radius, z) from bottom to top turned about the z axis. Corners sharper than 30 deg stay edges.
Shape turned(const Profile& radius_z, int sides);
// A round tube along a polyline, without twist.
Shape tube(const std::vector<Vector3d>& path, double radius, int sides);
// Points of a smooth curve through the given ones (Catmull-Rom), `steps` per piece.
std::vector<Vector3d> smooth_path(const std::vector<Vector3d>& points, int steps);

// A profile in the y-z plane pushed along x, from -length / 2 to length / 2, with both ends closed. Corners sharper than 30 deg stay edges.
Shape extruded(const Profile& yz, double length);
// A profile of (radius, z) swept about the z axis from angle 0 to `degrees`, with both ends closed.
Shape swept(const Profile& radius_z, double degrees, int steps);
// A flat polygon in the x-y plane, facing up.
Shape flat_polygon(const Profile& xy);

// A flat rectangle: corner, its two edges; faces along edge_u x edge_v. Metres as texture coordinates.
Shape rectangle(const Vector3d& corner, const Vector3d& edge_u, const Vector3d& edge_v);
// The same for one picture: texture coordinates from 0 to 1, the picture's lower left at `corner`.
Shape picture(const Vector3d& corner, const Vector3d& edge_u, const Vector3d& edge_v);

// Profiles.
Profile circle(double radius, int sides, const Vector2d& centre = Vector2d::Zero());
Profile rounded_rectangle(double width, double height, double radius, int steps);

}  // namespace waretwin::builder

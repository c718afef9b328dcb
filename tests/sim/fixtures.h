// Small scenes with known answers.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/pose.h"
#include "scenes/scene.h"
#include "sim/ray_caster.h"

namespace waretwin::fixtures {

inline int add_material(Scene& scene, const Eigen::Vector3f& colour, float roughness = 1.0f, float metallic = 0.0f) {
  Material material;
  material.base_colour = {colour.x(), colour.y(), colour.z(), 1.0f};
  material.roughness = roughness;
  material.metallic = metallic;
  scene.materials.push_back(material);
  return static_cast<int>(scene.materials.size()) - 1;
}

inline void add_triangle(Mesh& mesh, const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  const Eigen::Vector3f n = (b - a).cross(c - a).normalized();
  for (const Eigen::Vector3f& p : {a, b, c}) {
    mesh.positions.push_back(p);
    mesh.normals.push_back(n);
  }
  for (std::uint32_t i = 0; i < 3; ++i) mesh.triangles.push_back(first + i);
}

// a, b, c, d counter-clockwise seen from the front.
inline void add_quad(Mesh& mesh, const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c, const Eigen::Vector3f& d) {
  add_triangle(mesh, a, b, c);
  add_triangle(mesh, a, c, d);
  if (mesh.uv[0].size() + 6 == mesh.positions.size()) {
    for (const auto& [u, v] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}})
      mesh.uv[0].emplace_back(static_cast<float>(u), static_cast<float>(v));
  }
}

// From (0, 0, 0) to (1, 1, 1), faces outwards.
inline Mesh unit_box() {
  Mesh mesh;
  const auto p = [](int i) {
    return Eigen::Vector3f(static_cast<float>(i & 1), static_cast<float>(i >> 1 & 1), static_cast<float>(i >> 2 & 1));
  };
  for (const auto& f : {std::array{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}})
    add_quad(mesh, p(f[0]), p(f[1]), p(f[2]), p(f[3]));
  return mesh;
}

// Unit sphere of latitudes and longitudes with smooth normals: 4 steps^2 triangles.
inline Mesh unit_sphere(int steps) {
  Mesh mesh;
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; j <= 2 * steps; ++j) {
      const double t = std::numbers::pi * i / steps, p = std::numbers::pi * j / steps;
      mesh.positions.push_back(Eigen::Vector3d(std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t)).cast<float>());
      mesh.normals.push_back(mesh.positions.back());
      mesh.uv[0].emplace_back(static_cast<float>(j) / static_cast<float>(2 * steps), static_cast<float>(i) / static_cast<float>(steps));
    }
  }
  const auto at = [steps](int i, int j) { return static_cast<std::uint32_t>(i * (2 * steps + 1) + j); };
  for (int i = 0; i < steps; ++i) {
    for (int j = 0; j < 2 * steps; ++j) {
      for (const std::uint32_t k : {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j), at(i + 1, j + 1), at(i, j + 1)})
        mesh.triangles.push_back(k);
    }
  }
  return mesh;
}

inline int add_mesh(Scene& scene, Mesh mesh, int material) {
  mesh.material = material;
  scene.meshes.push_back(std::move(mesh));
  return static_cast<int>(scene.meshes.size()) - 1;
}

inline int add_instance(Scene& scene, int mesh, const Eigen::Affine3f& X_WM = Eigen::Affine3f::Identity(), int object = -1) {
  Instance instance;
  instance.mesh = mesh;
  instance.X_WM = X_WM;
  instance.object = object;
  scene.instances.push_back(instance);
  return static_cast<int>(scene.instances.size()) - 1;
}

inline Eigen::Affine3f placed(const Eigen::Vector3f& low, const Eigen::Vector3f& size, float yaw = 0.0f) {
  Eigen::Affine3f X_WM = Eigen::Affine3f::Identity();
  X_WM.linear() = Eigen::AngleAxisf(yaw, Eigen::Vector3f::UnitZ()).toRotationMatrix();
  for (int axis = 0; axis < 3; ++axis) X_WM.linear().col(axis) *= size[axis];
  X_WM.translation() = low;
  return X_WM;
}

// Index of a new object; its cuboid is the instance's box where that is upright.
inline int add_object(Scene& scene, const std::string& class_name) {
  TrueObject object;
  object.id = static_cast<int>(scene.objects.size()) + 1;
  object.class_name = class_name;
  object.name = class_name + std::to_string(object.id);
  scene.objects.push_back(object);
  return object.id - 1;
}

inline Light point_light(const Eigen::Vector3f& position, float candela, float radius = 0.0f) {
  Light light;
  light.position = position;
  light.intensity = Eigen::Vector3f::Constant(candela);
  light.radius = radius;
  return light;
}

// A retroreflective square across the x axis, `size` wide and high, its right lower corner at (x, y, z); dark by itself.
inline int add_marker(Scene& scene, const Eigen::Vector3f& corner, float size, float retroreflection) {
  const int material = add_material(scene, {0.05f, 0.05f, 0.05f});
  scene.materials.back().retroreflection = retroreflection;
  Mesh marker;
  const Eigen::Vector3f left(0.0f, size, 0.0f), up(0.0f, 0.0f, size);
  add_quad(marker, corner, corner + up, corner + up + left, corner + left);
  return add_instance(scene, add_mesh(scene, marker, material));
}

// A room seen from inside: floor at z = 0, walls at the given distances from the origin.
inline Scene room(float x0, float x1, float y0, float y1, float height, const Eigen::Vector3f& colour = {0.7f, 0.7f, 0.7f}) {
  Scene scene;
  scene.name = "room";
  const int mesh = add_mesh(scene, unit_box(), add_material(scene, colour));
  add_instance(scene, mesh, placed({x0, y0, 0.0f}, {x1 - x0, y1 - y0, height}));
  return scene;
}

// A hall for pictures and timings: textured floor, walls, pallets with boxes, four conveyor-like tables, spheres; about 4 * detail^2
// triangles in each of 20 spheres.
inline Scene busy_hall(int detail) {
  Scene scene = room(-6, 6, -3, 3, 4.0f, {0.75f, 0.74f, 0.70f});
  scene.name = "busy_hall";
  Texture tiles;
  tiles.width = tiles.height = 256;
  for (int y = 0; y < 256; ++y) {
    for (int x = 0; x < 256; ++x) {
      const int noise = (x * 7919 + y * 104729 + x * y * 31) % 23;
      const bool joint = x < 2 || y < 2;
      const auto grey = static_cast<std::uint8_t>(joint ? 90 : 165 + noise);
      for (const std::uint8_t value : {grey, grey, static_cast<std::uint8_t>(grey - 6), std::uint8_t{255}}) tiles.rgba.push_back(value);
    }
  }
  scene.textures.push_back(tiles);
  const int floor_material = add_material(scene, {1, 1, 1}, 0.5f);
  scene.materials.back().base_colour_texture.texture = 0;
  scene.materials.back().base_colour_texture.uv_transform << 12, 0, 0, 0, 6, 0;
  Mesh floor;
  add_quad(floor, {-6, -3, 0.002f}, {6, -3, 0.002f}, {6, 3, 0.002f}, {-6, 3, 0.002f});
  add_instance(scene, add_mesh(scene, floor, floor_material));
  const int box = add_mesh(scene, unit_box(), add_material(scene, {0.55f, 0.38f, 0.2f}));
  const int cabinet = add_mesh(scene, unit_box(), add_material(scene, {0.08f, 0.08f, 0.09f}, 0.6f));
  const int green = add_mesh(scene, unit_box(), add_material(scene, {0.1f, 0.6f, 0.15f}, 0.5f));
  const int steel = add_mesh(scene, unit_box(), add_material(scene, {0.8f, 0.8f, 0.82f}, 0.35f, 1.0f));
  const int belt = add_mesh(scene, unit_box(), add_material(scene, {0.03f, 0.03f, 0.03f}, 0.8f));
  const int ball = add_mesh(scene, unit_sphere(detail), add_material(scene, {0.3f, 0.45f, 0.8f}, 0.3f));
  for (int i = 0; i < 4; ++i) {
    const float x = -4.2f + 2.6f * static_cast<float>(i), y = i % 2 == 0 ? 1.6f : -2.4f;
    const int object = add_object(scene, "conveyor");
    add_instance(scene, cabinet, placed({x, y, 0}, {0.8f, 0.8f, 0.75f}));
    add_instance(scene, green, placed({x + 0.1f, y + 0.2f, 0.75f}, {0.6f, 0.4f, 0.05f}), object);
    add_instance(scene, steel, placed({x + 0.1f, y + 0.2f, 0.80f}, {0.6f, 0.4f, 0.07f}), object);
    add_instance(scene, belt, placed({x + 0.1f, y + 0.24f, 0.87f}, {0.6f, 0.32f, 0.03f}), object);
    TrueObject& truth = scene.objects[static_cast<std::size_t>(object)];
    truth.cuboid.centre = {x + 0.4, y + 0.4, 0.825};
    truth.cuboid.size = {0.6, 0.4, 0.15};
  }
  for (int i = 0; i < 20; ++i) {
    const float x = -5.5f + 0.57f * static_cast<float>(i), y = i % 2 == 0 ? -2.7f : 2.7f;
    add_instance(scene, box,
                 placed({x - 0.2f, y - 0.2f, 0}, {0.4f, 0.4f, 0.3f + 0.1f * static_cast<float>(i % 4)}, 0.05f * static_cast<float>(i)));
    add_instance(scene, ball, placed({x, y * 0.9f, 0.15f}, {0.15f, 0.15f, 0.15f}));
  }
  for (int i = 0; i < 6; ++i)
    scene.lights.push_back(point_light({-5.0f + 2.0f * static_cast<float>(i), i % 2 == 0 ? 1.0f : -1.0f, 3.6f}, 12.0f, 0.2f));
  scene.ambient = {0.35f, 0.36f, 0.38f};
  scene.background = {0.1f, 0.1f, 0.12f};
  return scene;
}

// A camera at p_W that looks along the world's x axis turned by yaw, down by pitch and over by roll (radians).
inline Pose looking(const Eigen::Vector3d& p_W, double yaw = 0.0, double pitch = 0.0, double roll = 0.0) {
  Pose X_WC = Pose::Identity();
  X_WC.linear() = rotation_from_rpy(roll, pitch, yaw) * optical_from_forward();
  X_WC.translation() = p_W;
  return X_WC;
}

inline std::shared_ptr<const RayCaster> caster_of(Scene scene) {
  return std::make_shared<const RayCaster>(std::make_shared<const Scene>(std::move(scene)));
}

}  // namespace waretwin::fixtures

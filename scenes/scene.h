// A hall as plain data, ready to be ray-cast: what the glTF loader and the scenario make and the simulation reads.
// Everything is in the world frame W (z up, metres) unless a name says otherwise; glTF's y up is turned once, in scenes/.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/cuboid.h"

namespace waretwin {

struct Texture {
  enum class Wrap { kRepeat, kClampToEdge, kMirroredRepeat };
  std::string name;
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;  // width * height * 4, row 0 at the top (v = 0), values as stored (sRGB for colour)
  Wrap wrap_u = Wrap::kRepeat, wrap_v = Wrap::kRepeat;
  bool nearest = false;  // nearest-neighbour magnification instead of bilinear
};

// Use of a texture by a material.
struct TextureUse {
  int texture = -1;  // index into Scene::textures; -1 = none
  int uv_set = 0;    // 0 or 1
  // KHR_texture_transform: (u, v) -> M * (u, v, 1).
  Eigen::Matrix<float, 2, 3> uv_transform = Eigen::Matrix<float, 2, 3>::Identity();
};

// glTF 2.0 metallic-roughness. Factors are linear, not sRGB.
struct Material {
  std::string name;
  Eigen::Vector4f base_colour = Eigen::Vector4f::Ones();
  TextureUse base_colour_texture;
  float metallic = 1.0f, roughness = 1.0f;
  TextureUse metallic_roughness_texture;  // g = roughness, b = metallic
  TextureUse normal_texture;
  float normal_scale = 1.0f;
  Eigen::Vector3f emissive = Eigen::Vector3f::Zero();
  TextureUse emissive_texture;
  bool alpha_mask = false;  // alphaMode MASK; BLEND is treated as MASK at 0.5 and reported by the loader
  float alpha_cutoff = 0.5f;
  bool double_sided = false;
  // Reflectivity at 850 nm in [0, 1] from extras; NaN = not given (a guess from colour and metalness is made by the depth camera).
  float reflectivity_850nm = std::numeric_limits<float>::quiet_NaN();
  // Light that goes back to where it came from, straight ahead, over what a white diffuse surface sends there; from extras, 0 = none.
  float retroreflection = 0.0f;
};

// One glTF primitive: triangles with one material, in its mesh's own frame M.
struct Mesh {
  std::string name;
  std::vector<Eigen::Vector3f> positions;
  std::vector<Eigen::Vector3f> normals;   // unit, as many as positions (made from the faces where the file has none)
  std::vector<Eigen::Vector2f> uv[2];     // empty or as many as positions
  std::vector<Eigen::Vector4f> colours;   // empty or as many as positions; linear, multiplies the base colour
  std::vector<Eigen::Vector4f> tangents;  // empty or as many as positions; w = handedness
  std::vector<std::uint32_t> triangles;   // 3 per triangle, indices into positions
  int material = 0;                       // index into Scene::materials
};

// A mesh placed in the hall. Meshes are shared by any number of instances.
struct Instance {
  std::string name;                                    // of the glTF node
  int mesh = 0;                                        // index into Scene::meshes
  Eigen::Affine3f X_WM = Eigen::Affine3f::Identity();  // may scale and mirror
  int object = -1;                                     // index into Scene::objects; -1 = background
};

struct Light {
  enum class Kind { kPoint, kSpot, kDirectional };
  std::string name;
  Kind kind = Kind::kPoint;
  Eigen::Vector3f position = Eigen::Vector3f::Zero();     // point, spot
  Eigen::Vector3f direction = -Eigen::Vector3f::UnitZ();  // spot, directional: where the light travels to; unit
  Eigen::Vector3f intensity = Eigen::Vector3f::Ones();    // point, spot: candela; directional: lux; linear RGB
  float range = std::numeric_limits<float>::infinity();   // metres; no light beyond
  float inner_cone = 0.0f, outer_cone = 0.785398f;        // spot: radians
  float radius = 0.0f;                                    // metres: size of the emitter, makes soft shadows; 0 = hard
};

// An object that the score counts.
struct TrueObject {
  int id = 0;  // from 1, in order of the scenario; also the value in instance images (0 = background)
  std::string name;
  std::string class_name;
  Cuboid cuboid;  // minimum-area upright box of its meshes, dx >= dy, frame "world"
};

// Instances that move together as one rigid body: a parcel, a person. They stand in the scene as if the body's frame G (the model's own,
// z up) were the world's, so Instance::X_WM is X_GM until the simulation places them.
struct Mover {
  std::string name;
  std::vector<int> instances;  // indices into Scene::instances
};

struct Scene {
  std::string name;
  std::vector<Texture> textures;
  std::vector<Material> materials;
  std::vector<Mesh> meshes;
  std::vector<Instance> instances;
  std::vector<Light> lights;
  Eigen::Vector3f ambient = Eigen::Vector3f::Constant(0.0f);     // radiance from all directions that no surface blocks
  Eigen::Vector3f background = Eigen::Vector3f::Constant(0.0f);  // radiance of rays that hit nothing
  std::vector<TrueObject> objects;
  std::vector<int> vehicle;   // instances of the robot's own model, in its frame B; not there until the simulation places them
  std::vector<Mover> movers;  // of the scenario's motion: streams' items, clutter, walkers, held things (each before its stand), in order
  std::vector<std::string> notes;  // what the loader read over or replaced, one line each

  // Of each instance: whether it is elsewhere at another time (movers and the vehicle).
  std::vector<bool> moves() const;
  std::size_t triangle_count() const;  // over all instances
  Eigen::AlignedBox3f bounds() const;  // of all instances; empty for an empty scene
};

}  // namespace waretwin

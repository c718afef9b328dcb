// A glTF model in the making: materials with their textures, meshes, a tree of nodes, lights; written as one .glb.
// Everything here is z up, as in the world; the writer turns it to glTF's y up.
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <map>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "scenes/builder/shape.h"

namespace waretwin::builder {

// What a surface looks like. Colours are sRGB in [0, 1], as a painter names them.
struct Finish {
  std::string name;
  Eigen::Vector3d colour = {1, 1, 1};  // multiplies the texture
  double metallic = 0.0, roughness = 0.7;
  Eigen::Vector3d emissive = {0, 0, 0};                  // linear
  cv::Mat texture;                                       // 8-bit BGR or BGRA; empty: none
  bool texture_glows = false;                            // the texture is emitted too (screens)
  double texture_width_m = 1.0, texture_height_m = 1.0;  // what one repeat covers; 1 x 1 also for pictures
  bool picture = false;                                  // stored without loss (PNG) and not repeated: labels, signs, screens
  bool alpha_mask = false;                               // the texture's alpha cuts
  bool double_sided = false;
  double reflectivity_850nm = 0.5;
  bool retroreflective = false;  // light goes back to where it came from
};

// The triangles of a mesh by material.
class MeshDraft {
 public:
  void add(int material, const Shape& shape);
  const std::map<int, Shape>& parts() const { return parts_; }
  bool empty() const { return parts_.empty(); }

 private:
  std::map<int, Shape> parts_;  // in order of the material's index, so that files come out the same
};

// Where a node stands in its parent.
struct Placement {
  double x = 0, y = 0, z = 0, yaw_deg = 0;
  Eigen::Isometry3d pose() const;
};

struct Lamp {
  std::string name;
  bool spot = false;           // shines along the node's -z
  double intensity_cd = 10.0;  // in the same loose unit as scenarios' exposure
  Eigen::Vector3d colour = {1, 1, 1};
  double radius_m = 0.1;
  double inner_cone_deg = 40, outer_cone_deg = 75;
};

class Model {
 public:
  // A material whose looks are drawn when the file is written, all of them side by side: drawing textures is what costs time. `finish` is
  // called once a file, from any thread, and gives the same each time.
  int add_material(const std::string& name, std::function<Finish()> finish);
  int add_mesh(const std::string& name, const MeshDraft& draft);
  // parent -1 puts the node at the top. mesh -1: a group.
  int add_node(const std::string& name, int parent, const Eigen::Isometry3d& pose, int mesh = -1);
  int add_node(const std::string& name, int parent, const Placement& at, int mesh = -1) { return add_node(name, parent, at.pose(), mesh); }
  void set_class(int node, const std::string& class_name);  // makes a node and all below it one true object
  int add_lamp(int parent, const Eigen::Isometry3d& pose, const Lamp& lamp);

  // The whole file. The same model gives the same bytes.
  std::string to_glb(const std::string& title) const;

  std::size_t triangle_count() const;  // over all nodes
  Eigen::AlignedBox3d bounds() const;  // of all nodes' meshes, in the frame of the top; empty without meshes

 private:
  struct StoredMaterial {
    std::string name;
    std::function<Finish()> finish;
  };
  struct StoredMesh {
    std::string name;
    std::map<int, Shape> parts;
  };
  struct StoredNode {
    std::string name;
    int parent = -1, mesh = -1, lamp = -1;
    Eigen::Isometry3d pose;
    std::string class_name;
  };
  std::vector<StoredMaterial> materials_;
  std::vector<StoredMesh> meshes_;
  std::vector<StoredNode> nodes_;
  std::vector<Lamp> lamps_;
};

}  // namespace waretwin::builder

// A glTF file in memory, loaded once and placed any number of times.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scenes/scene.h"

namespace waretwin {

// A node of the file's tree. Parents stand before their children.
struct ModelNode {
  std::string name;
  int parent = -1;  // index into Model::nodes
  // Pose of the node's frame N (y up, as in the file) in the model's frame P (z up, the file's origin): X_PN. May scale and mirror.
  Eigen::Affine3d X_PN = Eigen::Affine3d::Identity();
  // What extras {"waretwin": {"class": "conveyor", "name": "A1"}} say. An empty class takes the node and all below out of the object that
  // encloses it (a parcel on a conveyor).
  std::optional<std::string> class_name;
  std::string object_name;
};

struct Model {
  std::filesystem::path file;
  // Meshes, materials, textures, lights and instances in the model's frame P: z up, otherwise as the file has it. No objects.
  Scene content;
  std::vector<ModelNode> nodes;
  std::vector<int> instance_nodes;  // the node of each of content.instances
};

}  // namespace waretwin

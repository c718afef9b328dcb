// Which nodes of a model are objects that the score counts, and their true cuboids.
#pragma once

#include <string>
#include <vector>

#include "scenes/model.h"
#include "scenes/scenario.h"

namespace waretwin {

// An object of one model: its class and name, and the node it begins at (-1 = the whole model).
struct ModelObject {
  int node = -1;
  std::string name;
  std::string class_name;
};

struct ModelObjects {
  std::vector<ModelObject> objects;  // in the order of the model's nodes
  std::vector<int> of_node;          // for each node the innermost object around it, an index into `objects`; -1 = background
};

// A node is an object when its extras name a class, or when its name matches a rule (the first that matches) and it does not lie inside a
// node that the same rule has matched. With `whole_class` set the whole model is one object instead, named `whole_name`. A node with an
// empty class in its extras, and all below, belongs to no object. `matched` counts the nodes that each rule made an object of.
ModelObjects find_objects(const Model& model, const std::vector<TruthRule>& rules, const std::string& whole_class,
                          const std::string& whole_name, std::vector<int>& matched);

// The minimum-area upright box of all triangles that belong to object `object` of a model placed at X_WP. Throws Error naming file and
// node when the object has no triangles or its node's up axis (y in the file) stands more than 1 deg from the world's.
Cuboid true_cuboid(const Model& model, const ModelObjects& objects, int object, const Eigen::Affine3d& X_WP);

}  // namespace waretwin

// Models put together to one scene.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "scenes/model.h"
#include "scenes/scenario.h"
#include "scenes/scene.h"

namespace waretwin {

// How one model enters the scene.
struct Placing {
  Eigen::Affine3d X_WP = Eigen::Affine3d::Identity();  // upright: yaw, uniform scale, translation
  std::string class_name;                              // see ModelPlacement
  std::string name;                                    // of the whole model as an object
};

class SceneBuilder {
 public:
  explicit SceneBuilder(std::vector<TruthRule> rules = {}) : rules_(std::move(rules)), matched_(rules_.size(), 0) {}

  // Adds a model's instances, lights and true objects. Textures, materials and meshes are added once for each file, however often it is
  // placed. Throws Error when the model's true objects tilt or are empty.
  void place(const Model& model, const Placing& placing);

  // Adds a model's instances as one body that moves (Scene::movers). Its lights stay out: they would not move. Throws Error when it has no
  // triangles or when one of its nodes names a class: true objects stand still.
  void add_mover(const Model& model, const std::string& name);

  // The robot's own model (Scene::vehicle), in the same way.
  void add_vehicle(const Model& model);

  // Nodes that each rule has matched so far.
  const std::vector<int>& matched() const { return matched_; }

  Scene finish() { return std::move(scene_); }

 private:
  struct Offsets {
    int texture = 0, material = 0, mesh = 0;
  };
  Offsets share(const Model& model);
  std::vector<int> add_body(const Model& model);
  Instance shared_instance(const Model& model, std::size_t index, const Offsets& offsets) const;

  std::vector<TruthRule> rules_;
  std::vector<int> matched_;
  std::map<std::string, Offsets> shared_;
  Scene scene_;
};

}  // namespace waretwin

// What every part is made with: the model, the finishes by name, meshes that are made once and placed often.
#pragma once

#include <functional>
#include <map>
#include <string>

#include "scenes/builder/finishes.h"
#include "scenes/builder/model.h"

namespace waretwin::builder {

class Kit {
 public:
  Model model;

  // The material with this finish (finishes.h, or defined here), added to the model on first use.
  int material(const std::string& finish);

  // A finish of this hall's own, in place of the one of finishes.h that has its name, if any. Before the name is first used.
  void define(const std::string& name, std::function<Finish()> finish) { own_[name] = std::move(finish); }

  // The mesh of this name, made on first use: parts that look the same share one. The name must therefore hold whatever the part's
  // parameters change.
  int mesh(const std::string& name, const std::function<void(MeshDraft&)>& make);

  // A node with a mesh made as above.
  int place(const std::string& node_name, int parent, const Placement& at, const std::string& mesh_name,
            const std::function<void(MeshDraft&)>& make) {
    return model.add_node(node_name, parent, at, mesh(mesh_name, make));
  }
  int group(const std::string& name, int parent, const Placement& at = {}) { return model.add_node(name, parent, at); }

 private:
  std::map<std::string, int> materials_, meshes_;
  std::map<std::string, std::function<Finish()>> own_;
};

// "620x400": millimetres for names of meshes.
std::string in_mm(std::initializer_list<double> metres);

}  // namespace waretwin::builder

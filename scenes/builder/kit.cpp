#include "scenes/builder/kit.h"

#include <cmath>

namespace waretwin::builder {

int Kit::material(const std::string& finish) {
  const auto found = materials_.find(finish);
  if (found != materials_.end()) return found->second;
  const auto own = own_.find(finish);
  const std::function<Finish()> make = own != own_.end() ? own->second : [finish] { return make_finish(finish); };
  return materials_[finish] = model.add_material(finish, make);
}

int Kit::mesh(const std::string& name, const std::function<void(MeshDraft&)>& make) {
  const auto found = meshes_.find(name);
  if (found != meshes_.end()) return found->second;
  MeshDraft draft;
  make(draft);
  return meshes_[name] = model.add_mesh(name, draft);
}

std::string in_mm(std::initializer_list<double> metres) {
  std::string text;
  for (const double value : metres) text += (text.empty() ? "" : "x") + std::to_string(std::lround(value * 1000));
  return text;
}

}  // namespace waretwin::builder

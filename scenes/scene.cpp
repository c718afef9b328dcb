#include "scenes/scene.h"

namespace waretwin {

std::vector<bool> Scene::moves() const {
  std::vector<bool> moving(instances.size(), false);
  for (const Mover& mover : movers) {
    for (const int index : mover.instances) moving[static_cast<std::size_t>(index)] = true;
  }
  for (const int index : vehicle) moving[static_cast<std::size_t>(index)] = true;
  return moving;
}

std::size_t Scene::triangle_count() const {
  std::size_t count = 0;
  for (const Instance& instance : instances) count += meshes[static_cast<std::size_t>(instance.mesh)].triangles.size() / 3;
  return count;
}

Eigen::AlignedBox3f Scene::bounds() const {
  Eigen::AlignedBox3f box;
  for (const Instance& instance : instances) {
    for (const Eigen::Vector3f& p_M : meshes[static_cast<std::size_t>(instance.mesh)].positions) box.extend(instance.X_WM * p_M);
  }
  return box;
}

}  // namespace waretwin

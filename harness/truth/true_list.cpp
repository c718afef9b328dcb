#include "harness/truth/true_list.h"

namespace waretwin {

std::vector<ListedObject> true_list(const Scene& scene, const SurfaceCoverage* coverage) {
  std::vector<ListedObject> list;
  for (const TrueObject& object : scene.objects) {
    ListedObject truth;
    truth.id = object.id;
    truth.class_name = object.class_name;
    truth.cuboid = object.cuboid;
    truth.visible_fraction = coverage != nullptr ? coverage->fraction(object.id) : 0.0;
    list.push_back(truth);
  }
  return list;
}

}  // namespace waretwin

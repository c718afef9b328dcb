#include "sim/frame_images.h"

#include <algorithm>

namespace waretwin {

std::vector<std::string> class_names(const Scene& scene) {
  std::vector<std::string> names = {"background"};
  for (const TrueObject& object : scene.objects) {
    if (std::find(names.begin(), names.end(), object.class_name) == names.end()) names.push_back(object.class_name);
  }
  return names;
}

}  // namespace waretwin

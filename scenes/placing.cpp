#include "scenes/placing.h"

#include "core/error.h"
#include "scenes/true_cuboids.h"

namespace waretwin {

namespace {

void shift(TextureUse& use, int offset) {
  if (use.texture >= 0) use.texture += offset;
}

}  // namespace

SceneBuilder::Offsets SceneBuilder::share(const Model& model) {
  const std::string key = model.file.lexically_normal().string();
  const auto known = shared_.find(key);
  if (known != shared_.end()) return known->second;
  const Offsets offsets{static_cast<int>(scene_.textures.size()), static_cast<int>(scene_.materials.size()),
                        static_cast<int>(scene_.meshes.size())};
  const Scene& content = model.content;
  scene_.textures.insert(scene_.textures.end(), content.textures.begin(), content.textures.end());
  for (Material material : content.materials) {
    for (TextureUse* use :
         {&material.base_colour_texture, &material.metallic_roughness_texture, &material.normal_texture, &material.emissive_texture}) {
      shift(*use, offsets.texture);
    }
    scene_.materials.push_back(std::move(material));
  }
  for (const Mesh& mesh : content.meshes) {
    scene_.meshes.push_back(mesh);
    scene_.meshes.back().material += offsets.material;
  }
  for (const std::string& note : content.notes) scene_.notes.push_back(model.file.filename().string() + ": " + note);
  shared_[key] = offsets;
  return offsets;
}

Instance SceneBuilder::shared_instance(const Model& model, std::size_t index, const Offsets& offsets) const {
  Instance instance = model.content.instances[index];
  instance.mesh += offsets.mesh;
  return instance;
}

std::vector<int> SceneBuilder::add_body(const Model& model) {
  for (const ModelNode& node : model.nodes) {
    if (node.class_name && !node.class_name->empty()) {
      throw Error(model.file, "node '" + node.name + "' is of class '" + *node.class_name + "'; what moves can be no true object");
    }
  }
  if (model.content.triangle_count() == 0) throw Error(model.file, "has no triangles; expected something that can be seen and touched");
  const Offsets offsets = share(model);
  std::vector<int> instances;
  for (std::size_t i = 0; i < model.content.instances.size(); ++i) {
    instances.push_back(static_cast<int>(scene_.instances.size()));
    scene_.instances.push_back(shared_instance(model, i, offsets));
  }
  return instances;
}

void SceneBuilder::add_mover(const Model& model, const std::string& name) { scene_.movers.push_back({name, add_body(model)}); }

void SceneBuilder::add_vehicle(const Model& model) { scene_.vehicle = add_body(model); }

void SceneBuilder::place(const Model& model, const Placing& placing) {
  const Offsets offsets = share(model);
  const ModelObjects objects = find_objects(model, rules_, placing.class_name, placing.name, matched_);
  const int first = static_cast<int>(scene_.objects.size());
  for (std::size_t i = 0; i < objects.objects.size(); ++i) {
    TrueObject object;
    object.id = first + static_cast<int>(i) + 1;
    object.name = objects.objects[i].name;
    object.class_name = objects.objects[i].class_name;
    object.cuboid = true_cuboid(model, objects, static_cast<int>(i), placing.X_WP);
    scene_.objects.push_back(std::move(object));
  }
  for (std::size_t i = 0; i < model.content.instances.size(); ++i) {
    const std::size_t node = static_cast<std::size_t>(model.instance_nodes[i]);
    Instance instance = shared_instance(model, i, offsets);
    instance.X_WM = (placing.X_WP * model.nodes[node].X_PN).cast<float>();
    instance.object = objects.of_node[node] < 0 ? -1 : first + objects.of_node[node];
    scene_.instances.push_back(std::move(instance));
  }
  for (Light light : model.content.lights) {
    light.position = (placing.X_WP * light.position.cast<double>()).cast<float>();
    light.direction = (placing.X_WP.linear() * light.direction.cast<double>()).normalized().cast<float>();
    scene_.lights.push_back(std::move(light));
  }
}

}  // namespace waretwin

#include "scenes/gltf_loader.h"

#include "scenes/gltf_document.h"
#include "scenes/gltf_materials.h"
#include "scenes/gltf_meshes.h"
#include "scenes/gltf_nodes.h"
#include "scenes/placing.h"

namespace waretwin {

Model load_model(const std::filesystem::path& file) {
  const GltfDocument document(file);
  Model model;
  model.file = file;
  model.content.name = file.stem().string();
  load_materials(document, model.content, model.content.notes);
  MeshLoader meshes(document, model.content, model.content.notes);
  load_nodes(document, meshes, model);
  model.content.notes.insert(model.content.notes.begin(), document.notes.begin(), document.notes.end());
  return model;
}

Scene load_gltf(const std::filesystem::path& file) {
  SceneBuilder builder;
  builder.place(load_model(file), {});
  Scene scene = builder.finish();
  scene.name = file.stem().string();
  return scene;
}

}  // namespace waretwin

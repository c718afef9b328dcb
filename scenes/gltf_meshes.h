// Triangles of a glTF file.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "scenes/gltf_document.h"
#include "scenes/scene.h"

namespace waretwin {

// Reads meshes at first use, so that what no node shows costs nothing.
class MeshLoader {
 public:
  MeshLoader(const GltfDocument& document, Scene& content, std::vector<std::string>& notes)
      : document_(document), content_(content), notes_(notes) {}

  // Indices into content.meshes, one for each primitive of triangles of glTF mesh `mesh`. Throws Error.
  const std::vector<int>& primitives(int mesh, const std::string& used_by);

 private:
  bool load_primitive(const tinygltf::Primitive& primitive, const std::string& name, const std::string& element, Mesh& result);

  const GltfDocument& document_;
  Scene& content_;
  std::vector<std::string>& notes_;
  std::map<int, std::vector<int>> loaded_;
  std::size_t vertices_ = 0, triangles_ = 0;
};

}  // namespace waretwin

// The node tree of a glTF file: where things stand.
#pragma once

#include "scenes/gltf_document.h"
#include "scenes/gltf_meshes.h"
#include "scenes/model.h"

namespace waretwin {

// The rotation that turns glTF's frame (y up, z forward) into a model's (z up): (x, y, z) becomes (x, -z, y).
Eigen::Matrix3d z_up_from_y_up();

// Fills nodes, instances and lights of `model` with those of the file's default scene (its first one, or all roots where there is none).
// Throws Error for cycles, nodes with two parents, and transforms that are not finite or flatten a mesh.
void load_nodes(const GltfDocument& document, MeshLoader& meshes, Model& model);

}  // namespace waretwin

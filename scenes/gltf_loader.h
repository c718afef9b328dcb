// Reads glTF 2.0: .gltf and .glb, buffers and pictures inside or beside the file, node trees, shared meshes, all index and component types,
// strided and sparse accessors, triangle lists, strips and fans, metallic-roughness materials with textures, vertex colours,
// KHR_texture_transform, KHR_lights_punctual, KHR_materials_emissive_strength, KHR_mesh_quantization. y up becomes z up here and nowhere
// else: (x, y, z) of the file is (x, -z, y) of the model.
//
// What is not supported (skins, animations, morph targets, points and lines, blending, other extensions) is read over and named in
// Scene::notes; an extension that a file requires and that is not supported is an Error. So is anything damaged: each Error names file and
// element. Limits stand in gltf_document.h.
//
// Ours in extras: materials {"waretwin": {"reflectivity_850nm": 0.6}} and {"waretwin": {"retroreflective": true}} (an engineer-grade sheet,
// as 220; or a number: how many times as much light goes back as from a white diffuse surface), lights and their nodes
// {"waretwin": {"radius_m": 0.15}}, nodes {"waretwin": {"class": "conveyor", "name": "A1"}}.
#pragma once

#include <filesystem>

#include "scenes/model.h"
#include "scenes/scene.h"

namespace waretwin {

Model load_model(const std::filesystem::path& file);

// One file as a whole scene at the world's origin, with the objects that its extras name.
Scene load_gltf(const std::filesystem::path& file);

}  // namespace waretwin

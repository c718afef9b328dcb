// Pictures, textures and materials of a glTF file.
#pragma once

#include <vector>

#include "scenes/gltf_document.h"
#include "scenes/scene.h"

namespace waretwin {

// Decodes PNG and JPEG into 8-bit RGBA; `element` names the picture in errors. Adds width * height to `pixels` and throws Error when the
// sum or a side passes the limits (before decoding).
Texture decode_picture(const GltfDocument& document, const std::string& bytes, const std::string& element, std::int64_t& pixels);

// Fills textures and materials of `content`. The last material is glTF's default one, for primitives without any. Textures that no material
// uses are not decoded.
void load_materials(const GltfDocument& document, Scene& content, std::vector<std::string>& notes);

}  // namespace waretwin

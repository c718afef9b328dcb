// Numbers out of glTF accessors: strided, sparse, normalised, of any component type.
#pragma once

#include <cstdint>
#include <vector>

#include "scenes/gltf_document.h"

namespace waretwin {

struct AccessorValues {
  std::size_t count = 0;       // elements
  std::size_t components = 0;  // numbers per element, 1 to 4
  std::vector<float> values;   // count * components, normalised integers as [0, 1] or [-1, 1]; all finite
};

// Reads an accessor of scalars or vectors. Throws Error naming the accessor where it leaves its buffer, holds NaN or infinity, has an
// unknown type, or has neither data nor a count within GltfLimits.
AccessorValues read_accessor(const GltfDocument& document, int accessor);

// Reads an accessor of vertex indices (unsigned 8, 16 or 32 bit scalars).
std::vector<std::uint32_t> read_indices(const GltfDocument& document, int accessor);

// The count that an accessor claims, without reading it. Throws Error when there is no such accessor.
std::size_t accessor_count(const GltfDocument& document, int accessor);

}  // namespace waretwin

#include "scenes/gltf_accessors.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

namespace waretwin {

namespace {

const tinygltf::Accessor& accessor_at(const GltfDocument& document, int index) {
  const auto& accessors = document.model().accessors;
  if (index < 0 || static_cast<std::size_t>(index) >= accessors.size()) {
    document.fail("accessor " + std::to_string(index), "does not exist; there are " + std::to_string(accessors.size()));
  }
  return accessors[static_cast<std::size_t>(index)];
}

std::string name_of(const GltfDocument& document, int index) {
  return element_name("accessor", static_cast<std::size_t>(index), accessor_at(document, index).name);
}

template <class T>
T number_at(const char* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

// glTF 2.0, section 3.6.2.2 for the meaning of normalised integers.
float component_at(const char* at, int type, bool normalised) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: {
      const float v = number_at<std::int8_t>(at);
      return normalised ? std::max(v / 127.0f, -1.0f) : v;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: {
      const float v = number_at<std::uint8_t>(at);
      return normalised ? v / 255.0f : v;
    }
    case TINYGLTF_COMPONENT_TYPE_SHORT: {
      const float v = number_at<std::int16_t>(at);
      return normalised ? std::max(v / 32767.0f, -1.0f) : v;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: {
      const float v = number_at<std::uint16_t>(at);
      return normalised ? v / 65535.0f : v;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return static_cast<float>(number_at<std::uint32_t>(at));
    default:
      return number_at<float>(at);
  }
}

std::uint32_t index_at(const char* at, int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return number_at<std::uint8_t>(at);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return number_at<std::uint16_t>(at);
    default:
      return number_at<std::uint32_t>(at);
  }
}

bool is_index_type(int type) {
  return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
         type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

bool is_known_type(int type) {
  return is_index_type(type) || type == TINYGLTF_COMPONENT_TYPE_BYTE || type == TINYGLTF_COMPONENT_TYPE_SHORT ||
         type == TINYGLTF_COMPONENT_TYPE_FLOAT;
}

std::size_t size_of(int type) { return static_cast<std::size_t>(tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(type))); }

// `count` elements of `size` bytes, `stride` bytes apart, in a buffer view from `offset` on; proven to lie inside it.
struct Elements {
  const char* first = nullptr;
  std::size_t stride = 0;
  const char* at(std::size_t i) const { return first + i * stride; }
};

Elements locate(const GltfDocument& document, const std::string& element, int view, std::size_t offset, std::size_t count, std::size_t size,
                bool may_stride) {
  const std::string_view bytes = document.view_bytes(view, element);
  std::size_t stride = may_stride ? document.model().bufferViews[static_cast<std::size_t>(view)].byteStride : 0;
  if (stride == 0) stride = size;
  if (stride < size) {
    document.fail(element, "has elements of " + std::to_string(size) + " bytes but bufferView " + std::to_string(view) + " a stride of " +
                               std::to_string(stride));
  }
  const bool fits =
      offset <= bytes.size() && (count == 0 || (bytes.size() - offset >= size && (bytes.size() - offset - size) / stride >= count - 1));
  if (!fits) {
    document.fail(element, std::to_string(count) + " elements from byte " + std::to_string(offset) + " leave bufferView " +
                               std::to_string(view) + " of " + std::to_string(bytes.size()) + " bytes");
  }
  return {bytes.data() + (count == 0 ? 0 : offset), stride};
}

// The elements that a sparse accessor replaces: calls replace(index of the element, its bytes).
template <class Replace>
void visit_sparse(const GltfDocument& document, const tinygltf::Accessor& accessor, const std::string& element, std::size_t size,
                  const Replace& replace) {
  if (!accessor.sparse.isSparse) return;
  if (accessor.sparse.count < 0) document.fail(element, "sparse part has an absurd count");
  const std::size_t count = static_cast<std::size_t>(accessor.sparse.count);
  if (count > accessor.count) document.fail(element, "sparse part has more elements than the accessor");
  const int index_type = accessor.sparse.indices.componentType;
  if (!is_index_type(index_type)) document.fail(element, "sparse indices have component type " + std::to_string(index_type));
  if (accessor.sparse.indices.byteOffset < 0 || accessor.sparse.values.byteOffset < 0)
    document.fail(element, "sparse part has a negative offset");
  const Elements indices = locate(document, element + " sparse indices", accessor.sparse.indices.bufferView,
                                  static_cast<std::size_t>(accessor.sparse.indices.byteOffset), count, size_of(index_type), false);
  const Elements values = locate(document, element + " sparse values", accessor.sparse.values.bufferView,
                                 static_cast<std::size_t>(accessor.sparse.values.byteOffset), count, size, false);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t index = index_at(indices.at(i), index_type);
    if (index >= accessor.count) {
      document.fail(
          element, "sparse index " + std::to_string(index) + " is out of range; there are " + std::to_string(accessor.count) + " elements");
    }
    replace(index, values.at(i));
  }
}

void check_count(const GltfDocument& document, const tinygltf::Accessor& accessor, const std::string& element) {
  if (accessor.count == 0) document.fail(element, "has no elements");
  const std::size_t limit = accessor.bufferView >= 0 ? GltfLimits::kVertices * 3 : GltfLimits::kElementsWithoutBuffer;
  if (accessor.count > limit) {
    document.fail(element, "has " + std::to_string(accessor.count) + " elements; at most " + std::to_string(limit) + " are read");
  }
}

}  // namespace

std::size_t accessor_count(const GltfDocument& document, int index) { return accessor_at(document, index).count; }

AccessorValues read_accessor(const GltfDocument& document, int index) {
  const tinygltf::Accessor& accessor = accessor_at(document, index);
  const std::string element = name_of(document, index);
  check_count(document, accessor, element);
  if (!is_known_type(accessor.componentType))
    document.fail(element, "component type " + std::to_string(accessor.componentType) + " is not known");
  AccessorValues result;
  switch (accessor.type) {
    case TINYGLTF_TYPE_SCALAR:
      result.components = 1;
      break;
    case TINYGLTF_TYPE_VEC2:
      result.components = 2;
      break;
    case TINYGLTF_TYPE_VEC3:
      result.components = 3;
      break;
    case TINYGLTF_TYPE_VEC4:
      result.components = 4;
      break;
    default:
      document.fail(element, "is a matrix; expected scalars or vectors");
  }
  const std::size_t components = result.components, width = size_of(accessor.componentType), size = width * components;
  const auto read_element = [&](std::size_t i, const char* at) {
    for (std::size_t c = 0; c < components; ++c) {
      const float value = component_at(at + c * width, accessor.componentType, accessor.normalized);
      if (!std::isfinite(value)) document.fail(element, "element " + std::to_string(i) + " is not a finite number");
      result.values[i * components + c] = value;
    }
  };
  result.count = accessor.count;
  if (accessor.bufferView >= 0) {
    const Elements elements = locate(document, element, accessor.bufferView, accessor.byteOffset, accessor.count, size, true);
    result.values.resize(accessor.count * components);
    for (std::size_t i = 0; i < accessor.count; ++i) read_element(i, elements.at(i));
  } else {
    result.values.assign(accessor.count * components, 0.0f);
  }
  visit_sparse(document, accessor, element, size, read_element);
  return result;
}

std::vector<std::uint32_t> read_indices(const GltfDocument& document, int index) {
  const tinygltf::Accessor& accessor = accessor_at(document, index);
  const std::string element = name_of(document, index);
  check_count(document, accessor, element);
  const int type = accessor.componentType;
  if (!is_index_type(type) || accessor.type != TINYGLTF_TYPE_SCALAR)
    document.fail(element, "indices must be unsigned scalars of 8, 16 or 32 bits");
  std::vector<std::uint32_t> indices;
  if (accessor.bufferView >= 0) {
    const Elements elements = locate(document, element, accessor.bufferView, accessor.byteOffset, accessor.count, size_of(type), true);
    indices.resize(accessor.count);
    for (std::size_t i = 0; i < accessor.count; ++i) indices[i] = index_at(elements.at(i), type);
  } else {
    indices.assign(accessor.count, 0);
  }
  visit_sparse(document, accessor, element, size_of(type), [&](std::size_t i, const char* at) { indices[i] = index_at(at, type); });
  return indices;
}

}  // namespace waretwin

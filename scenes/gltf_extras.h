// Reading of extensions and of {"waretwin": {...}} in extras.
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "scenes/gltf_document.h"

namespace waretwin {

// The member `key` of an object, or nullptr.
inline const tinygltf::Value* member(const tinygltf::Value& value, const std::string& key) {
  return value.IsObject() && value.Has(key) ? &value.Get(key) : nullptr;
}

// The value of extras.waretwin.key, or nullptr.
inline const tinygltf::Value* waretwin_extra(const tinygltf::Value& extras, const std::string& key) {
  const tinygltf::Value* ours = member(extras, "waretwin");
  return ours == nullptr ? nullptr : member(*ours, key);
}

// A number of `value` in [min, max]. Throws Error naming the element and key.
inline double number_in(const GltfDocument& document, const tinygltf::Value& value, const std::string& element, const std::string& key,
                        double min, double max) {
  const double number = value.IsNumber() ? value.GetNumberAsDouble() : std::nan("");
  if (!(number >= min && number <= max)) {
    document.fail(element, key + " must be a number from " + std::to_string(min) + " to " + std::to_string(max));
  }
  return number;
}

}  // namespace waretwin

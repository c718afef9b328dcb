#include "scenes/gltf_document.h"

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files.h"
#include "scenes/gltf_uri.h"

namespace waretwin {

namespace fs = std::filesystem;
using nlohmann::json;

std::string element_name(const char* kind, std::size_t index, const std::string& name) {
  std::string text = std::string(kind) + " " + std::to_string(index);
  if (name.empty()) return text;
  text += " '";
  for (const char c : name.substr(0, 80)) text += static_cast<unsigned char>(c) < 0x20 ? '?' : c;  // a message is one line
  return text + "'";
}

namespace {

[[noreturn]] void fail_at(const fs::path& file, const std::string& element, const std::string& problem) {
  throw Error(file, element.empty() ? problem : element + ": " + problem);
}

std::uint32_t u32_at(std::string_view bytes, std::size_t offset) {
  std::uint32_t value = 0;
  for (int i = 3; i >= 0; --i) value = (value << 8) | static_cast<unsigned char>(bytes[offset + static_cast<std::size_t>(i)]);
  return value;
}

struct Container {
  std::string_view json;
  std::string_view binary;
  bool has_binary = false;
};

// glTF 2.0 specification, chapter 4 (GLB file format).
Container split_glb(const fs::path& file, std::string_view bytes) {
  constexpr std::uint32_t kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;
  if (bytes.size() < 20) fail_at(file, "", "is cut off: " + std::to_string(bytes.size()) + " bytes; a .glb has at least 20");
  const std::uint32_t version = u32_at(bytes, 4), length = u32_at(bytes, 8);
  if (version != 2) fail_at(file, "", "is GLB version " + std::to_string(version) + "; expected 2");
  if (length > bytes.size()) {
    fail_at(file, "", "is cut off: " + std::to_string(bytes.size()) + " bytes of " + std::to_string(length));
  }
  if (length < 20) fail_at(file, "", "GLB header gives a length of " + std::to_string(length) + " bytes");
  bytes = bytes.substr(0, length);
  Container container;
  std::size_t at = 12;
  for (int chunk = 0; at < bytes.size(); ++chunk) {
    const std::string element = "GLB chunk " + std::to_string(chunk);
    if (bytes.size() - at < 8) fail_at(file, element, "header is cut off");
    const std::uint32_t size = u32_at(bytes, at), type = u32_at(bytes, at + 4);
    at += 8;
    if (size > bytes.size() - at) {
      fail_at(file, element, "has " + std::to_string(size) + " bytes but only " + std::to_string(bytes.size() - at) + " are left");
    }
    const std::string_view content = bytes.substr(at, size);
    if (chunk == 0 && type != kJsonChunk) fail_at(file, element, "is not JSON");
    if (chunk == 0) container.json = content;
    if (chunk == 1 && type == kBinaryChunk) container.binary = content, container.has_binary = true;
    at += size;
  }
  return container;
}

json parse_json(const fs::path& file, std::string_view text) {
  if (text.size() > GltfLimits::kJsonBytes) fail_at(file, "JSON", "has " + std::to_string(text.size()) + " bytes; that is too much");
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  while (!text.empty() && text.back() == '\0') text.remove_suffix(1);  // some writers pad with zeros in place of spaces
  try {
    const json::parser_callback_t guard = [&](int depth, json::parse_event_t, json&) {
      if (depth > GltfLimits::kJsonDepth)
        fail_at(file, "JSON", "is nested deeper than " + std::to_string(GltfLimits::kJsonDepth) + " levels");
      return true;
    };
    json root = json::parse(text.begin(), text.end(), guard);
    if (!root.is_object()) fail_at(file, "JSON", "is not an object");
    return root;
  } catch (const json::parse_error& error) {
    fail_at(file, "JSON", "cannot be read at byte " + std::to_string(error.byte));
  } catch (const json::exception&) {
    fail_at(file, "JSON", "holds a number that is out of range");
  }
}

// tinygltf reads over many values of a wrong type and cuts large integers off; here they are errors.
class ShapeCheck {
 public:
  explicit ShapeCheck(const fs::path& file) : file_(file) {}

  void check(const json& root) {
    for (const auto& [key, value] : root.items()) {
      if (key == "asset") continue;
      if (key == "scene") {
        index(value, "scene", key);
      } else if (key == "extensionsUsed" || key == "extensionsRequired") {
        check_words(value, key);
      } else if (key != "extras" && key != "extensions") {
        check_list(value, key);
      } else if (key == "extensions" && value.is_object() && value.contains("KHR_lights_punctual")) {
        const json& lights = value["KHR_lights_punctual"];
        if (!lights.is_object() || !lights.contains("lights")) fail_at(file_, "KHR_lights_punctual", "has no list of lights");
        check_list(lights["lights"], "lights");
      }
    }
  }

 private:
  static constexpr double kLargestIndex = 2147483647.0;
  static constexpr double kLargestSize = 9007199254740992.0;

  void check_words(const json& value, const std::string& key) {
    if (!value.is_array()) fail_at(file_, key, "is not a list");
    for (const json& word : value) {
      if (!word.is_string()) fail_at(file_, key, "holds something other than text");
    }
  }

  void check_list(const json& value, const std::string& key) {
    static const std::vector<std::string> known = {"accessors", "animations", "buffers", "bufferViews", "cameras", "images", "lights",
                                                   "materials", "meshes",     "nodes",   "samplers",    "scenes",  "skins",  "textures"};
    if (std::find(known.begin(), known.end(), key) == known.end()) return;
    if (!value.is_array()) fail_at(file_, key, "is not a list");
    for (std::size_t i = 0; i < value.size(); ++i) {
      const std::string element = element_name(key.c_str(), i);
      if (!value[i].is_object()) fail_at(file_, element, "is not an object");
      if (key == "nodes") check_node(value[i], element);
      if (key == "meshes") check_mesh(value[i], element);
      check_numbers(value[i], element);
    }
  }

  void check_node(const json& node, const std::string& element) {
    numbers(node, element, "matrix", 16);
    numbers(node, element, "translation", 3);
    numbers(node, element, "rotation", 4);
    numbers(node, element, "scale", 3);
  }

  void check_mesh(const json& mesh, const std::string& element) {
    if (!mesh.contains("primitives") || !mesh["primitives"].is_array()) fail_at(file_, element, "has no list of primitives");
    for (const json& primitive : mesh["primitives"]) {
      if (!primitive.is_object() || !primitive.contains("attributes") || !primitive["attributes"].is_object()) {
        fail_at(file_, element, "has a primitive without attributes");
      }
      for (const auto& [name, value] : primitive["attributes"].items()) index(value, element, "attributes." + name.substr(0, 40));
    }
  }

  void numbers(const json& object, const std::string& element, const char* key, std::size_t count) {
    const auto found = object.find(key);
    if (found == object.end()) return;
    bool good = found->is_array() && found->size() == count;
    for (std::size_t i = 0; good && i < count; ++i) good = (*found)[i].is_number() && std::isfinite((*found)[i].get<double>());
    if (!good) fail_at(file_, element, std::string(key) + " is not a list of " + std::to_string(count) + " finite numbers");
  }

  void index(const json& value, const std::string& element, const std::string& key, double largest = kLargestIndex) {
    if (!value.is_number_integer() || value.get<double>() < 0 || value.get<double>() > largest) {
      fail_at(file_, element,
              key + " is " + value.dump(-1, ' ', false, json::error_handler_t::replace).substr(0, 40) +
                  "; expected a whole number of 0 or more");
    }
  }

  // Every key that names an element, a count or an offset, wherever it stands. Depth is bounded by parse_json.
  void check_numbers(const json& value, const std::string& element) {
    static const std::vector<std::string> indices = {"mesh",      "material",  "bufferView", "buffer",   "source", "sampler",
                                                     "camera",    "skin",      "index",      "texCoord", "mode",   "componentType",
                                                     "input",     "output",    "light",      "skeleton", "target", "node",
                                                     "minFilter", "magFilter", "wrapS",      "wrapT"};
    static const std::vector<std::string> sizes = {"byteOffset", "byteLength", "byteStride", "count"};
    if (value.is_array()) {
      for (const json& item : value) check_numbers(item, element);
    }
    if (!value.is_object()) return;
    for (const auto& [key, item] : value.items()) {
      if (key == "extras") continue;
      if (item.is_object()) {
        check_numbers(item, element);
      } else if (std::find(indices.begin(), indices.end(), key) != indices.end() || (key == "indices" && !item.is_object())) {
        index(item, element, key);
      } else if (std::find(sizes.begin(), sizes.end(), key) != sizes.end()) {
        index(item, element, key, kLargestSize);
      } else if (key == "children" || key == "nodes" || key == "joints") {
        if (!item.is_array()) fail_at(file_, element, key + " is not a list");
        for (const json& child : item) index(child, element, key);
      } else if (item.is_array()) {
        check_numbers(item, element);
      }
    }
  }

  const fs::path& file_;
};

std::string text_of(const json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

json taken(json& root, const char* key) {
  const auto found = root.find(key);
  if (found == root.end()) return json::array();
  json value = std::move(*found);
  root.erase(found);
  return value;
}

bool no_file_exists(const std::string&, void*) { return false; }
std::string same_path(const std::string& path, void*) { return path; }
bool read_nothing(std::vector<unsigned char>*, std::string* problem, const std::string& path, void*) {
  *problem = "refused to read " + path;
  return false;
}
bool write_nothing(std::string* problem, const std::string& path, const std::vector<unsigned char>&, void*) {
  *problem = "refused to write " + path;
  return false;
}

void check_version(const fs::path& file, const json& root) {
  const auto asset = root.find("asset");
  const std::string version = asset != root.end() && asset->is_object() ? text_of(*asset, "version") : "";
  if (version.empty()) fail_at(file, "asset", "has no version; is this a glTF file?");
  if (!version.starts_with("2.")) fail_at(file, "asset", "glTF version " + version.substr(0, 20) + "; expected 2.x");
}

void check_extensions(const fs::path& file, const json& root, std::vector<std::string>& notes) {
  static const std::vector<std::string> supported = {"KHR_lights_punctual", "KHR_materials_emissive_strength", "KHR_mesh_quantization",
                                                     "KHR_texture_transform"};
  const auto is_supported = [](const json& name) {
    return std::find(supported.begin(), supported.end(), name.get<std::string>()) != supported.end();
  };
  if (root.contains("extensionsRequired")) {
    for (const json& name : root["extensionsRequired"]) {
      if (!is_supported(name)) fail_at(file, "extensionsRequired", name.get<std::string>().substr(0, 80) + " is not supported");
    }
  }
  if (root.contains("extensionsUsed")) {
    for (const json& name : root["extensionsUsed"]) {
      if (!is_supported(name)) notes.push_back("extension " + name.get<std::string>().substr(0, 80) + " is read over");
    }
  }
}

}  // namespace

GltfDocument::GltfDocument(const fs::path& file) : file_(file) {
  const std::string bytes = read_file(file, GltfLimits::kFileBytes);
  if (bytes.empty()) fail_at(file, "", "is empty");
  Container container{.json = bytes, .binary = {}};
  const bool is_binary = bytes.starts_with("glTF");
  if (is_binary) container = split_glb(file, bytes);
  if (!is_binary && file.extension() == ".glb") fail_at(file, "", "does not begin with 'glTF'; is this a .glb file?");
  json root = parse_json(file, container.json);
  ShapeCheck(file).check(root);
  check_version(file, root);
  check_extensions(file, root, notes);

  const fs::path folder = file.parent_path();
  const json buffers = taken(root, "buffers");
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    const std::string element = element_name("buffer", i, text_of(buffers[i], "name"));
    if (!buffers[i].contains("byteLength")) fail(element, "has no byteLength");
    const std::uint64_t length = buffers[i]["byteLength"].get<std::uint64_t>();
    const std::string uri = text_of(buffers[i], "uri");
    std::string content;
    try {
      if (is_data_uri(uri)) {
        content = decode_data_uri(uri);
      } else if (!uri.empty()) {
        content = read_file(resolve_uri(folder, uri), GltfLimits::kFileBytes);
      } else if (i == 0 && container.has_binary) {
        content = container.binary;
      } else {
        throw Error("has neither a URI nor a binary chunk");
      }
    } catch (const Error& error) {
      fail(element, error.what());
    }
    if (length > content.size()) {
      fail(element, "byteLength is " + std::to_string(length) + " but there are only " + std::to_string(content.size()) + " bytes");
    }
    content.resize(length);
    buffers_.push_back(std::move(content));
  }

  const json images = taken(root, "images");
  for (std::size_t i = 0; i < images.size(); ++i) {
    Picture picture{.name = text_of(images[i], "name"), .uri = text_of(images[i], "uri")};
    if (images[i].contains("bufferView")) picture.buffer_view = images[i]["bufferView"].get<int>();
    if (picture.uri.empty() == (picture.buffer_view < 0)) {
      fail(element_name("image", i, picture.name), "must have either a URI or a buffer view");
    }
    if (picture.name.empty() && !is_data_uri(picture.uri)) picture.name = picture.uri;
    pictures_.push_back(std::move(picture));
  }

  for (const char* key : {"animations", "skins"}) {
    const json unsupported = taken(root, key);
    if (!unsupported.empty()) notes.push_back(std::to_string(unsupported.size()) + " " + key + " read over: not supported");
  }
  taken(root, "cameras");  // a viewer's views; nothing here looks through them

  tinygltf::TinyGLTF parser;
  parser.SetFsCallbacks({no_file_exists, same_path, read_nothing, write_nothing, nullptr});
  std::string problem, warning;
  bool good = false;
  try {
    const std::string text = root.dump();
    good = parser.LoadASCIIFromString(&model_, &problem, &warning, text.data(), static_cast<unsigned int>(text.size()), "");
  } catch (const std::exception& error) {
    problem = error.what();
  }
  if (!good) fail("", "is not valid glTF: " + problem.substr(0, problem.find('\n')));
}

std::string_view GltfDocument::view_bytes(int buffer_view, const std::string& used_by) const {
  if (buffer_view < 0 || static_cast<std::size_t>(buffer_view) >= model_.bufferViews.size()) {
    fail(used_by, "names buffer view " + std::to_string(buffer_view) + " of " + std::to_string(model_.bufferViews.size()));
  }
  const tinygltf::BufferView& view = model_.bufferViews[static_cast<std::size_t>(buffer_view)];
  const std::string element = element_name("bufferView", static_cast<std::size_t>(buffer_view), view.name);
  if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= buffers_.size()) {
    fail(element, "names buffer " + std::to_string(view.buffer) + " of " + std::to_string(buffers_.size()));
  }
  const std::string& buffer = buffers_[static_cast<std::size_t>(view.buffer)];
  if (view.byteOffset > buffer.size() || view.byteLength > buffer.size() - view.byteOffset) {
    fail(element, "bytes " + std::to_string(view.byteOffset) + " + " + std::to_string(view.byteLength) + " leave buffer " +
                      std::to_string(view.buffer) + " of " + std::to_string(buffer.size()) + " bytes");
  }
  return std::string_view(buffer).substr(view.byteOffset, view.byteLength);
}

std::string GltfDocument::picture_bytes(std::size_t index) const {
  const Picture& picture = pictures_[index];
  const std::string element = element_name("image", index, picture.name);
  if (picture.buffer_view >= 0) return std::string(view_bytes(picture.buffer_view, element));
  try {
    if (is_data_uri(picture.uri)) return decode_data_uri(picture.uri);
    return read_file(resolve_uri(file_.parent_path(), picture.uri), GltfLimits::kPictureBytes);
  } catch (const Error& error) {
    fail(element, error.what());
  }
}

void GltfDocument::fail(const std::string& element, const std::string& problem) const { fail_at(file_, element, problem); }

}  // namespace waretwin

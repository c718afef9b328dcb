// A glTF file as it lies on disk: container, JSON, buffers and the bytes of pictures, checked far enough that the rest of the loader can
// follow indices without fear. The structure is tinygltf's; files and embedded data are read here, because a model comes from anywhere
// and may name only files beside or below itself.
#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace waretwin {

// What a file may hold. More is refused: it is either damage or not a hall.
struct GltfLimits {
  static constexpr std::uintmax_t kFileBytes = std::uintmax_t{2} << 30;  // a .glb or .bin
  static constexpr std::uintmax_t kJsonBytes = std::uintmax_t{256} << 20;
  static constexpr int kJsonDepth = 64;
  static constexpr std::uintmax_t kPictureBytes = std::uintmax_t{256} << 20;  // encoded
  static constexpr int kPictureSide = 16384;                                  // pixels
  static constexpr std::int64_t kPicturePixels = std::int64_t{256} << 20;     // all pictures of a file
  static constexpr std::size_t kTriangles = 50'000'000;                       // all meshes of a file
  static constexpr std::size_t kVertices = 50'000'000;
  static constexpr std::size_t kElementsWithoutBuffer = 4'000'000;  // of an accessor that is all zeros but for its sparse part
  static constexpr std::size_t kInstances = 2'000'000;
  static constexpr double kExtent = 1e6;  // metres from the origin
};

class GltfDocument {
 public:
  // Reads .glb (by its magic number) or .gltf. Throws Error naming the file and the element that is wrong.
  explicit GltfDocument(const std::filesystem::path& file);

  const std::filesystem::path& file() const { return file_; }
  const tinygltf::Model& model() const { return model_; }  // its `buffers` and `images` are empty, see below
  std::size_t picture_count() const { return pictures_.size(); }
  const std::string& picture_name(std::size_t index) const { return pictures_[index].name; }
  // Encoded bytes of a picture (PNG or JPEG), read at the call where they lie in a file of their own.
  std::string picture_bytes(std::size_t index) const;
  // The bytes of a buffer view. Throws Error where it leaves its buffer.
  std::string_view view_bytes(int buffer_view, const std::string& used_by) const;

  // Throws Error: "FILE: ELEMENT: PROBLEM".
  [[noreturn]] void fail(const std::string& element, const std::string& problem) const;

  std::vector<std::string> notes;  // what was read over

 private:
  struct Picture {
    std::string name;
    std::string uri;       // empty where the bytes lie in a buffer view
    int buffer_view = -1;  // -1 where there is a URI
  };

  std::filesystem::path file_;
  tinygltf::Model model_;
  std::vector<std::string> buffers_;
  std::vector<Picture> pictures_;
};

// "node 3 'conveyor'": how messages name an element of a file.
std::string element_name(const char* kind, std::size_t index, const std::string& name = "");

}  // namespace waretwin

// Feeds arbitrary bytes to the glTF reader: whatever they are, it loads them or throws Error.
#include <cstdint>
#include <filesystem>

#include "core/error.h"
#include "core/files.h"
#include "scenes/gltf_loader.h"
#include "tests/support/test_data.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const waretwin::test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "input.gltf";  // the magic number tells .glb apart
  waretwin::write_file(file, std::string_view(reinterpret_cast<const char*>(data), size));
  try {
    waretwin::load_gltf(file);
  } catch (const waretwin::Error&) {
  }
  return 0;
}

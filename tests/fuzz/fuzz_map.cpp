// Feeds damaged maps to the reader of map.waretwin: it throws Error, or what it read is written and read again without a change.
//
// Inputs are map files. They are mutated unpacked and packed again with a right fingerprint: behind a checksum and a compressor, mutation
// finds nothing. An input that is no map gives way to a small one, so that no corpus is needed to start from.
#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>

#include "core/digest.h"
#include "core/error.h"
#include "core/files.h"
#include "mapper/output/map_archive.h"
#include "tests/support/test_data.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

constexpr std::size_t kVersioned = 12;           // magic number, version
constexpr std::size_t kHeader = kVersioned + 8;  // fingerprint
constexpr std::size_t kMostUnpacked = std::size_t{1} << 18;

const std::filesystem::path& folder() {
  static const waretwin::test::TemporaryFolder temporary;
  return temporary.path();
}

// A map with a bit of everything: two objects, a block with a surface and labels, a block of free space.
const std::string& small_map() {
  static const std::string bytes = [] {
    waretwin::TsdfVolume volume{waretwin::TsdfConfig()};
    volume.block(volume.ensure_block({-1, 0, 2})).free_frames.fill(3);
    waretwin::SurfaceVoxels& surface = volume.ensure_surface(volume.ensure_block({0, 0, 0}));
    surface.voxels[7] = {.distance = 0.01f, .weight = 1.5f, .colour = {1, 2, 3}, .surface_frames = 4};
    surface.labels.add(7, 3, 2);
    surface.labels.add(7, 4, 1);
    waretwin::MappedObject object;
    object.id = 3;
    object.class_name = "conveyor";
    object.cuboid.size = {0.3, 0.2, 0.1};
    object.observations = 5;
    object.hsv = {0.25f, 0.75f};
    object.points_W = {{1.0f, 2.0f, 3.0f}};
    waretwin::ObjectList objects = {object, object};
    objects.back().id = 4;
    waretwin::save_map(folder() / "small.waretwin", objects, volume, 9);
    return waretwin::read_file(folder() / "small.waretwin");
  }();
  return bytes;
}

// What follows the header, unpacked as far as it goes.
std::string unpacked(const std::uint8_t* data, std::size_t size) {
  if (size <= kHeader) return {};
  std::string body(kMostUnpacked, '\0');
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) return {};
  stream.next_in = const_cast<Bytef*>(data + kHeader);
  stream.avail_in = static_cast<uInt>(size - kHeader);
  stream.next_out = reinterpret_cast<Bytef*>(body.data());
  stream.avail_out = static_cast<uInt>(body.size());
  inflate(&stream, Z_FINISH);
  body.resize(stream.total_out);
  inflateEnd(&stream);
  return body;
}

std::string packed(const std::string& body) {
  uLongf size = compressBound(body.size());
  std::string packed_body(size, '\0');
  compress2(reinterpret_cast<Bytef*>(packed_body.data()), &size, reinterpret_cast<const Bytef*>(body.data()), body.size(), 1);
  packed_body.resize(size);
  waretwin::Digest digest;
  digest.add_bytes(packed_body.data(), packed_body.size());
  const std::uint64_t print = digest.value();
  std::string bytes = small_map().substr(0, kVersioned);
  bytes.append(reinterpret_cast<const char*>(&print), sizeof print);
  return bytes + packed_body;
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size, unsigned seed) {
  if (seed % 16 == 0) return LLVMFuzzerMutate(data, size, max_size);  // the file itself now and then
  std::string body = unpacked(data, size);
  if (body.empty()) body = unpacked(reinterpret_cast<const std::uint8_t*>(small_map().data()), small_map().size());
  const std::size_t used = body.size();
  body.resize(std::min(used + 4096, kMostUnpacked));
  body.resize(LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(body.data()), used, body.size()));
  const std::string bytes = packed(body);
  if (bytes.size() > max_size) return LLVMFuzzerMutate(data, size, max_size);
  std::memcpy(data, bytes.data(), bytes.size());
  return bytes.size();
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::filesystem::path file = folder() / "map.waretwin", again = folder() / "again.waretwin";
  waretwin::write_file(file, std::string_view(reinterpret_cast<const char*>(data), size));
  try {
    const waretwin::LoadedMap map = waretwin::load_map(file);
    save_map(again, map.objects, *map.volume, map.frames);
  } catch (const waretwin::Error&) {
    return 0;
  }
  const std::string first = waretwin::read_file(again);
  const waretwin::LoadedMap map = waretwin::load_map(again);
  save_map(again, map.objects, *map.volume, map.frames);
  WARETWIN_CHECK(waretwin::read_file(again) == first, "a map that was read is written and read again without a change");
  return 0;
}

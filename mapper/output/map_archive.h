// map.waretwin: the whole map, to be taken up again later (`--resume`).
//
// "WARETWIN", a 32-bit version, a 64-bit fingerprint of all that follows, then one zlib stream: mapped frames, configuration of the volume,
// objects, blocks in sorted order. Little-endian. What was written comes back bit for bit.
#pragma once

#include <filesystem>
#include <memory>

#include "mapper/integrate/tsdf_volume.h"
#include "mapper/object_list.h"

namespace waretwin {

// `frames`: how many the map is made of; Frame_ID goes on from there.
void save_map(const std::filesystem::path& file, const ObjectList& objects, const TsdfVolume& volume, int frames = 0);

struct LoadedMap {
  ObjectList objects;
  std::unique_ptr<TsdfVolume> volume;  // never null
  int frames = 0;
};

// Throws Error naming the file when it is no map, of another version, cut short, damaged, or holds values that no map has.
LoadedMap load_map(const std::filesystem::path& file);

}  // namespace waretwin

#include "harness/units/units.h"

#include <link.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <vector>

#include "core/cpu_features.h"
#include "core/error.h"
#include "core/files.h"

namespace waretwin {

namespace {

// All of a vector's or matrix' numbers.
template <class Numbers>
void add(Digest& digest, const Numbers& numbers) {
  digest.add_bytes(numbers.data(), sizeof(typename Numbers::Scalar) * static_cast<std::size_t>(numbers.size()));
}

template <class Numbers>
void add_all(Digest& digest, const std::vector<Numbers>& list) {
  for (const Numbers& numbers : list) add(digest, numbers);
}

void add(Digest& digest, const TextureUse& use) {
  digest.add(use.texture);
  digest.add(use.uv_set);
  add(digest, use.uv_transform);
}

// Before main: what the program is linked with. What is loaded while it runs (TBB's plugins, say, which come with the second thread)
// differs from run to run.
const std::vector<std::filesystem::path> kLibraries = [] {
  std::vector<std::filesystem::path> found;
  dl_iterate_phdr(
      [](dl_phdr_info* info, std::size_t, void* list) {
        static_cast<std::vector<std::filesystem::path>*>(list)->emplace_back(info->dlpi_name);
        return 0;
      },
      &found);
  return found;
}();

// Name and size of each, sorted: another version of one is nearly always another size.
std::vector<std::string> libraries() {
  std::vector<std::string> found;
  for (const std::filesystem::path& file : kLibraries) {
    std::error_code none;
    const auto size = std::filesystem::file_size(file, none);
    if (!none) found.push_back(file.filename().string() + " " + std::to_string(size));
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace

Shard parse_shard(const std::string& text) {
  Shard shard;
  const char* const end = text.data() + text.size();
  const auto [slash, first] = std::from_chars(text.data(), end, shard.index);
  bool good = first == std::errc() && slash != end && *slash == '/';
  if (good) {
    const auto [last, second] = std::from_chars(slash + 1, end, shard.count);
    good = second == std::errc() && last == end;
  }
  if (!good || shard.count < 1 || shard.index < 0 || shard.index >= shard.count) {
    throw Error("--shard " + text + ": expected I/N with I from 0 to N - 1, e.g. 0/4");
  }
  return shard;
}

const std::string& program_identity() {
  static const std::string identity = [] {
    Digest digest;
    digest.add(read_file("/proc/self/exe"));
    for (const std::string& library : libraries()) digest.add(library);
    return digest.hex();
  }();
  return identity;
}

std::string cpu_identity() {
  Digest digest;
  digest.add(cpu_model());
  for (const std::string& feature : cpu_features()) digest.add(feature);
  return digest.hex();
}

void add_scene(const Scene& scene, Digest& digest) {
  for (const Texture& texture : scene.textures) {
    digest.add(texture.rgba);
    for (const int value : {texture.width, static_cast<int>(texture.wrap_u), static_cast<int>(texture.wrap_v), int{texture.nearest}})
      digest.add(value);
  }
  for (const Mesh& mesh : scene.meshes) {
    add_all(digest, mesh.positions);
    add_all(digest, mesh.normals);
    for (const auto& set : mesh.uv) add_all(digest, set);
    add_all(digest, mesh.colours);
    add_all(digest, mesh.tangents);
    digest.add(mesh.triangles);
    digest.add(mesh.material);
  }
  for (const Material& material : scene.materials) {
    add(digest, material.base_colour);
    add(digest, material.emissive);
    for (const TextureUse* use :
         {&material.base_colour_texture, &material.metallic_roughness_texture, &material.normal_texture, &material.emissive_texture}) {
      add(digest, *use);
    }
    digest.add(int{material.alpha_mask});
    // Not a number where the glTF file does not say: one bit pattern for all.
    const float infrared = std::isnan(material.reflectivity_850nm) ? -1.0f : material.reflectivity_850nm;
    for (const float value :
         {material.metallic, material.roughness, material.normal_scale, material.alpha_cutoff, infrared, material.retroreflection})
      digest.add(value);
  }
  for (const Instance& instance : scene.instances) {
    digest.add(instance.mesh);
    digest.add(instance.object);
    add(digest, instance.X_WM.matrix());
  }
  for (const Light& light : scene.lights) {
    digest.add(static_cast<int>(light.kind));
    for (const Eigen::Vector3f& value : {light.position, light.direction, light.intensity}) add(digest, value);
    for (const float value : {light.range, light.inner_cone, light.outer_cone, light.radius}) digest.add(value);
  }
  add(digest, scene.ambient);
  add(digest, scene.background);
  for (const TrueObject& object : scene.objects) {
    digest.add(object.id);
    digest.add(object.name);
    digest.add(object.class_name);
    add(digest, object.cuboid.centre);
    add(digest, object.cuboid.size);
    digest.add(object.cuboid.yaw);
  }
  for (const Mover& mover : scene.movers) digest.add(mover.instances);
  digest.add(scene.vehicle);
}

std::string digest_of(const Scene& scene) {
  Digest digest;
  add_scene(scene, digest);
  return digest.hex();
}

UnitStore::UnitStore(const std::filesystem::path& folder) : folder_(folder) { make_folder(folder); }

std::filesystem::path UnitStore::file(const std::string& name) const { return folder_ / (name + ".json"); }

std::optional<std::string> UnitStore::result(const std::string& name) const {
  if (!std::filesystem::exists(file(name))) return std::nullopt;
  return read_file(file(name));
}

void UnitStore::write(const std::string& name, std::string_view result) const { write_file(file(name), result); }

}  // namespace waretwin

#include "sim/ray_caster.h"

#include <embree3/rtcore.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <mutex>
#include <vector>

#include "core/error.h"
#include "sim/texture_sampler.h"

namespace waretwin {

namespace {

// What an alpha-masked geometry needs to decide whether a point of it is there.
struct AlphaMask {
  const Mesh* mesh = nullptr;
  const Material* material = nullptr;
  const Texture* texture = nullptr;  // may be null: base colour and vertex colours alone
};

bool is_hole(const AlphaMask& mask, unsigned primitive, float u, float v) {
  const Mesh& mesh = *mask.mesh;
  const std::uint32_t* corner = &mesh.triangles[std::size_t{3} * primitive];
  const float w = 1.0f - u - v;
  float alpha = mask.material->base_colour.w();
  if (!mesh.colours.empty()) {
    alpha *= w * mesh.colours[corner[0]].w() + u * mesh.colours[corner[1]].w() + v * mesh.colours[corner[2]].w();
  }
  if (mask.texture != nullptr) {
    const TextureUse& use = mask.material->base_colour_texture;
    const auto& uv = mesh.uv[use.uv_set];
    const Eigen::Vector2f at = w * uv[corner[0]] + u * uv[corner[1]] + v * uv[corner[2]];
    alpha *= sample_alpha(*mask.texture, use.uv_transform * at.homogeneous());
  }
  return alpha < mask.material->alpha_cutoff;
}

void drop_holes(const RTCFilterFunctionNArguments* args) {
  const auto& mask = *static_cast<const AlphaMask*>(args->geometryUserPtr);
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] != -1) continue;
    const unsigned primitive = RTCHitN_primID(args->hit, args->N, i);
    if (is_hole(mask, primitive, RTCHitN_u(args->hit, args->N, i), RTCHitN_v(args->hit, args->N, i))) args->valid[i] = 0;
  }
}

bool cpu_has(const std::string& isa) {
#if defined(__x86_64__)
  if (isa == "sse2") return true;
  if (isa == "sse4.2") return __builtin_cpu_supports("sse4.2") != 0;
  if (isa == "avx") return __builtin_cpu_supports("avx") != 0;
  if (isa == "avx2") return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
  if (isa == "avx512") {
    return __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512dq") != 0 && __builtin_cpu_supports("avx512bw") != 0 &&
           __builtin_cpu_supports("avx512vl") != 0;
  }
#endif
  return false;
}

const std::vector<std::string>& instruction_sets() {
  static const std::vector<std::string> names = {"sse2", "sse4.2", "avx", "avx2", "avx512"};
  return names;
}

struct DeviceRelease {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct SceneRelease {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using Device = std::unique_ptr<RTCDeviceTy, DeviceRelease>;
using DeviceScene = std::unique_ptr<RTCSceneTy, SceneRelease>;

Device open_device(const std::string& isa) {
  const auto& known = instruction_sets();
  if (std::find(known.begin(), known.end(), isa) == known.end()) {
    throw Error("isa '" + isa + "' is not an instruction set; expected sse2, sse4.2, avx, avx2 or avx512");
  }
  if (!cpu_has(isa)) throw Error("isa '" + isa + "': this CPU lacks these instructions; choose a smaller set");
  Device device(rtcNewDevice(("isa=" + isa).c_str()));
  if (!device)
    throw Error("isa '" + isa + "': the installed Embree cannot be opened with it (error " + std::to_string(rtcGetDeviceError(nullptr)) +
                ")");
  return device;
}

void require_no_error(RTCDevice device) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
  if (error != RTC_ERROR_NONE) throw InternalError("Embree reports error " + std::to_string(error));
}

// Which thread builds what decides the order of triangles in the leaves, and that decides which of two coincident surfaces is hit: one
// thread builds.
void commit_alone(RTCScene scene) {
  tbb::task_arena arena(1);
  arena.execute([scene] { rtcCommitScene(scene); });
}

void set_rtc_transform(RTCGeometry geometry, unsigned step, const Eigen::Affine3f& X_WM) {
  const Eigen::Matrix<float, 3, 4> columns = X_WM.affine();
  rtcSetGeometryTransform(geometry, step, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns.data());
}

RTCIntersectContext make_context(Coherence coherence) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = coherence == Coherence::kCoherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  return context;
}

// Fills lane i of a packet; lanes that hold no ray get an empty interval.
void set_lane(RTCRay8& packet, int i, const Ray& ray) {
  packet.org_x[i] = ray.origin.x();
  packet.org_y[i] = ray.origin.y();
  packet.org_z[i] = ray.origin.z();
  packet.tnear[i] = ray.near;
  packet.dir_x[i] = ray.direction.x();
  packet.dir_y[i] = ray.direction.y();
  packet.dir_z[i] = ray.direction.z();
  packet.tfar[i] = ray.far;
  packet.time[i] = ray.time;
  packet.mask[i] = 0xffffffffu;
  packet.id[i] = 0;
  packet.flags[i] = 0;
}

RTCRay single(const Ray& ray) {
  RTCRay r{};
  r.org_x = ray.origin.x();
  r.org_y = ray.origin.y();
  r.org_z = ray.origin.z();
  r.tnear = ray.near;
  r.dir_x = ray.direction.x();
  r.dir_y = ray.direction.y();
  r.dir_z = ray.direction.z();
  r.tfar = ray.far;
  r.time = ray.time;
  r.mask = 0xffffffffu;
  return r;
}

constexpr int kLanes = 8;

void cast_packets(RTCScene scene, std::span<const Ray> rays, std::span<Hit> hits, Coherence coherence) {
  WARETWIN_CHECK(rays.size() == hits.size(), "as many hits as rays");
  RTCIntersectContext context = make_context(coherence);
  alignas(32) int valid[kLanes];
  RTCRayHit8 packet;
  for (std::size_t begin = 0; begin < rays.size(); begin += kLanes) {
    const int count = static_cast<int>(std::min<std::size_t>(kLanes, rays.size() - begin));
    for (int i = 0; i < kLanes; ++i) {
      valid[i] = i < count ? -1 : 0;
      set_lane(packet.ray, i, rays[begin + static_cast<std::size_t>(i < count ? i : 0)]);
      packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
      packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect8(valid, scene, &context, &packet);
    for (int i = 0; i < count; ++i) {
      Hit& hit = hits[begin + static_cast<std::size_t>(i)];
      hit = {};
      if (packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
      hit = {packet.ray.tfar[i], static_cast<int>(packet.hit.instID[0][i]), static_cast<int>(packet.hit.primID[i]), packet.hit.u[i],
             packet.hit.v[i]};
    }
  }
}

}  // namespace

void RayCasterOptions::visit(Fields& f) {
  f("isa", isa, "CPU instructions of the ray caster; results differ in the last bits between them", {.choices = instruction_sets()});
}

struct RayCaster::State {
  std::shared_ptr<const Scene> scene;
  Device device;
  std::vector<AlphaMask> masks;          // as many as meshes
  std::vector<DeviceScene> mesh_scenes;  // as many as meshes; null for meshes without triangles
  DeviceScene top;
  std::vector<RTCGeometry> instances;  // owned by `top`; null for instances of empty meshes
  std::vector<Placement> placements;   // as many as instances
  std::vector<bool> present;           // as many as instances
  struct Motion {
    Eigen::Affine3f begin, end;
  };
  std::vector<Motion> motions;  // as many as instances
  bool changed = true;          // since the last commit
  Stamp shutter_begin = 0, shutter_end = 0;
  // Trees of single objects, made when asked for; their geometries are those of `top`, under the same numbers.
  std::mutex object_mutex;
  std::map<int, DeviceScene> object_scenes;

  void add_mesh(std::size_t index);
  void add_instance(std::size_t index);
  RTCScene object_scene(int object);
};

void RayCaster::State::add_mesh(std::size_t index) {
  const Mesh& mesh = scene->meshes[index];
  mesh_scenes.emplace_back();
  if (mesh.triangles.empty()) return;
  for (const std::uint32_t corner : mesh.triangles) {
    WARETWIN_CHECK(corner < mesh.positions.size(), "a triangle's corner is a vertex of its mesh");
  }
  RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.positions.size()));
  auto* indices = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), mesh.triangles.size() / 3));
  if (vertices == nullptr || indices == nullptr) {
    rtcReleaseGeometry(geometry);
    throw std::bad_alloc();
  }
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) vertices[3 * i + static_cast<std::size_t>(axis)] = mesh.positions[i][axis];
  }
  std::copy(mesh.triangles.begin(), mesh.triangles.end(), indices);
  const Material& material = scene->materials[static_cast<std::size_t>(mesh.material)];
  if (material.alpha_mask) {
    AlphaMask& mask = masks[index];
    mask.mesh = &mesh;
    mask.material = &material;
    const TextureUse& use = material.base_colour_texture;
    if (use.texture >= 0 && !mesh.uv[use.uv_set].empty()) mask.texture = &scene->textures[static_cast<std::size_t>(use.texture)];
    rtcSetGeometryUserData(geometry, &mask);
    rtcSetGeometryIntersectFilterFunction(geometry, drop_holes);
    rtcSetGeometryOccludedFilterFunction(geometry, drop_holes);
  }
  rtcCommitGeometry(geometry);
  DeviceScene mesh_scene(rtcNewScene(device.get()));
  rtcSetSceneFlags(mesh_scene.get(), RTC_SCENE_FLAG_ROBUST);
  rtcAttachGeometryByID(mesh_scene.get(), geometry, 0);
  rtcReleaseGeometry(geometry);
  commit_alone(mesh_scene.get());
  mesh_scenes.back() = std::move(mesh_scene);
}

void RayCaster::State::add_instance(std::size_t index) {
  const Instance& instance = scene->instances[index];
  RTCScene mesh_scene = mesh_scenes[static_cast<std::size_t>(instance.mesh)].get();
  placements.emplace_back(instance.X_WM);
  present.push_back(true);
  motions.push_back({instance.X_WM, instance.X_WM});
  instances.push_back(nullptr);
  if (mesh_scene == nullptr) return;
  RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(geometry, mesh_scene);
  rtcSetGeometryTimeStepCount(geometry, 1);
  set_rtc_transform(geometry, 0, instance.X_WM);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(top.get(), geometry, static_cast<unsigned>(index));
  rtcReleaseGeometry(geometry);
  instances.back() = geometry;
}

RTCScene RayCaster::State::object_scene(int object) {
  WARETWIN_CHECK(object >= 0 && static_cast<std::size_t>(object) < scene->objects.size(), "an object of the scene");
  const std::lock_guard lock(object_mutex);
  DeviceScene& made = object_scenes[object];
  if (made) return made.get();
  DeviceScene alone(rtcNewScene(device.get()));
  rtcSetSceneFlags(alone.get(), RTC_SCENE_FLAG_ROBUST);
  for (std::size_t i = 0; i < instances.size(); ++i) {
    if (scene->instances[i].object != object || instances[i] == nullptr) continue;
    rtcAttachGeometryByID(alone.get(), instances[i], static_cast<unsigned>(i));
  }
  commit_alone(alone.get());
  require_no_error(device.get());
  made = std::move(alone);
  return made.get();
}

Placement::Placement(const Eigen::Affine3f& X) : X_WM(X), mean_scale(std::cbrt(std::abs(X.linear().determinant()))) {
  const Eigen::Matrix3f linear = X.linear();
  cofactors.col(0) = linear.col(1).cross(linear.col(2));
  cofactors.col(1) = linear.col(2).cross(linear.col(0));
  cofactors.col(2) = linear.col(0).cross(linear.col(1));
}

RayCaster::RayCaster(std::shared_ptr<const Scene> scene, const RayCasterOptions& options) : state_(std::make_unique<State>()) {
  WARETWIN_CHECK(scene != nullptr, "a ray caster has a scene");
  if (scene->triangle_count() == 0) throw Error("scene '" + scene->name + "' has no triangles; expected at least one");
  State& s = *state_;
  s.scene = std::move(scene);
  s.device = open_device(options.isa);
  s.masks.resize(s.scene->meshes.size());
  for (std::size_t i = 0; i < s.scene->meshes.size(); ++i) s.add_mesh(i);
  s.top.reset(rtcNewScene(s.device.get()));
  rtcSetSceneFlags(s.top.get(), RTC_SCENE_FLAG_ROBUST);
  for (std::size_t i = 0; i < s.scene->instances.size(); ++i) s.add_instance(i);
  for (const int instance : s.scene->vehicle) set_present(instance, false);
  commit();
}

RayCaster::~RayCaster() = default;

const Scene& RayCaster::scene() const { return *state_->scene; }
std::shared_ptr<const Scene> RayCaster::shared_scene() const { return state_->scene; }

Hit RayCaster::cast(const Ray& ray) const {
  RTCIntersectContext context = make_context(Coherence::kIncoherent);
  RTCRayHit query{};
  query.ray = single(ray);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(state_->top.get(), &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  return {query.ray.tfar, static_cast<int>(query.hit.instID[0]), static_cast<int>(query.hit.primID), query.hit.u, query.hit.v};
}

void RayCaster::cast(std::span<const Ray> rays, std::span<Hit> hits, Coherence coherence) const {
  cast_packets(state_->top.get(), rays, hits, coherence);
}

void RayCaster::cast_object(int object, std::span<const Ray> rays, std::span<Hit> hits, Coherence coherence) const {
  cast_packets(state_->object_scene(object), rays, hits, coherence);
}

bool RayCaster::occluded(const Ray& ray) const {
  if (!(ray.far >= ray.near)) return false;
  RTCIntersectContext context = make_context(Coherence::kIncoherent);
  RTCRay query = single(ray);
  rtcOccluded1(state_->top.get(), &context, &query);
  return query.tfar < 0.0f;
}

void RayCaster::occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked, Coherence coherence) const {
  WARETWIN_CHECK(rays.size() == blocked.size(), "as many answers as rays");
  RTCIntersectContext context = make_context(coherence);
  alignas(32) int valid[kLanes];
  RTCRay8 packet;
  for (std::size_t begin = 0; begin < rays.size(); begin += kLanes) {
    const int count = static_cast<int>(std::min<std::size_t>(kLanes, rays.size() - begin));
    for (int i = 0; i < kLanes; ++i) {
      const Ray& ray = rays[begin + static_cast<std::size_t>(i < count ? i : 0)];
      valid[i] = i < count && ray.far >= ray.near ? -1 : 0;
      set_lane(packet, i, ray);
    }
    rtcOccluded8(valid, state_->top.get(), &context, &packet);
    for (int i = 0; i < count; ++i) {
      blocked[begin + static_cast<std::size_t>(i)] = valid[i] != 0 && packet.tfar[i] < 0.0f ? 1 : 0;
    }
  }
}

void RayCaster::set_transform(int instance, const Eigen::Affine3f& X_WM) { set_motion(instance, X_WM, X_WM); }

void RayCaster::set_motion(int instance, const Eigen::Affine3f& X_WM_begin, const Eigen::Affine3f& X_WM_end) {
  const auto index = static_cast<std::size_t>(instance);
  WARETWIN_CHECK(index < state_->placements.size(), "an instance of the scene");
  State::Motion& motion = state_->motions[index];
  if (motion.begin.matrix() == X_WM_begin.matrix() && motion.end.matrix() == X_WM_end.matrix()) return;
  motion = {X_WM_begin, X_WM_end};
  const bool moves = X_WM_begin.matrix() != X_WM_end.matrix();
  Eigen::Affine3f middle = X_WM_begin;
  if (moves) middle.matrix() = 0.5f * (X_WM_begin.matrix() + X_WM_end.matrix());
  state_->placements[index] = Placement(middle);
  RTCGeometry geometry = state_->instances[index];
  if (geometry == nullptr) return;
  state_->changed = true;
  rtcSetGeometryTimeStepCount(geometry, moves ? 2 : 1);
  set_rtc_transform(geometry, 0, X_WM_begin);
  if (moves) set_rtc_transform(geometry, 1, X_WM_end);
  rtcCommitGeometry(geometry);
}

void RayCaster::set_present(int instance, bool present) {
  const auto index = static_cast<std::size_t>(instance);
  WARETWIN_CHECK(index < state_->present.size(), "an instance of the scene");
  if (state_->present[index] == present) return;
  state_->present[index] = present;
  RTCGeometry geometry = state_->instances[index];
  if (geometry == nullptr) return;
  state_->changed = true;
  if (present) {
    rtcEnableGeometry(geometry);
  } else {
    rtcDisableGeometry(geometry);
  }
  rtcCommitGeometry(geometry);
}

void RayCaster::set_shutter(Stamp begin, Stamp end) {
  WARETWIN_CHECK(begin <= end, "a shutter ends after it begins");
  state_->shutter_begin = begin;
  state_->shutter_end = end;
}

float RayCaster::time_of(Stamp moment) const {
  const Stamp begin = state_->shutter_begin, end = state_->shutter_end;
  if (begin == end) return 0.5f;
  const Stamp inside = std::clamp(moment, begin, end);
  return static_cast<float>(static_cast<double>(inside - begin) / static_cast<double>(end - begin));
}

void RayCaster::commit() {
  if (!state_->changed) return;
  state_->changed = false;
  commit_alone(state_->top.get());
  for (const auto& [object, alone] : state_->object_scenes) commit_alone(alone.get());
  require_no_error(state_->device.get());
}

const Placement& RayCaster::placement(int instance) const { return state_->placements[static_cast<std::size_t>(instance)]; }

Eigen::AlignedBox3f RayCaster::bounds(int instance) const {
  const auto index = static_cast<std::size_t>(instance);
  WARETWIN_CHECK(index < state_->present.size(), "an instance of the scene");
  Eigen::AlignedBox3f box;
  const RTCScene mesh_scene = state_->mesh_scenes[static_cast<std::size_t>(state_->scene->instances[index].mesh)].get();
  if (!state_->present[index] || mesh_scene == nullptr) return box;
  RTCBounds b;
  rtcGetSceneBounds(mesh_scene, &b);
  const Eigen::AlignedBox3f box_M(Eigen::Vector3f(b.lower_x, b.lower_y, b.lower_z), Eigen::Vector3f(b.upper_x, b.upper_y, b.upper_z));
  for (const Eigen::Affine3f& X_WM : {state_->motions[index].begin, state_->motions[index].end}) {
    for (int corner = 0; corner < 8; ++corner) box.extend(X_WM * box_M.corner(static_cast<Eigen::AlignedBox3f::CornerType>(corner)));
  }
  return box;
}

Eigen::AlignedBox3f RayCaster::bounds() const {
  RTCBounds b;
  rtcGetSceneBounds(state_->top.get(), &b);
  return {Eigen::Vector3f(b.lower_x, b.lower_y, b.lower_z), Eigen::Vector3f(b.upper_x, b.upper_y, b.upper_z)};
}

}  // namespace waretwin

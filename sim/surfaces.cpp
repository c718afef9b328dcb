#include "sim/surfaces.h"

#include <algorithm>
#include <cmath>

namespace waretwin {

namespace {

Eigen::Vector3f unit(const Eigen::Vector3f& v, const Eigen::Vector3f& otherwise) {
  const float squared = v.squaredNorm();
  return squared > 1e-30f ? Eigen::Vector3f(v * (1.0f / std::sqrt(squared))) : otherwise;
}

// uv lengths per metre on each triangle: the square root of the ratio of areas.
std::vector<float> density(const Mesh& mesh) {
  std::vector<float> out;
  if (mesh.uv[0].empty()) return out;
  out.reserve(mesh.triangles.size() / 3);
  for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) {
    const std::uint32_t a = mesh.triangles[t], b = mesh.triangles[t + 1], c = mesh.triangles[t + 2];
    const Eigen::Vector3f e1 = mesh.positions[b] - mesh.positions[a], e2 = mesh.positions[c] - mesh.positions[a];
    const Eigen::Vector2f d1 = mesh.uv[0][b] - mesh.uv[0][a], d2 = mesh.uv[0][c] - mesh.uv[0][a];
    const float area = e1.cross(e2).norm();
    const float uv_area = std::abs(d1.x() * d2.y() - d1.y() * d2.x());
    out.push_back(area > 1e-20f ? std::sqrt(uv_area / area) : 0.0f);
  }
  return out;
}

}  // namespace

Surfaces::Surfaces(std::shared_ptr<const RayCaster> ray_caster) : ray_caster_(std::move(ray_caster)) {
  const Scene& scene = ray_caster_->scene();
  colour_samplers_.resize(scene.textures.size());
  data_samplers_.resize(scene.textures.size());
  for (const Material& material : scene.materials) {
    MaterialUse use;
    use.base_colour = make_use(material.base_colour_texture, TextureSampler::Encoding::kSrgb);
    use.metallic_roughness = make_use(material.metallic_roughness_texture, TextureSampler::Encoding::kLinear);
    use.normal = make_use(material.normal_texture, TextureSampler::Encoding::kLinear);
    use.emissive = make_use(material.emissive_texture, TextureSampler::Encoding::kSrgb);
    use.textured = use.base_colour.sampler || use.metallic_roughness.sampler || use.normal.sampler || use.emissive.sampler;
    use.only_colour_varies = !use.metallic_roughness.sampler && !use.normal.sampler && !use.emissive.sampler;
    materials_.push_back(use);
  }
  for (const Mesh& mesh : scene.meshes) uv_density_.push_back(density(mesh));
}

Surfaces::Use Surfaces::make_use(const TextureUse& use, TextureSampler::Encoding encoding) {
  Use out;
  out.uv_set = use.uv_set;
  out.transform = use.uv_transform;
  out.scale = std::sqrt(std::abs(use.uv_transform.leftCols<2>().determinant()));
  if (use.texture < 0) return out;
  const auto index = static_cast<std::size_t>(use.texture);
  auto& made = encoding == TextureSampler::Encoding::kSrgb ? colour_samplers_[index] : data_samplers_[index];
  if (!made) made = std::make_unique<TextureSampler>(ray_caster_->scene().textures[index], encoding);
  out.sampler = made.get();
  return out;
}

Surfaces::Corners Surfaces::corners(const Mesh& mesh, const Hit& hit) const {
  const std::uint32_t* i = &mesh.triangles[std::size_t{3} * static_cast<std::size_t>(hit.primitive)];
  return {{i[0], i[1], i[2]}, {1.0f - hit.u - hit.v, hit.u, hit.v}};
}

const Mesh& Surfaces::mesh(const Hit& hit) const {
  const Scene& scene = ray_caster_->scene();
  return scene.meshes[static_cast<std::size_t>(scene.instances[static_cast<std::size_t>(hit.instance)].mesh)];
}

const Material& Surfaces::material(const Hit& hit) const {
  return ray_caster_->scene().materials[static_cast<std::size_t>(mesh(hit).material)];
}

Eigen::Vector2f Surfaces::uv(const Hit& hit, int set) const {
  const Mesh& mesh = this->mesh(hit);
  const auto& uv = mesh.uv[set];
  if (uv.empty()) return Eigen::Vector2f::Zero();
  const Corners c = corners(mesh, hit);
  return c.w[0] * uv[c.i[0]] + c.w[1] * uv[c.i[1]] + c.w[2] * uv[c.i[2]];
}

Eigen::Vector3f Surfaces::face_normal(const Ray& ray, const Hit& hit) const {
  const Mesh& mesh = this->mesh(hit);
  const Eigen::Matrix3f linear = ray_caster_->transform(hit.instance).linear();
  const Corners c = corners(mesh, hit);
  const Eigen::Vector3f& a = mesh.positions[c.i[0]];
  const Eigen::Vector3f n = (linear * (mesh.positions[c.i[1]] - a)).cross(linear * (mesh.positions[c.i[2]] - a));
  const Eigen::Vector3f out = unit(n, -ray.direction.normalized());
  return out.dot(ray.direction) > 0.0f ? Eigen::Vector3f(-out) : out;
}

Eigen::Vector4f Surfaces::sample(const Use& use, const Mesh& mesh, const Corners& c, float footprint_M, float uv_density) {
  const auto& uv = mesh.uv[use.uv_set];
  if (uv.empty()) return use.sampler->sample(use.transform.col(2), 0.0f);
  const Eigen::Vector2f at = c.w[0] * uv[c.i[0]] + c.w[1] * uv[c.i[1]] + c.w[2] * uv[c.i[2]];
  return use.sampler->sample(use.transform.leftCols<2>() * at + use.transform.col(2), footprint_M * uv_density * use.scale);
}

Surfaces::Place Surfaces::place(const Hit& hit) const {
  const Scene& scene = ray_caster_->scene();
  const Instance& instance = scene.instances[static_cast<std::size_t>(hit.instance)];
  const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
  const auto material = static_cast<std::size_t>(mesh.material);
  return {instance, mesh, scene.materials[material], materials_[material], ray_caster_->placement(hit.instance), corners(mesh, hit)};
}

Surfaces::Footprint Surfaces::footprint(const Place& at, const Ray& ray, const Hit& hit, const Eigen::Vector3f& face_normal,
                                        float spread) const {
  if (!at.use.textured) return {};
  // A compromise between the long and the short side of the pixel's footprint on a slanted surface.
  const float length = ray.direction.norm();
  const float slant = std::max(-face_normal.dot(ray.direction) / length, 0.05f);
  const auto& densities = uv_density_[static_cast<std::size_t>(at.instance.mesh)];
  return {hit.distance * length * spread / std::sqrt(slant) / std::max(at.placement.mean_scale, 1e-12f),
          densities.empty() ? 0.0f : densities[static_cast<std::size_t>(hit.primitive)]};
}

Eigen::Vector3f Surfaces::base_colour(const Place& at, const Footprint& footprint) {
  const Corners& c = at.corners;
  // Four at once: three floats that are written one by one and read two by two wait for the memory.
  Eigen::Vector4f colour = at.material.base_colour;
  if (!at.mesh.colours.empty()) {
    const auto& colours = at.mesh.colours;
    colour = colour.cwiseProduct(c.w[0] * colours[c.i[0]] + c.w[1] * colours[c.i[1]] + c.w[2] * colours[c.i[2]]);
  }
  if (at.use.base_colour.sampler) {
    colour = colour.cwiseProduct(sample(at.use.base_colour, at.mesh, c, footprint.size_M, footprint.per_metre));
  }
  return colour.cwiseMax(0.0f).cwiseMin(1.0f).head<3>();
}

SurfacePoint Surfaces::at(const Ray& ray, const Hit& hit, float spread) const {
  const Place place = this->place(hit);
  const Mesh& mesh = place.mesh;
  const MaterialUse& use = place.use;
  const Eigen::Affine3f& X_WM = place.placement.X_WM;
  const auto linear = X_WM.linear();
  const Corners& c = place.corners;

  SurfacePoint point;
  point.position = ray.at(hit.distance);
  const Eigen::Vector3f& a = mesh.positions[c.i[0]];
  const Eigen::Vector3f e1 = linear * (mesh.positions[c.i[1]] - a), e2 = linear * (mesh.positions[c.i[2]] - a);
  const Eigen::Vector3f towards = -ray.direction;
  point.face_normal = unit(e1.cross(e2), towards);
  if (point.face_normal.dot(towards) < 0.0f) point.face_normal = -point.face_normal;
  point.normal = point.face_normal;
  if (!mesh.normals.empty()) {
    const Eigen::Vector3f n_M = c.w[0] * mesh.normals[c.i[0]] + c.w[1] * mesh.normals[c.i[1]] + c.w[2] * mesh.normals[c.i[2]];
    point.normal = unit(place.placement.cofactors * n_M, point.face_normal);
    if (point.normal.dot(point.face_normal) < 0.0f) point.normal = -point.normal;
  }

  const Footprint size = footprint(place, ray, hit, point.face_normal, spread);
  point.base_colour = base_colour(place, size);
  point.metallic = place.material.metallic;
  point.roughness = place.material.roughness;
  point.emissive = place.material.emissive;
  if (use.metallic_roughness.sampler) {
    const Eigen::Vector4f value = sample(use.metallic_roughness, mesh, c, size.size_M, size.per_metre);
    point.roughness *= value.y();
    point.metallic *= value.z();
  }
  if (use.emissive.sampler) {
    point.emissive = point.emissive.cwiseProduct(sample(use.emissive, mesh, c, size.size_M, size.per_metre).head<3>());
  }
  if (use.normal.sampler) bend(point, use.normal, place.material.normal_scale, mesh, c, X_WM, size.size_M, size.per_metre);
  return point;
}

bool Surfaces::only_colour_varies(const Hit& hit) const {
  return materials_[static_cast<std::size_t>(mesh(hit).material)].only_colour_varies;
}

FaceColours Surfaces::face_colours(const Ray& ray, const Hit& hit, const SurfacePoint& point, float spread) const {
  const Place at = place(hit);
  const std::uint32_t* const i = at.corners.i;
  FaceColours out;
  out.first_ = at.material.base_colour;
  if (const auto& colours = at.mesh.colours; !colours.empty()) {
    out.constant_ = false;
    out.to_second_ = out.first_.cwiseProduct(colours[i[1]] - colours[i[0]]);
    out.to_third_ = out.first_.cwiseProduct(colours[i[2]] - colours[i[0]]);
    out.first_ = out.first_.cwiseProduct(colours[i[0]]);
  }
  const Use& use = at.use.base_colour;
  if (use.sampler == nullptr) return out;
  out.constant_ = false;
  out.sampler_ = use.sampler;
  const Footprint size = footprint(at, ray, hit, point.face_normal, spread);
  out.level_ = use.sampler->level(size.size_M * size.per_metre * use.scale);
  out.uv_first_ = use.transform.col(2);
  out.uv_to_second_.setZero();
  out.uv_to_third_.setZero();
  if (const auto& uv = at.mesh.uv[use.uv_set]; !uv.empty()) {
    const auto linear = use.transform.leftCols<2>();
    out.uv_first_ += linear * uv[i[0]];
    out.uv_to_second_ = linear * (uv[i[1]] - uv[i[0]]);
    out.uv_to_third_ = linear * (uv[i[2]] - uv[i[0]]);
  }
  return out;
}

void Surfaces::bend(SurfacePoint& point, const Use& use, float normal_scale, const Mesh& mesh, const Corners& c,
                    const Eigen::Affine3f& X_WM, float footprint_M, float uv_density) const {
  const auto& uv = mesh.uv[use.uv_set];
  if (uv.empty()) return;
  const Eigen::Matrix3f linear = X_WM.linear();
  Eigen::Vector3f tangent;
  float handedness = 1.0f;
  if (!mesh.tangents.empty()) {
    const Eigen::Vector4f t = c.w[0] * mesh.tangents[c.i[0]] + c.w[1] * mesh.tangents[c.i[1]] + c.w[2] * mesh.tangents[c.i[2]];
    tangent = linear * t.head<3>();
    handedness = t.w() < 0.0f ? -1.0f : 1.0f;
  } else {
    const Eigen::Vector3f e1 = linear * (mesh.positions[c.i[1]] - mesh.positions[c.i[0]]);
    const Eigen::Vector3f e2 = linear * (mesh.positions[c.i[2]] - mesh.positions[c.i[0]]);
    const Eigen::Vector2f d1 = uv[c.i[1]] - uv[c.i[0]], d2 = uv[c.i[2]] - uv[c.i[0]];
    const float determinant = d1.x() * d2.y() - d2.x() * d1.y();
    if (std::abs(determinant) < 1e-20f) return;
    tangent = (e1 * d2.y() - e2 * d1.y()) / determinant;
    // glTF's bitangent runs against v.
    const Eigen::Vector3f up = (e1 * d2.x() - e2 * d1.x()) / determinant;
    handedness = point.normal.cross(tangent).dot(up) < 0.0f ? -1.0f : 1.0f;
  }
  tangent -= point.normal * point.normal.dot(tangent);
  if (tangent.squaredNorm() < 1e-20f) return;
  tangent.normalize();
  const Eigen::Vector3f bitangent = handedness * point.normal.cross(tangent);
  const Eigen::Vector4f stored = sample(use, mesh, c, footprint_M, uv_density);
  const float x = (2.0f * stored.x() - 1.0f) * normal_scale, y = (2.0f * stored.y() - 1.0f) * normal_scale, z = 2.0f * stored.z() - 1.0f;
  const Eigen::Vector3f bent = unit(x * tangent + y * bitangent + std::max(z, 0.0f) * point.normal, point.normal);
  if (bent.dot(point.face_normal) > 0.0f) point.normal = bent;
}

}  // namespace waretwin

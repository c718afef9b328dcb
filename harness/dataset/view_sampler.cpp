#include "harness/dataset/view_sampler.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/error.h"
#include "harness/dataset/hall_heights.h"

namespace waretwin {

namespace {

constexpr int kTries = 200;
constexpr int kGridWidth = 80;        // rays across a picture that is tried
constexpr float kArmsLength = 0.2f;   // metres
constexpr double kInset_m = 0.3;      // from the hall's bounds
constexpr double kMostInside = 0.25;  // of the rays that meet a surface from behind

// Evenly spread (Fibonacci sphere).
std::vector<Eigen::Vector3f> directions(int count) {
  std::vector<Eigen::Vector3f> out;
  const double golden = std::numbers::pi * (3.0 - std::sqrt(5.0));
  for (int i = 0; i < count; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / count, r = std::sqrt(1.0 - z * z);
    out.push_back(Eigen::Vector3d(r * std::cos(golden * i), r * std::sin(golden * i), z).cast<float>());
  }
  return out;
}

// The triangle's front is on the other side of where the ray came from.
bool from_behind(const RayCaster& hall, const Hit& hit, const Eigen::Vector3f& direction) {
  const Scene& scene = hall.scene();
  const Mesh& mesh = scene.meshes[static_cast<std::size_t>(scene.instances[static_cast<std::size_t>(hit.instance)].mesh)];
  const std::uint32_t* const corner = &mesh.triangles[std::size_t{3} * static_cast<std::size_t>(hit.primitive)];
  const Eigen::Affine3f& X_WM = hall.transform(hit.instance);
  const Eigen::Vector3f a = X_WM * mesh.positions[corner[0]], b = X_WM * mesh.positions[corner[1]], c = X_WM * mesh.positions[corner[2]];
  const float mirrored = X_WM.linear().determinant() < 0.0f ? -1.0f : 1.0f;
  return mirrored * (b - a).cross(c - a).dot(direction) > 0.0f;
}

// Forward axis to the target; then turned in its own frame.
Pose looking(const Eigen::Vector3d& eye, double yaw, double pitch, double roll) {
  Pose X = Pose::Identity();
  X.translation() = eye;
  X.linear() = rotation_from_rpy(roll, pitch, yaw) * optical_from_forward();
  return X;
}

}  // namespace

std::string to_text(ViewKind kind) {
  switch (kind) {
    case ViewKind::kRoute:
      return "route";
    case ViewKind::kObject:
      return "object";
    case ViewKind::kEmpty:
      return "empty";
  }
  return {};
}

ViewSampler::ViewSampler(const RayCaster& hall, const Scenario& scenario, const Intrinsics& intrinsics, const Pose& X_BC,
                         const ViewConfig& config, const std::vector<std::string>& classes)
    : hall_(hall),
      intrinsics_(intrinsics),
      X_BC_(X_BC),
      config_(config),
      route_(scenario.robot),
      bounds_(hall.bounds().cast<double>()),
      floor_(floor_of(bounds_.min().z())) {
  const std::vector<TrueObject>& all = hall.scene().objects;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (std::find(classes.begin(), classes.end(), all[i].class_name) != classes.end()) objects_.push_back(static_cast<int>(i));
  }
}

ViewKind ViewSampler::draw_kind(Dice& dice) const {
  const double u = dice.unit();
  if (u < config_.route_share) return ViewKind::kRoute;
  return u < config_.route_share + config_.empty_share ? ViewKind::kEmpty : ViewKind::kObject;
}

std::optional<View> ViewSampler::draw(ViewKind kind, Dice& dice) const {
  switch (kind) {
    case ViewKind::kRoute:
      return route_view(dice);
    case ViewKind::kObject:
      return object_view(dice);
    case ViewKind::kEmpty:
      return empty_view(dice);
  }
  return {};
}

View ViewSampler::route_view(Dice& dice) const {
  const auto moment = static_cast<Stamp>(dice.unit() * static_cast<double>(route_.duration()));
  return {ViewKind::kRoute, [this, moment](Stamp from_it) { return route_.X_WB(moment + from_it) * X_BC_; }};
}

View ViewSampler::drifting(ViewKind kind, const Pose& X_WC, Dice& dice) const {
  const auto along = [&](double most) -> Eigen::Vector3d {
    return Eigen::Vector3d(dice.between(-most, most), dice.between(-most, most), dice.between(-most, most)) / std::sqrt(3.0);
  };
  const Eigen::Vector3d velocity = along(config_.speed_mps), turn = along(to_radians(config_.turn_rate_deg_s));
  return {kind, [X_WC, velocity, turn](Stamp from_it) {
            const double t = to_seconds(from_it);
            Pose X = X_WC;
            X.translation() += velocity * t;
            const double angle = turn.norm() * t;
            if (angle != 0.0) X.linear() = X.linear() * Eigen::AngleAxisd(angle, turn.normalized()).toRotationMatrix();
            return X;
          }};
}

std::optional<View> ViewSampler::object_view(Dice& dice) const {
  if (objects_.empty()) return {};
  const double half_field = std::atan(0.5 * intrinsics_.width / intrinsics_.fx);
  for (int i = 0; i < kTries; ++i) {
    const int index = objects_[static_cast<std::size_t>(dice.whole(0, static_cast<int>(objects_.size()) - 1))];
    const Cuboid& box = hall_.scene().objects[static_cast<std::size_t>(index)].cuboid;
    const double distance = dice.between(config_.distance_min_m, config_.distance_max_m),
                 bearing = dice.between(0.0, 2.0 * std::numbers::pi);
    const Eigen::Vector3d eye(box.centre.x() + distance * std::cos(bearing), box.centre.y() + distance * std::sin(bearing),
                              floor_ + dice.between(config_.height_min_m, config_.height_max_m));
    const Eigen::Vector3d way = box.centre - eye;
    // Not always in the middle: objects cut by the border are in the set, too.
    const double yaw = std::atan2(way.y(), way.x()) + dice.between(-0.8, 0.8) * half_field;
    const double pitch = -std::atan2(way.z(), way.head<2>().norm()) + dice.between(-0.4, 0.4) * half_field;
    const Pose X_WC = looking(eye, yaw, pitch, to_radians(dice.between(-config_.roll_deg, config_.roll_deg)));
    if (!is_free(eye) || share_of({&index, 1}, X_WC) < config_.least_share) continue;
    return drifting(ViewKind::kObject, X_WC, dice);
  }
  return {};
}

std::optional<View> ViewSampler::empty_view(Dice& dice) const {
  for (int i = 0; i < kTries; ++i) {
    const Eigen::Vector3d eye(dice.between(bounds_.min().x(), bounds_.max().x()), dice.between(bounds_.min().y(), bounds_.max().y()),
                              floor_ + dice.between(config_.height_min_m, config_.height_max_m));
    const Pose X_WC = looking(eye, dice.between(0.0, 2.0 * std::numbers::pi), to_radians(dice.between(-10.0, 50.0)),
                              to_radians(dice.between(-config_.roll_deg, config_.roll_deg)));
    if (!is_free(eye) || share_of(objects_, X_WC) > 0.0) continue;
    return drifting(ViewKind::kEmpty, X_WC, dice);
  }
  return {};
}

bool ViewSampler::is_free(const Eigen::Vector3d& p_W) const {
  Eigen::AlignedBox3d inside = bounds_;
  inside.min().head<2>().array() += kInset_m;
  inside.max().head<2>().array() -= kInset_m;
  if (!inside.contains(p_W)) return false;
  static const std::vector<Eigen::Vector3f> kDirections = directions(32);
  std::vector<Ray> rays(kDirections.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    rays[i].origin = p_W.cast<float>();
    rays[i].direction = kDirections[i];
  }
  std::vector<Hit> hits(rays.size());
  hall_.cast(rays, hits);
  int met = 0, behind = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!hits[i].valid()) continue;
    if (hits[i].distance < kArmsLength) return false;
    ++met;
    behind += from_behind(hall_, hits[i], rays[i].direction);
  }
  return behind <= kMostInside * met;
}

double ViewSampler::share_of(std::span<const int> objects, const Pose& X_WC) const {
  const int step = std::max(1, intrinsics_.width / kGridWidth);
  std::vector<Ray> rays;
  for (int v = step / 2; v < intrinsics_.height; v += step) {
    for (int u = step / 2; u < intrinsics_.width; u += step) {
      Ray& ray = rays.emplace_back();
      ray.origin = X_WC.translation().cast<float>();
      ray.direction = (X_WC.linear() * intrinsics_.ray(u, v)).cast<float>();
    }
  }
  std::vector<Hit> hits(rays.size());
  hall_.cast(rays, hits, Coherence::kCoherent);
  std::size_t showing = 0;
  for (const Hit& hit : hits) {
    if (!hit.valid()) continue;
    const int seen = hall_.scene().instances[static_cast<std::size_t>(hit.instance)].object;
    showing += seen >= 0 && std::find(objects.begin(), objects.end(), seen) != objects.end();
  }
  return static_cast<double>(showing) / static_cast<double>(rays.size());
}

}  // namespace waretwin

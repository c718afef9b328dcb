#include "sim/motion/belt_surface.h"

#include <fnmatch.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/error.h"
#include "core/pose.h"

namespace waretwin {

namespace {

constexpr double kSideStep = 0.004;  // between rays across the belt, metres
constexpr int kStations = 60;        // rows of rays along it
constexpr double kLevel = 0.004;     // what rises more than this above the surface stands beside it
constexpr double kDrop = 0.02;       // what lies lower than this does not carry
constexpr double kHighest = 0.6;     // above the surface; what is higher is a roof

// Vertices of an object in the world.
std::vector<Eigen::Vector3d> vertices_of(const RayCaster& caster, int object) {
  const Scene& scene = caster.scene();
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    if (scene.instances[i].object != object) continue;
    const Eigen::Affine3f& X_WM = caster.transform(static_cast<int>(i));
    for (const Eigen::Vector3f& p : scene.meshes[static_cast<std::size_t>(scene.instances[i].mesh)].positions) {
      points.push_back((X_WM * p).cast<double>());
    }
  }
  return points;
}

// Height of the object's uppermost surface at (x, y); nothing where there is none.
std::optional<double> height_at(const RayCaster& caster, int object, const Eigen::Vector2d& at, double above) {
  const Scene& scene = caster.scene();
  Ray ray;
  ray.origin = {static_cast<float>(at.x()), static_cast<float>(at.y()), static_cast<float>(above)};
  ray.direction = -Eigen::Vector3f::UnitZ();
  // What lies on it is passed through.
  for (int passed = 0; passed < 64; ++passed) {
    const Hit hit = caster.cast(ray);
    if (!hit.valid()) return std::nullopt;
    if (scene.instances[static_cast<std::size_t>(hit.instance)].object == object) return above - static_cast<double>(hit.distance);
    ray.near = hit.distance + 1e-4f;
  }
  return std::nullopt;
}

// A belt runs along a side of its object: the heading only has to say which way, not to the last degree.
double along_a_side(double heading, double cuboid_yaw) {
  const double quarter = to_radians(90.0);
  return cuboid_yaw + quarter * std::round((heading - cuboid_yaw) / quarter);
}

// The centre line: straight through the middle of the box around the object, or the arc in the middle of its ring sector.
void lay_centre_line(BeltSurface& belt, const BeltConfig& config, const Cuboid& cuboid, const std::vector<Eigen::Vector3d>& points,
                     double& half_width) {
  belt.curve = config.curve;
  double low = std::numeric_limits<double>::infinity(), high = -low, along_low = low, along_high = high;
  if (!config.curve) {
    const double yaw = along_a_side(to_radians(config.heading_deg), cuboid.yaw);
    const Eigen::Vector2d heading(std::cos(yaw), std::sin(yaw));
    belt.direction = heading;
    const Eigen::Vector2d across(-heading.y(), heading.x());
    for (const Eigen::Vector3d& p : points) {
      along_low = std::min(along_low, heading.dot(p.head<2>()));
      along_high = std::max(along_high, heading.dot(p.head<2>()));
      low = std::min(low, across.dot(p.head<2>()));
      high = std::max(high, across.dot(p.head<2>()));
    }
    belt.length = along_high - along_low;
    belt.begin = along_low * heading + 0.5 * (low + high) * across;
    half_width = 0.5 * (high - low);
    return;
  }
  belt.pivot = {config.pivot_x_m, config.pivot_y_m};
  // Angles are counted from the middle of all vertices, so that no arc below a full turn is cut in two.
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const Eigen::Vector3d& p : points) middle += (p.head<2>() - belt.pivot).normalized();
  const double reference = std::atan2(middle.y(), middle.x());
  for (const Eigen::Vector3d& p : points) {
    const Eigen::Vector2d arm = p.head<2>() - belt.pivot;
    const double angle = wrap_angle(std::atan2(arm.y(), arm.x()) - reference);
    along_low = std::min(along_low, angle);
    along_high = std::max(along_high, angle);
    low = std::min(low, arm.norm());
    high = std::max(high, arm.norm());
  }
  belt.radius = 0.5 * (low + high);
  belt.first_angle = reference + along_low;
  belt.length = (along_high - along_low) * belt.radius;
  half_width = 0.5 * (high - low);
}

// Across the belt, the highest surface of all stations: rollers count with their crests.
struct Profile {
  std::vector<double> side;
  std::vector<double> height;  // -infinity where nothing is
};

Profile measure(const RayCaster& caster, const BeltSurface& belt, double half_width, double above) {
  Profile profile;
  const int steps = static_cast<int>(std::ceil(half_width / kSideStep));
  for (int i = -steps; i <= steps; ++i) {
    const double side = std::clamp(i * kSideStep, -half_width + 1e-4, half_width - 1e-4);
    double highest = -std::numeric_limits<double>::infinity();
    for (int k = 0; k < kStations; ++k) {
      // Uneven steps, so that rows of rollers are not missed all alike.
      const double along = belt.length * std::fmod((k + 0.5) * 0.6180339887498949, 1.0);
      const auto height = height_at(caster, belt.object, belt.point(along, side), above);
      if (height) highest = std::max(highest, *height);
    }
    profile.side.push_back(side);
    profile.height.push_back(highest);
  }
  return profile;
}

// From the middle outwards to where the surface ends: its last place, and how far what stands there rises above it.
std::pair<double, double> edge(const Profile& profile, double top, int step) {
  const int count = static_cast<int>(profile.side.size());
  int i = count / 2;
  const auto height = [&](int k) { return profile.height[static_cast<std::size_t>(k)]; };
  const auto level = [&](int k) { return height(k) <= top + kLevel && height(k) >= top - kDrop; };
  while (i + step >= 0 && i + step < count && level(i + step)) i += step;
  double guard = 0.0;
  for (int k = i; k >= 0 && k < count; k += step) {
    if (height(k) <= top + kHighest) guard = std::max(guard, height(k) - top);
  }
  return {profile.side[static_cast<std::size_t>(i)], guard > kLevel ? guard : 0.0};
}

BeltSurface find_belt_surface(const RayCaster& caster, const BeltConfig& config, int object) {
  const TrueObject& truth = caster.scene().objects[static_cast<std::size_t>(object)];
  BeltSurface belt;
  belt.name = truth.name;
  belt.object = object;
  const std::vector<Eigen::Vector3d> points = vertices_of(caster, object);
  double half_width = 0.0, above = 0.0;
  lay_centre_line(belt, config, truth.cuboid, points, half_width);
  for (const Eigen::Vector3d& p : points) above = std::max(above, p.z());
  const Profile profile = measure(caster, belt, half_width, above + 0.01);
  // The running surface is what lies in the middle half; roofs and rails are not the rule there.
  std::vector<double> middle;
  for (std::size_t i = 0; i < profile.side.size(); ++i) {
    if (std::abs(profile.side[i]) <= 0.5 * half_width && std::isfinite(profile.height[i])) middle.push_back(profile.height[i]);
  }
  if (middle.empty()) {
    throw Error("motion.belts: object '" + belt.name + "' has no surface along its middle for anything to run on");
  }
  std::nth_element(middle.begin(), middle.begin() + static_cast<std::ptrdiff_t>(middle.size() / 2), middle.end());
  belt.top = middle[middle.size() / 2];
  std::tie(belt.left, belt.left_guard) = edge(profile, belt.top, 1);
  std::tie(belt.right, belt.right_guard) = edge(profile, belt.top, -1);
  if (!(belt.left - belt.right > 0.02)) {
    throw Error("motion.belts: object '" + belt.name + "' is level only over " + std::to_string(belt.left - belt.right) +
                " m across its middle; is heading_deg or curve right?");
  }
  return belt;
}

}  // namespace

Eigen::Vector2d BeltSurface::point(double along, double side) const {
  if (!curve) return begin + along * direction + side * Eigen::Vector2d(-direction.y(), direction.x());
  const double angle = first_angle + along / radius;
  return pivot + (radius - side) * Eigen::Vector2d(std::cos(angle), std::sin(angle));
}

Eigen::Vector2d BeltSurface::travel(const Eigen::Vector2d& p_W) const {
  if (!curve) return direction;
  const Eigen::Vector2d arm = p_W - pivot;
  const double reach = arm.norm();
  return reach > 1e-9 ? Eigen::Vector2d(-arm.y() / reach, arm.x() / reach) : Eigen::Vector2d::UnitX();
}

Eigen::Vector2d BeltSurface::coordinates(const Eigen::Vector2d& p_W) const {
  if (!curve) {
    const Eigen::Vector2d from = p_W - begin;
    return {direction.dot(from), direction.x() * from.y() - direction.y() * from.x()};
  }
  const Eigen::Vector2d arm = p_W - pivot;
  const double half = 0.5 * length / radius;
  const double angle = wrap_angle(std::atan2(arm.y(), arm.x()) - first_angle - half) + half;
  return {angle * radius, radius - arm.norm()};
}

double BeltSurface::speed_factor(const Eigen::Vector2d& p_W) const { return curve ? (p_W - pivot).norm() / radius : 1.0; }

bool BeltSurface::carries(const Eigen::Vector2d& p_W) const {
  const Eigen::Vector2d at = coordinates(p_W);
  return at.x() >= 0.0 && at.x() <= length && at.y() >= right && at.y() <= left;
}

std::vector<BeltSurface> find_belt_surfaces(const RayCaster& ray_caster, const BeltConfig& config, std::size_t index) {
  std::vector<BeltSurface> found;
  const auto& objects = ray_caster.scene().objects;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (::fnmatch(config.object.c_str(), objects[i].name.c_str(), 0) != 0) continue;
    found.push_back(find_belt_surface(ray_caster, config, static_cast<int>(i)));
  }
  if (found.empty()) {
    throw Error("motion.belts." + std::to_string(index) + ".object '" + config.object + "' matches no true object of the hall");
  }
  return found;
}

}  // namespace waretwin

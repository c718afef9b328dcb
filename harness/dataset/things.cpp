#include "harness/dataset/things.h"

#include <algorithm>
#include <numbers>
#include <string>
#include <vector>

#include "harness/dataset/hall_heights.h"
#include "scenes/builder/shape.h"
#include "sim/robot.h"

namespace waretwin {

namespace {

constexpr double kRouteRadius_m = 0.7;  // kept free of standing things
constexpr double kDrop_m = 0.05;        // above what lies below
constexpr int kTries = 40;

int add_material(Scene& scene, Dice& dice) {
  Material material;
  material.name = "thing";
  const double grey = dice.between(0.02, 0.8);
  for (int k = 0; k < 3; ++k) {
    const double own = dice.chance(0.5) ? grey : dice.between(0.02, 0.8);
    material.base_colour[k] = static_cast<float>(own);
  }
  if (dice.chance(0.25)) material.base_colour.head<3>() = Eigen::Vector3f(0.38f, 0.24f, 0.12f);  // cardboard
  material.metallic = dice.chance(0.25) ? 1.0f : 0.0f;
  material.roughness = static_cast<float>(dice.between(0.15, 0.95));
  scene.materials.push_back(std::move(material));
  return static_cast<int>(scene.materials.size()) - 1;
}

int add_mesh(Scene& scene, const builder::Shape& shape, int material) {
  Mesh mesh;
  mesh.name = "thing";
  for (const Eigen::Vector3d& p : shape.positions) mesh.positions.push_back(p.cast<float>());
  for (const Eigen::Vector3d& n : shape.normals) mesh.normals.push_back(n.cast<float>());
  for (const Eigen::Vector2d& uv : shape.uv) mesh.uv[0].push_back(uv.cast<float>());
  mesh.triangles = shape.triangles;
  mesh.material = material;
  scene.meshes.push_back(std::move(mesh));
  return static_cast<int>(scene.meshes.size()) - 1;
}

builder::Shape loose_shape(Dice& dice) {
  const auto side = [&] { return dice.between(0.05, 0.4); };
  switch (dice.whole(0, 4)) {
    case 0:
      return builder::bevelled_box(side(), side(), side(), 0.004);
    case 1: {
      const double half = 0.5 * side();
      return builder::cylinder({0, 0, -half}, {0, 0, half}, dice.between(0.03, 0.12), 24);
    }
    case 2:
      return builder::bevelled_box(dice.between(0.3, 0.9), dice.between(0.03, 0.08), dice.between(0.03, 0.08), 0.003);
    case 3:
      return builder::bevelled_box(side(), side(), dice.between(0.01, 0.03), 0.002);
    default: {
      const double width = side(), height = side();
      return builder::extruded({{-0.5 * width, -0.5 * height}, {0.5 * width, -0.5 * height}, {0.5 * width, 0.5 * height}}, side());
    }
  }
}

struct Standing {
  builder::Shape shape;
  Eigen::Vector2d size;
};

Standing standing_shape(Dice& dice) {
  Standing out;
  switch (dice.whole(0, 4)) {
    case 0: {  // a frame of bars on legs, with or without shelves: like a conveyor, but for the belt
      const double dx = dice.between(0.4, 2.2), dy = dice.between(0.3, 0.9), dz = dice.between(0.4, 1.2), bar = dice.between(0.03, 0.08);
      out.size = {dx, dy};
      for (const double x : {-0.5, 0.5}) {
        for (const double y : {-0.5, 0.5}) {
          out.shape.append(builder::standing_box(bar, bar, dz).move(x * (dx - bar), y * (dy - bar), 0.0));
        }
        out.shape.append(builder::box(bar, dy, bar).move(x * (dx - bar), 0.0, dz - 0.5 * bar));
      }
      for (const double y : {-0.5, 0.5}) out.shape.append(builder::box(dx, bar, bar).move(0.0, y * (dy - bar), dz - 0.5 * bar));
      const int shelves = dice.whole(0, 3);
      for (int i = 0; i < shelves; ++i) out.shape.append(builder::box(dx, dy, 0.02).move(0.0, 0.0, dice.between(0.1, dz)));
      return out;
    }
    case 1: {  // a stack of boxes
      double z = 0.0;
      out.size = {dice.between(0.3, 0.8), dice.between(0.3, 0.8)};
      for (int i = dice.whole(1, 4); i > 0; --i) {
        const double height = dice.between(0.15, 0.4);
        out.shape.append(builder::standing_box(dice.between(0.6, 1.0) * out.size.x(), dice.between(0.6, 1.0) * out.size.y(), height, 0.004)
                             .move(0, 0, z));
        z += height;
      }
      return out;
    }
    case 2: {  // a table
      const double dx = dice.between(0.6, 1.8), dy = dice.between(0.5, 0.9), dz = dice.between(0.5, 1.0), leg = dice.between(0.03, 0.08);
      out.size = {dx, dy};
      for (const double x : {-0.45, 0.45}) {
        for (const double y : {-0.45, 0.45})
          out.shape.append(builder::cylinder({x * dx, y * dy, 0.0}, {x * dx, y * dy, dz}, 0.5 * leg, 12));
      }
      out.shape.append(builder::box(dx, dy, dice.between(0.02, 0.06)).move(0.0, 0.0, dz));
      return out;
    }
    case 3: {  // a drum or a column
      const double radius = dice.between(0.05, 0.35), height = dice.between(0.3, 1.9);
      out.size = {2.0 * radius, 2.0 * radius};
      out.shape = builder::cylinder({0, 0, 0}, {0, 0, height}, radius, 32);
      return out;
    }
    default: {  // a closed machine with a slanted desk
      const double dx = dice.between(0.4, 1.4), dy = dice.between(0.4, 0.9), dz = dice.between(0.6, 1.7);
      out.size = {dx, dy};
      out.shape =
          builder::extruded({{-0.5 * dy, 0.0}, {0.5 * dy, 0.0}, {0.5 * dy, dz}, {0.0, dz}, {-0.5 * dy, dice.between(0.5, 0.9) * dz}}, dx);
      return out;
    }
  }
}

Eigen::Vector2d anywhere(const Eigen::AlignedBox2d& area, Dice& dice) {
  return {dice.between(area.min().x(), area.max().x()), dice.between(area.min().y(), area.max().y())};
}

// Movers of dropped things stand after streams' and before walkers' (Scene::movers), each as one clutter of one.
void drop(Scene& scene, Scenario& scenario, const Eigen::Vector2d& at, double height, Dice& dice) {
  const builder::Shape shape = loose_shape(dice);
  Eigen::AlignedBox3d extent;
  for (const Eigen::Vector3d& p : shape.positions) extent.extend(p);
  Instance instance;
  instance.name = "thing";
  instance.mesh = add_mesh(scene, shape, add_material(scene, dice));
  scene.instances.push_back(std::move(instance));
  std::size_t before = 0;
  for (const ItemStream& stream : scenario.motion.streams) before += static_cast<std::size_t>(stream.most);
  for (const ClutterConfig& clutter : scenario.motion.clutter) before += static_cast<std::size_t>(clutter.count);
  scene.movers.insert(scene.movers.begin() + static_cast<std::ptrdiff_t>(before),
                      {"thing", {static_cast<int>(scene.instances.size()) - 1}});
  ClutterConfig thing;
  thing.name = "thing" + std::to_string(before);
  thing.body.mass_kg = dice.between(0.5, 8.0);
  thing.x_m = at.x();
  thing.y_m = at.y();
  thing.z_m = height + kDrop_m + 0.5 * extent.diagonal().norm();  // clear however it is turned
  thing.spread_x_m = thing.spread_y_m = 0.0;
  thing.seed = static_cast<std::uint64_t>(dice.whole(1, 1000000000));
  scenario.motion.clutter.push_back(std::move(thing));
}

}  // namespace

void add_things(Scene& scene, Scenario& scenario, const ThingsVariation& config, Dice& dice) {
  const int loose = dice.whole(0, config.loose_max), parcels = dice.whole(0, config.parcels_max),
            standing = dice.whole(0, config.standing_max);
  if (loose + parcels + standing == 0) return;
  HallHeights heights(scene);
  const RobotMotion route(scenario.robot);
  constexpr Stamp kEvery = 200'000'000;
  for (Stamp stamp = 0; stamp <= route.duration(); stamp += kEvery) heights.take(route.X_WB(stamp).translation().head<2>(), kRouteRadius_m);

  for (int i = 0; i < standing; ++i) {
    const Standing thing = standing_shape(dice);
    for (int tried = 0; tried < kTries; ++tried) {
      const Eigen::Vector2d at = anywhere(heights.area(), dice);
      const double yaw = dice.between(0.0, 2.0 * std::numbers::pi);
      if (!heights.is_free(at, thing.size, yaw)) continue;
      Instance instance;
      instance.name = "standing thing";
      instance.mesh = add_mesh(scene, thing.shape, add_material(scene, dice));
      instance.X_WM = make_upright_pose(at.x(), at.y(), heights.floor(), yaw).cast<float>();
      scene.instances.push_back(std::move(instance));
      heights.take(at, 0.5 * thing.size.norm());
      break;
    }
  }
  for (int i = 0; i < loose; ++i) {
    const Eigen::Vector2d at = anywhere(heights.area(), dice);
    drop(scene, scenario, at, heights.at(at), dice);
  }
  for (int i = 0; i < parcels && !scene.objects.empty(); ++i) {
    const Cuboid& box = dice.pick(scene.objects).cuboid;
    const Eigen::Vector2d from_centre(dice.between(-0.4, 0.4) * box.size.x(), dice.between(-0.3, 0.3) * box.size.y());
    const Eigen::Vector2d at = box.centre.head<2>() + Eigen::Rotation2Dd(box.yaw) * from_centre;
    drop(scene, scenario, at, std::max(heights.at(at), box.centre.z() + 0.5 * box.size.z()), dice);
  }
}

}  // namespace waretwin

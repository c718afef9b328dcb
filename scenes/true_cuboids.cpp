#include "scenes/true_cuboids.h"

#include <fnmatch.h>

#include <cmath>
#include <cstdio>

#include "core/error.h"

namespace waretwin {

namespace {

constexpr double kMaxTilt = 1.0;  // degrees

bool matches(const TruthRule& rule, const std::string& name) { return ::fnmatch(rule.pattern.c_str(), name.c_str(), 0) == 0; }

}  // namespace

ModelObjects find_objects(const Model& model, const std::vector<TruthRule>& rules, const std::string& whole_class,
                          const std::string& whole_name, std::vector<int>& matched) {
  matched.resize(rules.size(), 0);
  ModelObjects result;
  result.of_node.assign(model.nodes.size(), -1);
  if (!whole_class.empty()) result.objects.push_back({.node = -1, .name = whole_name, .class_name = whole_class});
  // The rules that a node or one above it has matched.
  std::vector<std::vector<bool>> used(model.nodes.size());
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    const ModelNode& node = model.nodes[i];
    const std::size_t parent = static_cast<std::size_t>(node.parent);
    if (node.parent >= 0) result.of_node[i] = result.of_node[parent];
    if (node.parent < 0) result.of_node[i] = whole_class.empty() ? -1 : 0;
    used[i] = node.parent >= 0 ? used[parent] : std::vector<bool>(rules.size(), false);
    if (node.class_name && node.class_name->empty()) {
      result.of_node[i] = -1;
      continue;
    }
    if (!whole_class.empty()) continue;
    std::string class_name = node.class_name.value_or("");
    for (std::size_t r = 0; class_name.empty() && r < rules.size(); ++r) {
      if (!matches(rules[r], node.name)) continue;
      if (!used[i][r]) {
        class_name = rules[r].class_name;
        ++matched[r];
      }
      used[i][r] = true;
      break;
    }
    if (class_name.empty()) continue;
    const std::string name = !node.object_name.empty() ? node.object_name : node.name;
    result.of_node[i] = static_cast<int>(result.objects.size());
    result.objects.push_back({.node = static_cast<int>(i), .name = name, .class_name = class_name});
  }
  return result;
}

Cuboid true_cuboid(const Model& model, const ModelObjects& objects, int object, const Eigen::Affine3d& X_WP) {
  const ModelObject& wanted = objects.objects[static_cast<std::size_t>(object)];
  const std::string element =
      wanted.node < 0 ? "model '" + wanted.name + "'" : "node '" + model.nodes[static_cast<std::size_t>(wanted.node)].name + "'";
  if (wanted.node >= 0) {
    const Eigen::Vector3d up_W = X_WP.linear() * model.nodes[static_cast<std::size_t>(wanted.node)].X_PN.linear().col(1);
    const double tilt = to_degrees(std::acos(std::min(1.0, std::max(-1.0, up_W.z() / up_W.norm()))));
    if (!(tilt <= kMaxTilt)) {
      char text[120];
      std::snprintf(text, sizeof text, ": is a '%.40s' tilted by %.1f deg; true objects stand upright within %.0f deg",
                    wanted.class_name.c_str(), tilt, kMaxTilt);
      throw Error(model.file, element + text);
    }
  }
  std::vector<Eigen::Vector3d> points_W;
  std::vector<bool> taken;
  for (std::size_t i = 0; i < model.instance_nodes.size(); ++i) {
    const std::size_t node = static_cast<std::size_t>(model.instance_nodes[i]);
    if (objects.of_node[node] != object) continue;
    const Mesh& mesh = model.content.meshes[static_cast<std::size_t>(model.content.instances[i].mesh)];
    const Eigen::Affine3d X_WN = X_WP * model.nodes[node].X_PN;
    taken.assign(mesh.positions.size(), false);
    for (const std::uint32_t vertex : mesh.triangles) {
      if (taken[vertex]) continue;
      taken[vertex] = true;
      points_W.push_back(X_WN * mesh.positions[vertex].cast<double>());
    }
  }
  if (points_W.empty()) throw Error(model.file, element + ": is a '" + wanted.class_name + "' without triangles");
  return minimum_area_cuboid(points_W, "world");
}

}  // namespace waretwin

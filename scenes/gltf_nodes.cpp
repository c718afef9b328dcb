#include "scenes/gltf_nodes.h"

#include <algorithm>
#include <cmath>

#include "scenes/gltf_extras.h"

namespace waretwin {

Eigen::Matrix3d z_up_from_y_up() {
  Eigen::Matrix3d R;
  R << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  return R;
}

namespace {

// Volume of the unit cube under `linear`, relative to that of a box with the same edge lengths: 0 when flat, 1 when right-angled.
double relative_volume(const Eigen::Matrix3d& linear) {
  const double edges = linear.col(0).norm() * linear.col(1).norm() * linear.col(2).norm();
  return edges > 0.0 ? std::abs(linear.determinant()) / edges : 0.0;
}

class NodeLoader {
 public:
  NodeLoader(const GltfDocument& document, MeshLoader& meshes, Model& model) : document_(document), meshes_(meshes), model_(model) {}

  void load() {
    const std::vector<int> parents = checked_parents();
    // Children in the order of the file, parents first, without recursion: a chain of nodes may be as long as a file can hold.
    std::vector<Task> stack;
    const std::vector<int> roots = checked_roots(parents);
    for (auto root = roots.rbegin(); root != roots.rend(); ++root) stack.push_back({*root, -1});
    while (!stack.empty()) {
      const Task task = stack.back();
      stack.pop_back();
      const int added = add(task);
      const std::vector<int>& children = node(task.node).children;
      for (auto child = children.rbegin(); child != children.rend(); ++child) stack.push_back({*child, added});
    }
  }

 private:
  struct Task {
    int node;    // of the file
    int parent;  // index into Model::nodes
  };

  const std::vector<tinygltf::Node>& nodes() const { return document_.model().nodes; }
  const tinygltf::Node& node(int index) const { return nodes()[static_cast<std::size_t>(index)]; }
  std::string name_of(int index) const { return element_name("node", static_cast<std::size_t>(index), node(index).name); }

  bool exists(int index) const { return index >= 0 && static_cast<std::size_t>(index) < nodes().size(); }

  std::vector<int> checked_parents() const {
    std::vector<int> parents(nodes().size(), -1);
    for (std::size_t i = 0; i < nodes().size(); ++i) {
      for (const int child : nodes()[i].children) {
        if (!exists(child)) {
          document_.fail(name_of(static_cast<int>(i)),
                         "names child " + std::to_string(child) + " of " + std::to_string(nodes().size()) + " nodes");
        }
        if (parents[static_cast<std::size_t>(child)] >= 0) document_.fail(name_of(child), "has two parents");
        parents[static_cast<std::size_t>(child)] = static_cast<int>(i);
      }
    }
    // With one parent each, whatever no root leads to is a cycle.
    std::vector<bool> reached(nodes().size(), false);
    std::vector<int> stack;
    for (std::size_t i = 0; i < nodes().size(); ++i) {
      if (parents[i] < 0) stack.push_back(static_cast<int>(i));
    }
    while (!stack.empty()) {
      const int index = stack.back();
      stack.pop_back();
      reached[static_cast<std::size_t>(index)] = true;
      stack.insert(stack.end(), node(index).children.begin(), node(index).children.end());
    }
    const auto lost = std::find(reached.begin(), reached.end(), false);
    if (lost != reached.end()) document_.fail(name_of(static_cast<int>(lost - reached.begin())), "is its own ancestor");
    return parents;
  }

  std::vector<int> checked_roots(const std::vector<int>& parents) const {
    const auto& scenes = document_.model().scenes;
    std::vector<int> roots;
    if (scenes.empty()) {
      for (std::size_t i = 0; i < parents.size(); ++i) {
        if (parents[i] < 0) roots.push_back(static_cast<int>(i));
      }
      return roots;
    }
    const int chosen = std::max(document_.model().defaultScene, 0);
    if (static_cast<std::size_t>(chosen) >= scenes.size()) {
      document_.fail("scene", "is " + std::to_string(chosen) + " but there are " + std::to_string(scenes.size()) + " scenes");
    }
    roots = scenes[static_cast<std::size_t>(chosen)].nodes;
    std::vector<bool> seen(nodes().size(), false);
    for (const int root : roots) {
      if (!exists(root))
        document_.fail("scene " + std::to_string(chosen), "names node " + std::to_string(root) + " of " + std::to_string(nodes().size()));
      if (parents[static_cast<std::size_t>(root)] >= 0) document_.fail(name_of(root), "is a root of the scene and a child of another node");
      if (seen[static_cast<std::size_t>(root)]) document_.fail(name_of(root), "is named twice by the scene");
      seen[static_cast<std::size_t>(root)] = true;
    }
    return roots;
  }

  Eigen::Affine3d local_transform(int index) const {
    const tinygltf::Node& source = node(index);
    Eigen::Affine3d X = Eigen::Affine3d::Identity();
    if (!source.matrix.empty()) {
      X.matrix() = Eigen::Map<const Eigen::Matrix4d>(source.matrix.data());  // column-major, as glTF has it
      const Eigen::RowVector4d last = X.matrix().row(3);
      if ((last - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() > 1e-6) document_.fail(name_of(index), "matrix is not affine");
      X.makeAffine();
      return X;
    }
    if (!source.translation.empty()) X.translate(Eigen::Map<const Eigen::Vector3d>(source.translation.data()));
    if (!source.rotation.empty()) {
      const Eigen::Quaterniond q(source.rotation[3], source.rotation[0], source.rotation[1], source.rotation[2]);
      if (!(q.norm() > 1e-6) || !std::isfinite(q.norm())) document_.fail(name_of(index), "rotation is not a unit quaternion");
      X.rotate(q.normalized());
    }
    if (!source.scale.empty()) X.scale(Eigen::Map<const Eigen::Vector3d>(source.scale.data()));
    return X;
  }

  int add(const Task& task) {
    const tinygltf::Node& source = node(task.node);
    const std::string element = name_of(task.node);
    ModelNode added;
    added.name = source.name;
    added.parent = task.parent;
    Eigen::Affine3d X_PA = Eigen::Affine3d::Identity();
    X_PA.linear() = z_up_from_y_up();
    if (task.parent >= 0) X_PA = model_.nodes[static_cast<std::size_t>(task.parent)].X_PN;
    added.X_PN = X_PA * local_transform(task.node);
    if (!added.X_PN.matrix().allFinite()) document_.fail(element, "transform is not finite");
    read_extras(source, element, added);
    model_.nodes.push_back(added);
    const int index = static_cast<int>(model_.nodes.size()) - 1;
    if (source.mesh >= 0) add_instances(source, element, index);
    if (source.skin >= 0) document_note(element + ": its skin is read over");
    add_light(source, element, added.X_PN);
    return index;
  }

  void document_note(const std::string& note) { model_.content.notes.push_back(note); }

  void read_extras(const tinygltf::Node& source, const std::string& element, ModelNode& added) const {
    const auto text = [&](const char* key, const tinygltf::Value& value) {
      if (!value.IsString()) document_.fail(element, std::string("extras waretwin.") + key + " is not text");
      return value.Get<std::string>();
    };
    if (const tinygltf::Value* value = waretwin_extra(source.extras, "class")) added.class_name = text("class", *value);
    if (const tinygltf::Value* value = waretwin_extra(source.extras, "name")) added.object_name = text("name", *value);
  }

  void add_instances(const tinygltf::Node& source, const std::string& element, int index) {
    const Eigen::Affine3d& X_PN = model_.nodes[static_cast<std::size_t>(index)].X_PN;
    if (!(relative_volume(X_PN.linear()) > 1e-6)) document_.fail(element, "scale or matrix flattens its mesh to nothing");
    for (const int mesh : meshes_.primitives(source.mesh, element)) {
      if (model_.content.instances.size() >= GltfLimits::kInstances) {
        document_.fail(element, "brings this file beyond " + std::to_string(GltfLimits::kInstances) + " instances");
      }
      Eigen::AlignedBox3d box;
      for (const Eigen::Vector3d& corner : corners_of(mesh)) box.extend(Eigen::Vector3d(X_PN * corner));
      if (!(box.min().cwiseAbs().maxCoeff() <= GltfLimits::kExtent && box.max().cwiseAbs().maxCoeff() <= GltfLimits::kExtent)) {
        document_.fail(element, "reaches beyond 1000 km from the origin");
      }
      Instance instance;
      instance.name = source.name;
      instance.mesh = mesh;
      instance.X_WM = X_PN.cast<float>();
      model_.content.instances.push_back(instance);
      model_.instance_nodes.push_back(index);
    }
  }

  const std::vector<Eigen::Vector3d>& corners_of(int mesh) {
    std::vector<std::vector<Eigen::Vector3d>>& known = corners_;
    if (known.size() <= static_cast<std::size_t>(mesh)) known.resize(static_cast<std::size_t>(mesh) + 1);
    std::vector<Eigen::Vector3d>& corners = known[static_cast<std::size_t>(mesh)];
    if (corners.empty()) {
      Eigen::AlignedBox3f box;
      for (const Eigen::Vector3f& p : model_.content.meshes[static_cast<std::size_t>(mesh)].positions) box.extend(p);
      for (int i = 0; i < 8; ++i) corners.push_back(box.corner(static_cast<Eigen::AlignedBox3f::CornerType>(i)).cast<double>());
    }
    return corners;
  }

  void add_light(const tinygltf::Node& source, const std::string& element, const Eigen::Affine3d& X_PN) {
    const auto extension = source.extensions.find("KHR_lights_punctual");
    if (extension == source.extensions.end()) return;
    const tinygltf::Value* number = member(extension->second, "light");
    const auto& lights = document_.model().lights;
    const int index = number == nullptr ? -1 : static_cast<int>(number_in(document_, *number, element, "light", 0, 1e9));
    if (index < 0 || static_cast<std::size_t>(index) >= lights.size()) {
      document_.fail(element, "names light " + std::to_string(index) + " of " + std::to_string(lights.size()));
    }
    model_.content.lights.push_back(light(lights[static_cast<std::size_t>(index)], source, index, element, X_PN));
  }

  Light light(const tinygltf::Light& source, const tinygltf::Node& at, int index, const std::string& node_element,
              const Eigen::Affine3d& X_PN) const {
    const std::string element = element_name("light", static_cast<std::size_t>(index), source.name);
    Light result;
    result.name = at.name.empty() ? source.name : at.name;
    if (source.type == "point") {
      result.kind = Light::Kind::kPoint;
    } else if (source.type == "spot") {
      result.kind = Light::Kind::kSpot;
    } else if (source.type == "directional") {
      result.kind = Light::Kind::kDirectional;
    } else {
      document_.fail(element, "type is neither point, spot nor directional");
    }
    result.position = X_PN.translation().cast<float>();
    // KHR_lights_punctual: light travels along the node's -z.
    const Eigen::Vector3d along = -X_PN.linear().col(2);
    if (!(along.norm() > 1e-9)) document_.fail(node_element, "scale leaves its light no direction");
    result.direction = along.normalized().cast<float>();
    if (!source.color.empty() && source.color.size() != 3) document_.fail(element, "color must have 3 numbers");
    if (!(source.intensity >= 0.0 && source.intensity <= 1e9)) document_.fail(element, "intensity must lie between 0 and 1e9");
    for (int c = 0; c < 3; ++c) {
      const double colour = source.color.empty() ? 1.0 : source.color[static_cast<std::size_t>(c)];
      if (!(colour >= 0.0 && colour <= 1e6)) document_.fail(element, "color must not be negative");
      result.intensity[c] = static_cast<float>(colour * source.intensity);
    }
    if (!(source.range >= 0.0)) document_.fail(element, "range must not be negative");
    if (source.range > 0.0) result.range = static_cast<float>(source.range);
    result.inner_cone = static_cast<float>(source.spot.innerConeAngle);
    result.outer_cone = static_cast<float>(source.spot.outerConeAngle);
    const bool cone_is_good = result.inner_cone >= 0.0f && result.inner_cone < result.outer_cone && result.outer_cone <= 1.5708f;
    if (result.kind == Light::Kind::kSpot && !cone_is_good) document_.fail(element, "cone angles must obey 0 <= inner < outer <= pi/2");
    for (const tinygltf::Value* extras : {&source.extras, &at.extras}) {
      if (const tinygltf::Value* radius = waretwin_extra(*extras, "radius_m")) {
        result.radius = static_cast<float>(number_in(document_, *radius, element, "radius_m", 0.0, 100.0));
      }
    }
    return result;
  }

  const GltfDocument& document_;
  MeshLoader& meshes_;
  Model& model_;
  std::vector<std::vector<Eigen::Vector3d>> corners_;
};

}  // namespace

void load_nodes(const GltfDocument& document, MeshLoader& meshes, Model& model) { NodeLoader(document, meshes, model).load(); }

}  // namespace waretwin

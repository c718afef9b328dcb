#include "harness/score/scenenn_annotation.h"

#include <tinyxml2.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <set>
#include <sstream>

#include "core/error.h"
#include "core/files.h"
#include "harness/score/farthest.h"

namespace waretwin {

namespace {

std::string attribute(const tinyxml2::XMLElement& label, const char* name) {
  const char* value = label.Attribute(name);
  return value == nullptr ? "" : value;
}

std::string class_of(const tinyxml2::XMLElement& label) {
  std::string name = attribute(label, "nyu_class");
  if (name.empty()) name = attribute(label, "text");
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return name == "refridgerator" ? "refrigerator" : name;
}

// The upright box of the heading of one of the box's own edges.
Cuboid upright(const Eigen::Vector3d& centre, const Eigen::Vector3d& size, const Eigen::Matrix3d& axes, const std::string& frame) {
  // Of the two edges other than the steepest the one that lies flatter gives the heading.
  int steepest = 0;
  axes.row(2).cwiseAbs().maxCoeff(&steepest);
  const int a = (steepest + 1) % 3, b = (steepest + 2) % 3;
  const int along = axes.col(a).head<2>().norm() >= axes.col(b).head<2>().norm() ? a : b;
  Cuboid cuboid;
  cuboid.frame = frame;
  cuboid.yaw = std::atan2(axes(1, along), axes(0, along));
  cuboid.centre = centre;
  const Eigen::Matrix3d in_box = make_upright_pose(0, 0, 0, -cuboid.yaw).linear() * axes;
  cuboid.size = in_box.cwiseAbs() * size;
  return canonical(cuboid);
}

}  // namespace

std::string scenenn_annotation(const std::vector<ListedObject>& objects) {
  tinyxml2::XMLPrinter out;
  out.PushHeader(false, true);
  out.OpenElement("annotation");
  for (const ListedObject& object : objects) {
    const Cuboid& c = object.cuboid;
    char box[400];
    std::snprintf(box, sizeof box, "%.17g %.17g %.17g %.17g %.17g %.17g 0 0 %.17g %.17g", c.centre.x(), c.centre.y(), c.centre.z(),
                  c.size.x(), c.size.y(), c.size.z(), std::sin(0.5 * c.yaw), std::cos(0.5 * c.yaw));
    out.OpenElement("label");
    out.PushAttribute("id", object.id);
    out.PushAttribute("text", object.class_name.c_str());
    out.PushAttribute("nyu_class", object.class_name.c_str());
    out.PushAttribute("obbox", box);
    out.CloseElement();
  }
  out.CloseElement();
  return out.CStr();
}

std::vector<ListedObject> read_scenenn_annotation(const std::filesystem::path& file, const Pose& X_UR, const std::string& frame) {
  static const std::set<std::string> room = {"", "unknown", "wall", "floor", "ceiling"};
  const std::string bytes = read_file(file);
  tinyxml2::XMLDocument document;
  if (document.Parse(bytes.data(), bytes.size()) != tinyxml2::XML_SUCCESS) {
    throw Error(file, document.ErrorLineNum(), std::string("is not XML that can be read (") + document.ErrorName() + ")");
  }
  const tinyxml2::XMLElement* root = document.FirstChildElement("annotation");
  if (root == nullptr) throw Error(file, "has no <annotation>; expected a SceneNN annotation");
  std::vector<ListedObject> objects;
  std::set<int> ids;
  for (const auto* label = root->FirstChildElement("label"); label != nullptr; label = label->NextSiblingElement("label")) {
    const std::string name = class_of(*label), box = attribute(*label, "obbox");
    if (room.contains(name) || box.empty()) continue;
    const auto fail = [&](const std::string& what) { throw Error(file, label->GetLineNum(), "label '" + name + "': " + what); };
    ListedObject object;
    object.class_name = name;
    if (label->QueryIntAttribute("id", &object.id) != tinyxml2::XML_SUCCESS)
      fail("id is '" + attribute(*label, "id") + "'; expected a whole number");
    if (!ids.insert(object.id).second) fail("id " + std::to_string(object.id) + " stands twice");
    std::istringstream in(box);
    std::vector<double> n;
    for (double value = 0; in >> value;) n.push_back(value);
    constexpr std::size_t kNumbers = 10;
    const bool in_range = std::all_of(n.begin(), n.end(), [](double v) { return std::abs(v) <= kFarthest_m; });
    if (n.size() != kNumbers || !in.eof() || !in_range)
      fail("obbox is '" + box + "'; expected ten numbers up to 1e9: centre, size, quaternion x y z w");
    const Eigen::Vector3d size(n[3], n[4], n[5]);
    const Eigen::Quaterniond turn(n[9], n[6], n[7], n[8]);
    if (size.minCoeff() < 0.0) fail("obbox has a negative length");
    if (!(std::abs(turn.norm() - 1.0) < 0.01)) fail("obbox ends in no quaternion of length 1 (x y z w)");
    if (size.prod() == 0.0) continue;
    const Eigen::Matrix3d axes = X_UR.linear() * turn.normalized().toRotationMatrix();
    object.cuboid = upright(X_UR * Eigen::Vector3d(n[0], n[1], n[2]), size, axes, frame);
    objects.push_back(object);
  }
  return objects;
}

}  // namespace waretwin

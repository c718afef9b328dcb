#include "harness/report/page_json.h"

#include <cmath>

#include "core/error.h"

namespace waretwin {

Json rounded(double value, int decimals) {
  if (!std::isfinite(value)) return nullptr;
  const double scale = std::pow(10.0, decimals);
  const double number = std::round(value * scale) / scale;
  return number == 0.0 ? 0.0 : number;  // no -0
}

Json pose_json(const Pose& X) {
  const Eigen::Quaterniond q(X.rotation());
  const Eigen::Vector3d p = X.translation();
  return {rounded(p.x(), 5), rounded(p.y(), 5), rounded(p.z(), 5), rounded(q.x(), 7),
          rounded(q.y(), 7), rounded(q.z(), 7), rounded(q.w(), 7)};
}

Pose pose_from(const Json& json) {
  Pose X = Pose::Identity();
  X.translation() = Eigen::Vector3d(json.at(0), json.at(1), json.at(2));
  const Eigen::Quaterniond q(json.at(6), json.at(3), json.at(4), json.at(5));
  if (!(q.norm() > 1e-6) || !X.translation().allFinite()) throw Error("a pose is no pose; expected x, y, z and a unit quaternion");
  X.linear() = q.normalized().toRotationMatrix();
  return X;
}

Json objects_json(const std::vector<ListedObject>& objects) {
  Json list = Json::array();
  for (const ListedObject& object : objects) {
    const Cuboid& c = object.cuboid;
    list.push_back({{"id", object.id},
                    {"class", object.class_name},
                    {"centre", {rounded(c.centre.x(), 4), rounded(c.centre.y(), 4), rounded(c.centre.z(), 4)}},
                    {"yaw", rounded(c.yaw, 5)},
                    {"size", {rounded(c.size.x(), 4), rounded(c.size.y(), 4), rounded(c.size.z(), 4)}},
                    {"score", rounded(object.score, 4)}});
  }
  return list;
}

std::vector<ListedObject> objects_from(const Json& json) {
  std::vector<ListedObject> objects;
  for (const Json& entry : json) {
    ListedObject object;
    object.id = entry.at("id");
    object.class_name = entry.at("class");
    const Json &centre = entry.at("centre"), &size = entry.at("size");
    object.cuboid.centre = Eigen::Vector3d(centre.at(0), centre.at(1), centre.at(2));
    object.cuboid.size = Eigen::Vector3d(size.at(0), size.at(1), size.at(2));
    object.cuboid.yaw = entry.at("yaw");
    object.score = entry.at("score");
    objects.push_back(std::move(object));
  }
  return objects;
}

}  // namespace waretwin

#include "harness/score/cuboid_file.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "core/error.h"
#include "core/files.h"
#include "core/json_text.h"
#include "harness/score/farthest.h"

namespace waretwin {

namespace {

using Json = nlohmann::json;

// What is being read, for messages.
struct Place {
  const std::filesystem::path& file;
  std::string object;
  [[noreturn]] void fail(const std::string& problem) const { throw Error(file, object.empty() ? problem : object + ": " + problem); }
};

const Json& need(const Json& parent, const char* key, const Place& place) {
  if (!parent.is_object()) place.fail("expected a JSON object with key '" + std::string(key) + "'");
  const auto found = parent.find(key);
  if (found == parent.end()) place.fail("key '" + std::string(key) + "' is missing");
  return *found;
}

double number(const Json& value, const char* key, const Place& place) {
  if (!value.is_number()) place.fail("'" + std::string(key) + "' is " + value.dump().substr(0, 40) + ", expected a number");
  const double result = value.get<double>();
  if (!std::isfinite(result)) place.fail("'" + std::string(key) + "' is not finite");
  return result;
}

Eigen::Vector3d vector3(const Json& parent, const char* key, const Place& place) {
  const Json& value = need(parent, key, place);
  if (!value.is_array() || value.size() != 3) place.fail("'" + std::string(key) + "' is not a list of 3 numbers");
  return {number(value[0], key, place), number(value[1], key, place), number(value[2], key, place)};
}

Eigen::Vector3d metres(const Json& parent, const char* key, const Place& place) {
  const Eigen::Vector3d value = vector3(parent, key, place);
  if (value.cwiseAbs().maxCoeff() > kFarthest_m) place.fail("'" + std::string(key) + "' is beyond 1e9, expected metres");
  return value;
}

double share(const Json& parent, const char* key, const Place& place) {
  const auto found = parent.find(key);
  if (found == parent.end()) return 1.0;
  const double value = number(*found, key, place);
  if (value < 0.0 || value > 1.0) place.fail("'" + std::string(key) + "' is " + found->dump() + ", expected 0 to 1");
  return value;
}

ListedObject read_object(const Json& json, const std::string& frame, const Place& place) {
  ListedObject object;
  const Json& id = need(json, "id", place);
  if (!id.is_number_integer() || id.get<std::int64_t>() < 0 || id.get<std::int64_t>() > 1'000'000'000) {
    place.fail("'id' is " + id.dump().substr(0, 40) + ", expected a whole number from 0");
  }
  object.id = id.get<int>();
  const Json& class_name = need(json, "class", place);
  if (!class_name.is_string()) place.fail("'class' is " + class_name.dump().substr(0, 40) + ", expected a word");
  object.class_name = class_name.get<std::string>();
  Cuboid cuboid;
  cuboid.centre = metres(json, "centre", place);
  cuboid.yaw = number(need(json, "yaw", place), "yaw", place);
  cuboid.size = metres(json, "size", place);
  if (cuboid.size.minCoeff() < 0.0) place.fail("'size' has a negative length");
  cuboid.frame = frame;
  object.cuboid = canonical(cuboid);
  object.score = share(json, "score", place);
  object.visible_fraction = share(json, "visible_fraction", place);
  return object;
}

}  // namespace

std::vector<ListedObject> read_object_list(const std::filesystem::path& file) {
  Place place{file, ""};
  const Json json = parse_json<Json>(file, read_file(file), "an object with a list 'objects'");
  const Json& objects = need(json, "objects", place);
  if (!objects.is_array()) place.fail("'objects' is not a list");
  std::string frame = "world";
  if (const auto found = json.find("frame"); found != json.end()) {
    if (!found->is_string()) place.fail("'frame' is not a word");
    frame = found->get<std::string>();
  }
  std::vector<ListedObject> list;
  std::set<int> ids;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    place.object = "objects[" + std::to_string(i) + "]";
    list.push_back(read_object(objects[i], frame, place));
    if (!ids.insert(list.back().id).second) place.fail("id " + std::to_string(list.back().id) + " stands twice");
  }
  return list;
}

std::string truth_json(const std::vector<ListedObject>& objects) {
  nlohmann::ordered_json json;
  json["frame"] = objects.empty() ? "world" : objects.front().cuboid.frame;
  json["objects"] = nlohmann::ordered_json::array();
  for (const ListedObject& object : objects) {
    const Cuboid& c = object.cuboid;
    json["objects"].push_back({{"id", object.id},
                               {"class", object.class_name},
                               {"centre", {c.centre.x(), c.centre.y(), c.centre.z()}},
                               {"yaw", c.yaw},
                               {"size", {c.size.x(), c.size.y(), c.size.z()}},
                               {"visible_fraction", object.visible_fraction}});
  }
  return json.dump(2) + "\n";
}

std::filesystem::path file_or_in_folder(const std::filesystem::path& path, const std::string& name) {
  std::filesystem::path file = path;
  if (std::filesystem::is_directory(path)) file /= name;
  if (!std::filesystem::exists(file)) throw Error(file, "does not exist; expected a file or a folder with " + name);
  return file;
}

}  // namespace waretwin

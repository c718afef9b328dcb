#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "core/files.h"
#include "mapper/output/map_files.h"

namespace waretwin {

namespace {

std::string formatted(double value, const char* format) {
  char text[400];  // a double has at most 309 digits before the point
  std::snprintf(text, sizeof text, format, value == 0.0 ? 0.0 : value);
  return text;
}

std::string nine(double value) { return formatted(value, "%.9f"); }

}  // namespace

void write_occupancy(const std::filesystem::path& file, const OccupancyGrid& grid) {
  std::string image = "P5\n" + std::to_string(grid.width) + " " + std::to_string(grid.height) + "\n255\n";
  for (int y = grid.height - 1; y >= 0; --y) {
    for (int x = 0; x < grid.width; ++x) {
      const VoxelState state = grid.at(x, y);
      image += static_cast<char>(state == VoxelState::occupied ? 0 : state == VoxelState::free ? 254 : 205);
    }
  }
  write_file(file, image);
  std::filesystem::path yaml = file;
  yaml.replace_extension(".yaml");
  write_file(yaml, "image: " + file.filename().string() + "\nmode: trinary\nresolution: " + formatted(grid.resolution_m, "%.9g") +
                       "\norigin: [" + nine(grid.origin.x()) + ", " + nine(grid.origin.y()) +
                       ", 0.0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
}

void write_distance_field(const std::filesystem::path& file, const DistanceField& field) {
  const std::string r = formatted(field.resolution_m, "%.9g");
  const auto middle = [&](int axis) { return formatted(field.origin[axis] + 0.5 * field.resolution_m, "%.9g"); };
  std::string bytes =
      "NRRD0004\n# distances to obstacles in millimetres, less than 0 inside them; -32768 = unknown\ntype: int16\ndimension: 3\n";
  bytes += "sizes: " + std::to_string(field.width) + " " + std::to_string(field.depth) + " " + std::to_string(field.height) + "\n";
  bytes += "space dimension: 3\nspace directions: (" + r + ",0,0) (0," + r + ",0) (0,0," + r + ")\n";
  bytes += "space origin: (" + middle(0) + "," + middle(1) + "," + middle(2) + ")\nspace units: \"m\" \"m\" \"m\"\n";
  bytes += "endian: little\nencoding: raw\n\n";
  for (const float distance : field.distances) {
    const long millimetres = std::isnan(distance) ? -32768 : std::lround(static_cast<double>(distance) * 1000.0);
    const auto value = static_cast<std::uint16_t>(static_cast<std::int16_t>(std::clamp(millimetres, -32768L, 32767L)));
    bytes += static_cast<char>(value & 0xff);
    bytes += static_cast<char>(value >> 8);
  }
  write_file(file, bytes);
}

void write_cuboids(const std::filesystem::path& file, const std::string& frame, const ObjectList& objects) {
  std::vector<const MappedObject*> order;
  for (const MappedObject& object : objects) order.push_back(&object);
  std::sort(order.begin(), order.end(), [](const MappedObject* a, const MappedObject* b) { return a->id < b->id; });
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const MappedObject* object : order) {
    const Cuboid box = canonical(object->cuboid);
    nlohmann::ordered_json entry;
    entry["id"] = object->id;
    entry["class"] = object->class_name;
    entry["centre"] = {box.centre.x(), box.centre.y(), box.centre.z()};
    entry["yaw"] = box.yaw;
    entry["size"] = {box.size.x(), box.size.y(), box.size.z()};
    entry["score"] = static_cast<double>(object->score);
    list.push_back(std::move(entry));
  }
  nlohmann::ordered_json root;
  root["frame"] = frame;
  root["objects"] = std::move(list);
  write_file(file, root.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
}

}  // namespace waretwin

// Lists of objects as the scorer compares them, whoever made them, and their files cuboids.json and truth.json.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/cuboid.h"

namespace waretwin {

struct ListedObject {
  int id = 0;
  std::string class_name;
  Cuboid cuboid;
  double score = 1.0;             // of a mapped object: how sure the mapper is, in [0, 1]
  double visible_fraction = 1.0;  // of a true object: share of its viewable surface that the mapped frames saw, in [0, 1]
};

// {"frame":"world","objects":[{"id":1,"class":"conveyor","centre":[x,y,z],"yaw":rad,"size":[dx,dy,dz],"score":1.0}]}; a truth file carries
// visible_fraction in place of score. Either may be missing and is then 1. Cuboids come back canonical. Throws Error, naming the file and
// the object, for text that is not JSON, a missing key, a wrong type, numbers that are not finite, negative sizes, or ids that stand twice.
std::vector<ListedObject> read_object_list(const std::filesystem::path& file);

// The same text for a truth list.
std::string truth_json(const std::vector<ListedObject>& objects);

// The file itself, or the one called `name` in a run's folder. Throws Error when there is none.
std::filesystem::path file_or_in_folder(const std::filesystem::path& path, const std::string& name);

}  // namespace waretwin

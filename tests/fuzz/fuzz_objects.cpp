// Feeds arbitrary bytes to the readers of object lists that others made, by the first byte SceneNN's annotation or a mapper's cuboids.json:
// they throw Error or give finite cuboids.
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>

#include "core/error.h"
#include "core/files.h"
#include "harness/score/cuboid_file.h"
#include "harness/score/scenenn_annotation.h"
#include "tests/support/test_data.h"

namespace {

void check(const std::vector<waretwin::ListedObject>& objects) {
  for (const waretwin::ListedObject& object : objects) {
    const waretwin::Cuboid& c = object.cuboid;
    WARETWIN_CHECK(c.centre.allFinite() && c.size.allFinite() && std::isfinite(c.yaw), "cuboids are finite");
    WARETWIN_CHECK(std::isfinite(c.size.prod()) && std::isfinite(c.centre.squaredNorm()), "volumes and distances are finite");
    WARETWIN_CHECK(c.size.minCoeff() >= 0.0 && c.size.x() >= c.size.y(), "cuboids are canonical");
    WARETWIN_CHECK(object.score >= 0.0 && object.score <= 1.0, "scores are shares");
    WARETWIN_CHECK(object.visible_fraction >= 0.0 && object.visible_fraction <= 1.0, "fractions are shares");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  static const waretwin::test::TemporaryFolder folder;
  const bool annotation = data[0] % 2 == 0;
  const std::filesystem::path file = folder.path() / (annotation ? "011.xml" : "cuboids.json");
  waretwin::write_file(file, std::string_view(reinterpret_cast<const char*>(data) + 1, size - 1));
  // A world whose y points down, as SceneNN's.
  waretwin::Pose X_UR = waretwin::make_upright_pose(1.0, 2.0, 3.0, 0.3);
  X_UR.linear() = X_UR.linear() * Eigen::AngleAxisd(-0.5 * 3.14159265358979323846, Eigen::Vector3d::UnitX()).toRotationMatrix();
  try {
    check(annotation ? waretwin::read_scenenn_annotation(file, X_UR) : waretwin::read_object_list(file));
  } catch (const waretwin::Error&) {
  }
  return 0;
}

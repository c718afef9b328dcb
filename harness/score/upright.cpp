#include "harness/score/upright.h"

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files.h"

namespace waretwin {

Pose upright_from_recording(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "upright.json";
  std::error_code error;
  Pose X_RU = Pose::Identity();
  if (!std::filesystem::is_regular_file(file, error)) return X_RU;
  try {
    const auto json = nlohmann::json::parse(read_file(file));
    for (int row = 0; row < 4; ++row) {
      const auto& values = json.at("X_recording_upright").at(static_cast<std::size_t>(row));
      for (int column = 0; column < 4; ++column) X_RU.matrix()(row, column) = values.at(static_cast<std::size_t>(column)).get<double>();
    }
  } catch (const nlohmann::json::exception& problem) {
    throw Error(file, "is no pose (" + std::string(problem.what()) + ")");
  }
  return orthonormalised(X_RU).inverse();
}

}  // namespace waretwin

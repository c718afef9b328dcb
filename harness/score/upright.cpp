#include "harness/score/upright.h"

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files.h"
#include "core/json_text.h"

namespace waretwin {

Pose upright_from_recording(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "upright.json";
  std::error_code error;
  Pose X_RU = Pose::Identity();
  if (!std::filesystem::is_regular_file(file, error)) return X_RU;
  const auto json = parse_json<nlohmann::json>(file, read_file(file), "X_recording_upright, a pose");
  const auto refuse = [&] { throw Error(file, "holds no pose; expected X_recording_upright, four rows of four numbers"); };
  if (!json.is_object() || !json.contains("X_recording_upright")) refuse();
  const auto& rows = json["X_recording_upright"];
  if (!rows.is_array() || rows.size() != 4) refuse();
  for (int row = 0; row < 4; ++row) {
    const auto& values = rows[static_cast<std::size_t>(row)];
    if (!values.is_array() || values.size() != 4) refuse();
    for (int column = 0; column < 4; ++column) {
      const auto& value = values[static_cast<std::size_t>(column)];
      if (!value.is_number()) refuse();
      X_RU.matrix()(row, column) = value.get<double>();
    }
  }
  return orthonormalised(X_RU).inverse();
}

}  // namespace waretwin

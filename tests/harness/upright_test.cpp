#include "harness/score/upright.h"

#include <gtest/gtest.h>

#include "core/files.h"
#include "tests/support/expect_error.h"
#include "tests/support/test_data.h"

namespace waretwin {
namespace {

TEST(Upright, IsTheInverseOfWhatTheFolderHolds) {
  const test::TemporaryFolder folder;
  EXPECT_TRUE(upright_from_recording(folder.path()).isApprox(Pose::Identity()));
  // A quarter turn about x, and a shift.
  write_file(folder.path() / "upright.json", R"({"X_recording_upright": [[1, 0, 0, 1], [0, 0, -1, 2], [0, 1, 0, 3], [0, 0, 0, 1]]})");
  const Eigen::Vector3d p_U = upright_from_recording(folder.path()) * Eigen::Vector3d(1, 2, 4);
  EXPECT_TRUE(p_U.isApprox(Eigen::Vector3d(0, 1, 0))) << p_U.transpose();
}

TEST(Upright, SaysWhatIsNoPose) {
  const test::TemporaryFolder folder;
  const auto write = [&](const std::string& text) { write_file(folder.path() / "upright.json", text); };
  write("{\n\"X_recording_upright\": ]");
  EXPECT_ERROR(upright_from_recording(folder.path()), "upright.json:2: is not JSON: it goes wrong at ']'; expected X_recording_upright");
  for (const char* text : {"[]", "{}", R"({"X_recording_upright": [1, 2, 3, 4]})", R"({"X_recording_upright": [[1, 0, 0, 0]]})",
                           R"({"X_recording_upright": [[1, 0, 0, 1], [0, 0, "a", 2], [0, 1, 0, 3], [0, 0, 0, 1]]})"}) {
    write(text);
    EXPECT_ERROR(upright_from_recording(folder.path()), "upright.json: holds no pose; expected X_recording_upright, four rows");
  }
}

}  // namespace
}  // namespace waretwin

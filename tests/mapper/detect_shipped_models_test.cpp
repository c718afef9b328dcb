#include <gtest/gtest.h>

#include <cstdlib>

#include "core/files.h"
#include "mapper/detect/model_files.h"
#include "mapper/detect/shipped_models.h"
#include "tests/support/expect_error.h"
#include "tests/support/test_data.h"

namespace waretwin {
namespace {

// Names a folder of models for one test.
class ShippedModels : public ::testing::Test {
 protected:
  void SetUp() override { ::setenv("WARETWIN_MODELS", folder_.path().c_str(), 1); }
  void TearDown() override { ::unsetenv("WARETWIN_MODELS"); }
  void write_model(const std::string& name) {
    make_folder(folder_.path() / name);
    for (const char* ending : {".cfg", ".weights", ".names"}) write_file(folder_.path() / name / (name + ending), "x\n");
  }
  test::TemporaryFolder folder_;
};

TEST_F(ShippedModels, AreFoundByName) {
  write_model("pallet");
  write_model("conveyor-v1.2");
  make_folder(folder_.path() / "empty");
  write_file(folder_.path() / "README.md", "text");
  EXPECT_EQ(shipped_model_names(), (std::vector<std::string>{"conveyor-v1.2", "pallet"}));
  EXPECT_EQ(shipped_model("pallet"), folder_.path() / "pallet");
  EXPECT_TRUE(is_shipped_model("conveyor-v1.2"));
  EXPECT_FALSE(is_shipped_model("empty"));
  const ModelFiles files = find_model_files("pallet", {});
  EXPECT_EQ(files.cfg, folder_.path() / "pallet/pallet.cfg");
  EXPECT_EQ(files.names, folder_.path() / "pallet/pallet.names");
  EXPECT_ERROR(shipped_model("palet"), "'palet'", "conveyor-v1.2, pallet");
  EXPECT_ERROR(find_model_files("palet", {}), "'palet'", "conveyor-v1.2, pallet");
}

TEST_F(ShippedModels, WhereNoneIsNamedItIsTheUsualOne) {
  EXPECT_EQ(model_or_shipped("some/model.onnx"), "some/model.onnx");
  EXPECT_ERROR(model_or_shipped(""), "'conveyor'");
  write_model("conveyor");
  EXPECT_EQ(model_or_shipped(""), folder_.path() / "conveyor");
}

TEST_F(ShippedModels, PathsAreNoNames) {
  for (const char* path : {"a/pallet", "./pallet", "pallet/", "pallet.onnx", "pallet.cfg", "pallet.weights", ".", "..", ""}) {
    EXPECT_FALSE(may_be_shipped_model(path)) << path;
  }
  EXPECT_TRUE(may_be_shipped_model("pallet"));
  EXPECT_ERROR(find_model_files("./pallet", {}), "no such model");
}

TEST_F(ShippedModels, AFolderThatIsNoneIsAnError) {
  ::setenv("WARETWIN_MODELS", (folder_.path() / "none").c_str(), 1);
  EXPECT_ERROR(shipped_model("pallet"), "WARETWIN_MODELS", "none");
  ::setenv("WARETWIN_MODELS", "", 1);  // as if it were not set
  EXPECT_EQ(shipped_models_folder(), test::repository() / "mapper/detect/models");
}

}  // namespace
}  // namespace waretwin

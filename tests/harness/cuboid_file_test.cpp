#include "harness/score/cuboid_file.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/files.h"
#include "tests/harness/score_fixtures.h"
#include "tests/support/test_data.h"

namespace waretwin {
namespace {

class CuboidFile : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& text) {
    const auto file = folder_.path() / "cuboids.json";
    write_file(file, text);
    return file;
  }
  std::string message(const std::string& text) {
    try {
      read_object_list(write(text));
    } catch (const Error& e) {
      return e.what();
    }
    return "no error";
  }
  test::TemporaryFolder folder_;
};

TEST_F(CuboidFile, ReadsTheFormOfTheContract) {
  const auto list = read_object_list(write(R"({"frame":"world","objects":[
      {"id":3,"class":"conveyor","centre":[1,2,0.5],"yaw":0.25,"size":[1,2,1],"score":0.75}]})"));
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0].id, 3);
  EXPECT_EQ(list[0].class_name, "conveyor");
  EXPECT_EQ(list[0].score, 0.75);
  EXPECT_EQ(list[0].visible_fraction, 1.0);
  EXPECT_GE(list[0].cuboid.size.x(), list[0].cuboid.size.y()) << "canonical";
  EXPECT_EQ(list[0].cuboid.frame, "world");
}

TEST_F(CuboidFile, ReadsBackWhatItWrites) {
  ListedObject truth = test::object(4, "rack", 1.25, -2.5, 30.0);
  truth.visible_fraction = 0.8125;
  const auto list = read_object_list(write(truth_json({truth})));
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0].id, 4);
  EXPECT_EQ(list[0].visible_fraction, 0.8125);
  EXPECT_NEAR(iou_3d(list[0].cuboid, truth.cuboid), 1.0, 1e-9);
}

TEST_F(CuboidFile, NamesWhatIsWrong) {
  const std::string file = (folder_.path() / "cuboids.json").string();
  const std::string expected = "; expected an object with a list 'objects'";
  EXPECT_EQ(message("{"), file + ":1: is not JSON: it ends too early" + expected);
  EXPECT_EQ(message(""), file + ":1: is not JSON: it ends too early" + expected);
  EXPECT_EQ(message("{\"objects\": [\n  {\"id\": 1,}\n]}"), file + ":2: is not JSON: it goes wrong at '}'" + expected);
  EXPECT_EQ(message("{'objects': []}"), file + ":1: is not JSON: it goes wrong at ''objects': []}'" + expected);
  EXPECT_EQ(message("{\"objects\": [1e999]}"), file + ": is not JSON that can be read: it holds a number that is out of range" + expected);
  EXPECT_NE(message("{}").find("key 'objects' is missing"), std::string::npos);
  EXPECT_NE(message("[]").find("expected a JSON object"), std::string::npos);
  EXPECT_NE(message(R"({"objects":[{"id":1}]})").find("objects[0]: key 'class' is missing"), std::string::npos);
  const std::string head = R"({"objects":[{"id":1,"class":"c","yaw":0,"centre":[0,0,0],)";
  EXPECT_NE(message(head + R"("size":[1,-1,1]}]})").find("negative"), std::string::npos);
  EXPECT_NE(message(head + R"("size":[1,1e200,1]}]})").find("objects[0]: 'size' is beyond 1e9, expected metres"), std::string::npos);
  EXPECT_NE(message(head + R"("size":[1,1]}]})").find("not a list of 3 numbers"), std::string::npos);
  EXPECT_NE(message(head + R"("size":[1,1,1],"score":1.5}]})").find("expected 0 to 1"), std::string::npos);
  const std::string one = R"({"id":1,"class":"c","yaw":0,"centre":[0,0,0],"size":[1,1,1]})";
  EXPECT_NE(message("{\"objects\":[" + one + "," + one + "]}").find("id 1 stands twice"), std::string::npos);
}

TEST_F(CuboidFile, FindsTheFileInARunsFolder) {
  const auto file = write("{}");
  EXPECT_EQ(file_or_in_folder(folder_.path(), "cuboids.json"), file);
  EXPECT_EQ(file_or_in_folder(file, "cuboids.json"), file);
  EXPECT_THROW(file_or_in_folder(folder_.path(), "truth.json"), Error);
  EXPECT_THROW(file_or_in_folder(folder_.path() / "nowhere", "truth.json"), Error);
}

}  // namespace
}  // namespace waretwin

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/end_to_end/program.h"

namespace waretwin {
namespace {

namespace fs = std::filesystem;
using test::in_quotes;

nlohmann::json json_of(const fs::path& file) { return nlohmann::json::parse(read_file(file)); }

class DetectCommand : public ::testing::Test {
 protected:
  void SetUp() override { WARETWIN_NEED_DATA("yolo_fastest"); }

  // The photograph with boxes as a person draws them, and one picture of nothing at all.
  void write_set() {
    make_folder(path("set/images"));
    make_folder(path("set/labels"));
    fs::copy_file(model() / "dog.jpg", path("set/images/dog.jpg"));
    fs::copy_file(model() / "dog.jpg", path("set/images/copy.jpg"));
    write_file(path("set/set.names"), "bicycle\ndog\nunicorn\n");
    write_file(path("set/set.data"), "names = set.names\ntrain = train.txt\ntest = test.txt\n");
    write_file(path("set/train.txt"), "images/copy.jpg\n");
    write_file(path("set/test.txt"), "images/dog.jpg\n");
    write_file(path("set/labels/dog.txt"), "1 0.316 0.639 0.316 0.512\n0 0.446 0.477 0.58 0.521\n");
  }

  static fs::path model() { return test::shared_data("yolo_fastest"); }
  fs::path path(const std::string& name) const { return folder_.path() / name; }
  test::ProgramResult detect(const std::string& inputs, const std::string& out, const std::string& more = "",
                             const std::string& prefix = "") const {
    return test::waretwin("detect " + in_quotes(model()) + " " + inputs + " --out " + in_quotes(path(out)) + " --quiet " + more, prefix);
  }

  test::TemporaryFolder folder_;
};

TEST_F(DetectCommand, WritesWhatItFindsInPictures) {
  const std::string photograph = in_quotes(model() / "dog.jpg");
  const auto result = detect(photograph + " " + photograph, "out", "--set detect.confidence=0.3");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("dog 2"), std::string::npos) << result.out;
  const nlohmann::json pictures = json_of(path("out/detections.json"));
  ASSERT_EQ(pictures.size(), 2u);
  EXPECT_EQ(pictures[0]["file"], (model() / "dog.jpg").string());
  EXPECT_EQ(pictures[0]["size"], nlohmann::json({768, 576}));
  EXPECT_EQ(pictures[0]["detections"], pictures[1]["detections"]);
  double least = 1.0;
  bool dog = false;
  for (const auto& d : pictures[0]["detections"]) {
    least = std::min(least, d["score"].get<double>());
    dog = dog || d["class"] == "dog";
    EXPECT_EQ(d["box"].size(), 4u);
  }
  EXPECT_TRUE(dog);
  EXPECT_GE(least, 0.3);
  // Two pictures of one name are drawn apart.
  EXPECT_EQ(pictures[1]["picture"], "pictures/dog_2.jpg");
  EXPECT_TRUE(fs::exists(path("out/pictures/dog.jpg")));
  EXPECT_TRUE(fs::exists(path("out/pictures/dog_2.jpg")));
  EXPECT_FALSE(fs::exists(path("out/metrics.json")));
  // Again without pictures: none of the old ones stay.
  EXPECT_EQ(detect(photograph, "out", "--no-pictures").exit_code, 0);
  EXPECT_FALSE(fs::exists(path("out/pictures")));
  EXPECT_EQ(json_of(path("out/detections.json")).size(), 1u);
}

TEST_F(DetectCommand, ScoresALabelledSet) {
  write_set();
  const auto result = detect(in_quotes(path("set")), "out", "--set detect.confidence=0.3");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("AP50"), std::string::npos) << result.out;
  const nlohmann::json metrics = json_of(path("out/metrics.json"));
  EXPECT_EQ(metrics["split"], "test");
  EXPECT_EQ(metrics["images"], 1);
  EXPECT_EQ(metrics["labels"], 2);
  EXPECT_NEAR(metrics["ap50"].get<double>(), 1.0, 1e-9);
  EXPECT_NEAR(metrics["recall"].get<double>(), 1.0, 1e-9);
  EXPECT_GT(metrics["ap"].get<double>(), 0.1);
  EXPECT_LT(metrics["ap"].get<double>(), 1.0);
  EXPECT_GT(metrics["median_ms"].get<double>(), 0.0);
  EXPECT_GT(metrics["other_detections"].get<int>(), 0);  // the car
  EXPECT_EQ(metrics["classes"].size(), 3u);
  // The weak ones are for AP alone.
  for (const auto& d : json_of(path("out/detections.json"))[0]["detections"]) EXPECT_GE(d["score"].get<double>(), 0.3);

  // All classes but the dog are left out; its name is changed to one that the set knows.
  const auto renamed = detect(in_quotes(path("set/set.data")), "renamed",
                              "--split all --set detect.confidence=0.3 --set 'detect.rename=[dog=unicorn]' "
                              "--set 'detect.classes=[unicorn]'");
  EXPECT_EQ(renamed.exit_code, 0) << renamed.err;
  const nlohmann::json other = json_of(path("renamed/metrics.json"));
  EXPECT_EQ(other["images"], 2);
  EXPECT_EQ(other["labels"], 0);
  EXPECT_TRUE(other["ap50"].is_null());
  EXPECT_EQ(other["precision"], 0.0);
}

TEST_F(DetectCommand, GivesTheSameBytesAtAnyNumberOfThreads) {
  write_set();
  for (const char* threads : {"1", "2"}) {
    EXPECT_EQ(detect(in_quotes(path("set")), threads, "--split all --threads " + std::string(threads)).exit_code, 0);
  }
  EXPECT_EQ(read_file(path("1/detections.json")), read_file(path("2/detections.json")));
  EXPECT_EQ(read_file(path("1/pictures/dog.jpg")), read_file(path("2/pictures/dog.jpg")));
}

TEST_F(DetectCommand, PlacingIsConfiguration) {
  const std::string photograph = in_quotes(model() / "dog.jpg");
  EXPECT_EQ(detect(photograph, "stretched").exit_code, 0);
  EXPECT_EQ(detect(photograph, "boxed", "--set detect.letterbox=on").exit_code, 0);
  EXPECT_EQ(detect(photograph, "small", "--set detect.input_width=224 --set detect.input_height=224").exit_code, 0);
  const std::string stretched = read_file(path("stretched/detections.json"));
  EXPECT_NE(read_file(path("boxed/detections.json")), stretched);
  EXPECT_NE(read_file(path("small/detections.json")), stretched);
}

TEST_F(DetectCommand, TakesAShippedModelByName) {
  make_folder(path("models/dogs"));
  for (const char* ending : {".cfg", ".weights"}) {
    fs::copy_file(model() / ("yolo-fastest-1.1" + std::string(ending)), path("models/dogs/dogs" + std::string(ending)));
  }
  fs::copy_file(model() / "coco.names", path("models/dogs/dogs.names"));
  const std::string models = "WARETWIN_MODELS=" + in_quotes(path("models"));
  const std::string rest = in_quotes(model() / "dog.jpg") + " --quiet --out " + in_quotes(path("out"));
  EXPECT_EQ(test::waretwin("detect dogs " + rest, models).exit_code, 0);
  EXPECT_GT(json_of(path("out/detections.json"))[0]["detections"].size(), 0u);
  EXPECT_ONE_LINE(test::waretwin("detect cats " + rest, models), "one of dogs");
  EXPECT_ONE_LINE(test::waretwin("map " + in_quotes(path("none")) + " --out o --detector dogs", models), "none");
  EXPECT_ONE_LINE(test::waretwin("map " + in_quotes(path("none")) + " --out o --detector cats", models), "shipped name");
}

TEST_F(DetectCommand, BadInputEndsInOneLineAndLeavesWhatWasThere) {
  write_set();
  const std::string photograph = in_quotes(model() / "dog.jpg");
  EXPECT_EQ(detect(photograph, "out").exit_code, 0);
  const std::string before = read_file(path("out/detections.json"));
  write_file(path("text.jpg"), "no picture");
  EXPECT_ONE_LINE(detect(photograph + " " + in_quotes(path("text.jpg")), "out"), "text.jpg");
  EXPECT_EQ(read_file(path("out/detections.json")), before);
  EXPECT_EQ(std::distance(fs::directory_iterator(path("out")), fs::directory_iterator()), 2);  // nothing half made is left
  EXPECT_ONE_LINE(detect(in_quotes(path("none.jpg")), "o"), "no such file");
  EXPECT_ONE_LINE(detect(in_quotes(path("set/labels")), "o"), "no pictures");
  EXPECT_ONE_LINE(detect(in_quotes(path("set")), "o", "--split valid"), "'valid'");
  EXPECT_ONE_LINE(detect(in_quotes(path("set")), "o", "--split everything"), "everything");
  EXPECT_ONE_LINE(detect(photograph, "o", "--split test"), "--split test");
  EXPECT_ONE_LINE(detect(photograph, "o", "--set detect.confidense=1"), "detect.confidence");
  EXPECT_ONE_LINE(detect(photograph, "o", "--set detect.confidence=2"), "detect.confidence");
  EXPECT_ONE_LINE(detect("", "o"), "DATASET");
  EXPECT_ONE_LINE(test::waretwin("detect nothing " + photograph + " --out " + in_quotes(path("o"))), "'nothing'");
  // A set that the model knows nothing of.
  write_file(path("set/set.names"), "cog\nicicle\nunicorn\n");
  EXPECT_ONE_LINE(detect(in_quotes(path("set")), "o"), "none in common");
  // Nobody's own pictures are replaced.
  make_folder(path("album/pictures"));
  fs::copy_file(model() / "dog.jpg", path("album/pictures/dog.jpg"));
  EXPECT_ONE_LINE(detect(in_quotes(path("album/pictures")), "album"), "another --out");
  EXPECT_TRUE(fs::exists(path("album/pictures/dog.jpg")));
}

}  // namespace
}  // namespace waretwin

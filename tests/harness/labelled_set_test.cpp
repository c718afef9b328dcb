#include "harness/labelled/labelled_set.h"

#include <gtest/gtest.h>

#include "core/files.h"
#include "tests/support/expect_error.h"
#include "tests/support/test_data.h"

namespace waretwin {
namespace {

namespace fs = std::filesystem;

class LabelledSetTest : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) {
    make_folder((folder_.path() / name).parent_path());
    write_file(folder_.path() / name, text);
  }
  fs::path path(const std::string& name = "") const { return name.empty() ? folder_.path() : folder_.path() / name; }
  LabelledSet read(const std::string& split = "all") const { return read_labelled_set(path(), split); }

  // Pictures are not opened, so they hold nothing.
  void write_darknet() {
    write("set.data", "classes = 2\ntrain = train.txt\nvalid = valid.txt\nnames = set.names\nbackup = backup/\n");
    write("set.names", "conveyor\ntable leg\n\n");
    write("train.txt", "images/b.jpg\r\nimages/a.jpg\n");
    write("valid.txt", "\nimages/c.png\nimages/a.jpg\n");
    for (const char* name : {"images/a.jpg", "images/b.jpg", "images/c.png"}) write(name, "");
    write("labels/a.txt", "1 0.5 0.5 0.25 0.5\n0 0.25 0.75 0.5 0.5\r\n");
    write("images/c.txt", "0 0.5 0.5 1 1\n");
  }

  void write_coco(const std::string& name, const std::string& annotations, const std::string& more_images = "") {
    write(name, R"({"info": {}, "images": [{"id": 7, "file_name": "a.jpg", "width": 200, "height": 100})" + more_images +
                    R"(], "categories": [{"id": 9, "name": "late"}, {"id": 3, "name": "early"}], "annotations": [)" + annotations + "]}");
  }

  test::TemporaryFolder folder_;
};

TEST_F(LabelledSetTest, ReadsDarknetsLayout) {
  write_darknet();
  for (const fs::path& dataset : {path(), path("set.data")}) {
    EXPECT_TRUE(is_labelled_set(dataset));
    EXPECT_EQ(splits_of(dataset), (std::vector<std::string>{"train", "valid"}));
    const LabelledSet train = read_labelled_set(dataset, "train");
    EXPECT_EQ(train.classes, (std::vector<std::string>{"conveyor", "table leg"}));
    ASSERT_EQ(train.images.size(), 2u);
    EXPECT_EQ(train.images[0].name, "images/b.jpg");  // in the list's order
    EXPECT_TRUE(train.images[0].boxes.empty());       // no text file: no objects
    EXPECT_EQ(train.images[1].file, path("images/a.jpg"));
    ASSERT_EQ(train.images[1].boxes.size(), 2u);
    EXPECT_EQ(train.images[1].boxes[0].class_index, 1);
    EXPECT_EQ(train.images[1].boxes[0].share, cv::Rect2d(0.375, 0.25, 0.25, 0.5));
    EXPECT_EQ(train.images[1].boxes[1].share, cv::Rect2d(0.0, 0.5, 0.5, 0.5));
    EXPECT_FALSE(train.images[1].boxes[1].ignored);
    // Labels beside the picture; a picture of two lists comes once.
    const LabelledSet all = read_labelled_set(dataset, "all");
    ASSERT_EQ(all.images.size(), 3u);
    ASSERT_EQ(all.images[2].boxes.size(), 1u);
    EXPECT_EQ(all.images[2].boxes[0].share, cv::Rect2d(0, 0, 1, 1));
    EXPECT_EQ(read_labelled_set(dataset, "valid").images.size(), 2u);
  }
  EXPECT_ERROR(read("test"), "no split 'test'", "all, train, valid");
  EXPECT_ERROR(read("trian"), "'trian'", "train, valid, test, all");
}

TEST_F(LabelledSetTest, DarknetsMistakesEndInOneLine) {
  const auto expect = [&](const std::string& name, const std::string& text, std::initializer_list<std::string> parts) {
    write_darknet();
    write(name, text);
    EXPECT_TRUE(test::throws_error([&] { read(); }, parts)) << name;
  };
  expect("labels/a.txt", "0 0.5 0.5 0.1 0.1\n2 0.5 0.5 0.25 0.5\n", {"a.txt:2", "class 2", "0 to 1"});
  expect("labels/a.txt", "-1 0.5 0.5 0.25 0.5\n", {"a.txt:1", "class -1"});
  for (const char* line : {"0 0.5 0.5 0.25", "0 0.5 0.5 0.25 0.5 0.9", "0 0.5 0.5 x 0.5", "0 nan 0.5 0.5 0.5", "0 0.5 inf 0.5 0.5",
                           "1.0 0.5 0.5 0.5 0.5", "0 1e999 0.5 0.5 0.5", "99999999999 0.5 0.5 0.5 0.5", "0 0x1p-1 0.5 0.5 0.5"}) {
    expect("labels/a.txt", line, {"a.txt:1", "CLASS CX CY W H"});
  }
  for (const char* line : {"0 0.5 0.5 0 0.5", "0 0.5 0.5 0.5 -0.5", "0 1.5 0.5 0.5 0.5", "0 320 240 100 100", "0 0.5 0.5 0.5 1.01"}) {
    expect("labels/a.txt", line, {"a.txt:1", "is no box"});
  }
  expect("valid.txt", "images/a.jpg\nimages/none.jpg\n", {"valid.txt:2", "images/none.jpg"});
  expect("set.names", "conveyor\n\ntable\n", {"set.names:2", "blank"});
  expect("set.names", "conveyor\nconveyor\n", {"set.names:2", "twice"});
  expect("set.names", "conveyor\n", {"set.data:1", "classes", "expected 1"});
  expect("set.data", "train = train.txt\n", {"set.data", "names"});
  expect("set.data", "names = set.names\n", {"set.data", "no pictures"});
  expect("set.data", "names = set.names\ntrain\n", {"set.data:2", "train"});
  expect("set.data", "names = set.names\ntrain =\n", {"set.data:2", "'train' is empty"});
  expect("set.data", "names = set.names\nnames = set.names\n", {"set.data:2", "twice"});
  expect("set.data", "names = set.names\ntrain = none.txt\n", {"none.txt", "no such file"});
  expect("set.data", "names = set.names\ntrain = set.names\n", {"set.names:1", "no picture 'conveyor'"});
  write_darknet();
  write("other.data", "");
  EXPECT_ERROR(read(), "other.data", "set.data");
}

TEST_F(LabelledSetTest, BoxesAreCutOffAtThePicturesEdges) {
  write_darknet();
  write("labels/a.txt", "0 0.1 0.5 0.4 0.5\n0 1 1 0.5 0.5\n");
  const LabelledSet set = read("train");
  const std::vector<LabelledBox>& boxes = set.images[1].boxes;
  ASSERT_EQ(boxes.size(), 2u);
  EXPECT_EQ(boxes[0].share.x, 0.0);
  EXPECT_NEAR(boxes[0].share.width, 0.3, 1e-15);
  EXPECT_EQ(boxes[1].share, cv::Rect2d(0.75, 0.75, 0.25, 0.25));
}

TEST_F(LabelledSetTest, ReadsLoosePictures) {
  write("b.JPG", "");
  write("images/c.png", "");
  write("images/a.jpeg", "");
  write("b.txt", "0 0.5 0.5 0.5 0.5");
  write("labels/c.txt", "0 0.5 0.5 0.25 0.25\n\n");
  EXPECT_FALSE(is_labelled_set(path()));
  EXPECT_ERROR(read(), "no labelled set", "classes.txt");
  write("images/classes.txt", "conveyor\n");
  EXPECT_TRUE(is_labelled_set(path()));
  EXPECT_TRUE(splits_of(path()).empty());
  const LabelledSet set = read();
  ASSERT_EQ(set.images.size(), 3u);
  EXPECT_EQ(set.images[0].name, "b.JPG");
  EXPECT_EQ(set.images[0].boxes.size(), 1u);
  EXPECT_EQ(set.images[1].name, "images/a.jpeg");
  EXPECT_TRUE(set.images[1].boxes.empty());
  EXPECT_EQ(set.images[2].boxes.size(), 1u);
  EXPECT_ERROR(read("train"), "no split 'train'", "expected all");
  write("my.names", "conveyor\n");
  EXPECT_ERROR(read(), "my.names", "classes.txt");
}

TEST_F(LabelledSetTest, ReadsCoco) {
  for (const char* name : {"a.jpg", "images/b.jpg"}) write(name, "");
  write_coco("set.json",
             R"({"image_id": 8, "category_id": 9, "bbox": [10, 20, 100.5, 40], "area": 1000, "segmentation": [[1, 2, 3]]},
                {"image_id": 7, "category_id": 3, "bbox": [0, 0, 200, 100], "iscrowd": 1},
                {"image_id": 7, "category_id": 9, "bbox": [5, 5, 0, 3]},
                {"image_id": 7, "category_id": 9, "bbox": [190, 5, 20, 5], "ignore": 0})",
             R"(, {"id": 8, "file_name": "b.jpg", "width": 400, "height": 200})");
  EXPECT_TRUE(is_labelled_set(path("set.json")));
  EXPECT_TRUE(splits_of(path("set.json")).empty());
  const LabelledSet set = read_labelled_set(path("set.json"), "all");
  EXPECT_EQ(set.classes, (std::vector<std::string>{"early", "late"}));  // in the order of their ids
  ASSERT_EQ(set.images.size(), 2u);
  EXPECT_EQ(set.images[0].name, "a.jpg");
  EXPECT_EQ(set.images[1].file, path("images/b.jpg"));
  ASSERT_EQ(set.images[1].boxes.size(), 1u);
  const LabelledBox& box = set.images[1].boxes[0];
  EXPECT_EQ(box.class_index, 1);
  EXPECT_FALSE(box.ignored);
  EXPECT_EQ(box.share, cv::Rect2d(10.0 / 400, 20.0 / 200, 100.5 / 400, 40.0 / 200));
  EXPECT_EQ(box.area, 1000.0 / (400 * 200));
  ASSERT_EQ(set.images[0].boxes.size(), 2u);  // the one without width is left out
  EXPECT_TRUE(set.images[0].boxes[0].ignored);
  EXPECT_EQ(set.images[0].boxes[1].class_index, 1);
  EXPECT_NEAR(set.images[0].boxes[1].share.width, 0.05, 1e-15);
}

TEST_F(LabelledSetTest, ReadsCocoBySplits) {
  write("a.jpg", "");
  write("val2017/b.jpg", "");
  write_coco("annotations/instances_train2017.json", "");
  write_coco("annotations/captions_train2017.json", R"({"image_id": 7, "caption": "a hall"})");
  write("annotations/instances_val2017.json",
        R"({"images": [{"id": 1, "file_name": "b.jpg", "width": 20, "height": 10}], "annotations": [],
            "categories": [{"id": 9, "name": "late"}, {"id": 3, "name": "early"}]})");
  EXPECT_EQ(splits_of(path()), (std::vector<std::string>{"train", "valid"}));
  EXPECT_EQ(read("train").images.size(), 1u);
  EXPECT_EQ(read("valid").images.at(0).file.filename(), "b.jpg");
  EXPECT_EQ(read("all").images.size(), 2u);
  write_coco("annotations/other_val.json", "");
  write_coco("annotations/another_val.json", "");
  fs::remove(path("annotations/instances_val2017.json"));
  EXPECT_ERROR(read("valid"), "other_val.json", "another_val.json");
}

TEST_F(LabelledSetTest, CocosMistakesEndInOneLine) {
  write("a.jpg", "");
  const auto expect = [&](const std::string& annotation, std::initializer_list<std::string> parts) {
    write_coco("set.json", annotation);
    EXPECT_TRUE(test::throws_error([&] { read_labelled_set(path("set.json"), "all"); }, parts)) << annotation;
  };
  expect("5", {"annotations[0]", "expected an object"});
  expect(R"({"image_id": 1, "category_id": 3, "bbox": [0, 0, 1, 1]})", {"annotations[0]", "image_id 1"});
  expect(R"({"image_id": 7, "category_id": 1, "bbox": [0, 0, 1, 1]})", {"annotations[0]", "category_id 1"});
  expect(R"({"image_id": 7, "category_id": 3})", {"'bbox' is missing"});
  for (const char* bbox : {"[0, 0, 1]", "[0, 0, -1, 1]", "[0, 0, \"1\", 1]", "[0, 0, 1e300, 1]", "[0, 0, null, 1]", "{}"}) {
    expect(R"({"image_id": 7, "category_id": 3, "bbox": )" + std::string(bbox) + "}", {"'bbox'", "[x, y, width, height]"});
  }
  expect(R"({"image_id": 7, "category_id": 3, "bbox": [300, 0, 10, 10]})", {"outside its picture"});
  expect(R"({"image_id": 7, "category_id": 3, "bbox": [0, 0, 10, 10], "iscrowd": 2})", {"'iscrowd' is 2"});
  expect(R"({"image_id": 7, "category_id": 3, "bbox": [0, 0, 10, 10], "area": -2})", {"'area' is -2"});
  expect(R"({"image_id": 7, "category_id": 3, "bbox": [0, 0, 1e999, 10]})", {"not JSON"});
  const auto whole = [&](const std::string& text, std::initializer_list<std::string> parts) {
    write("set.json", text);
    EXPECT_TRUE(test::throws_error([&] { read_labelled_set(path("set.json"), "all"); }, parts)) << text;
  };
  whole("", {"set.json", "not JSON"});
  whole("[]", {"expected an object with 'categories'"});
  whole(std::string(100, '[') + std::string(100, ']'), {"levels"});
  const std::string categories = R"("categories": [{"id": 1, "name": "c"}], "annotations": [])";
  whole(R"({"categories": [], "images": [], "annotations": []})", {"'categories' is empty"});
  whole(R"({"categories": [{"id": 1, "name": "c"}, {"id": 1, "name": "d"}], "images": [], "annotations": []})", {"id 1", "twice"});
  whole(R"({"categories": [{"id": 1, "name": "c"}, {"id": 2, "name": "c"}], "images": [], "annotations": []})", {"'c'", "twice"});
  whole(R"({"images": [], )" + categories + "}", {"no pictures"});
  whole(R"({"images": [{"id": 1, "file_name": "none.jpg", "width": 5, "height": 5}], )" + categories + "}", {"images[0]", "none.jpg"});
  whole(R"({"images": [{"id": 1, "file_name": "a.jpg", "width": 0, "height": 5}], )" + categories + "}", {"images[0]", "'width' is 0"});
  whole(R"({"images": [{"id": 1.5, "file_name": "a.jpg", "width": 5, "height": 5}], )" + categories + "}", {"'id' is 1.5"});
  EXPECT_ERROR(read_labelled_set(path("none"), "all"), "does not exist");
  EXPECT_ERROR(read_labelled_set(path("a.jpg"), "all"), "no labelled set");
}

}  // namespace
}  // namespace waretwin

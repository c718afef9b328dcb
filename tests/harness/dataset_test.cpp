// Training pictures: what stands in the files is what the hall shows, and nothing but the configuration decides about the bytes.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <set>
#include <stdexcept>

#include "core/checksum.h"
#include "core/files.h"
#include "core/parallel.h"
#include "harness/dataset/appearance.h"
#include "harness/dataset/dataset_maker.h"
#include "harness/dataset/hall_heights.h"
#include "harness/dataset/hall_photographer.h"
#include "harness/dataset/image_record.h"
#include "harness/dataset/things.h"
#include "harness/dataset/view_sampler.h"
#include "harness/labelled/labelled_set.h"
#include "sim/motion/hall_motion.h"
#include "tests/support/coco_masks.h"
#include "tests/support/expect_error.h"
#include "tests/support/test_data.h"

namespace waretwin {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

DatasetConfig small_set() {
  DatasetConfig config;
  config.seed = 5;
  config.count = 14;
  config.images_per_hall = 4;
  config.valid_share = config.test_share = 0.25;
  config.labels.min_side_px = 8;
  config.views.least_share = 0.01;
  config.instances = true;
  config.depth = true;
  return config;
}

std::vector<std::unique_ptr<HallSource>> small_halls(std::uint64_t seed = 5) {
  std::vector<std::unique_ptr<HallSource>> sources;
  sources.push_back(generated_source("flat", seed, {{"sensors.cameras.camera.width", "192"}, {"sensors.cameras.camera.height", "108"}}));
  return sources;
}

std::map<std::string, std::string> files_of(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) files[fs::relative(entry.path(), folder).generic_string()] = sha256(read_file(entry.path()));
  }
  return files;
}

struct Stop : std::runtime_error {
  Stop() : std::runtime_error("stop") {}
};

TEST(Dataset, GivesTheSameBytesHoweverItIsMade) {
  const test::TemporaryFolder folder;
  const DatasetConfig config = small_set();
  set_thread_count(1);
  const DatasetSummary whole = make_dataset(config, small_halls(), folder.path() / "one", {}, {});
  EXPECT_EQ(whole.images, config.count);
  const auto expected = files_of(folder.path() / "one");
  set_thread_count(4);
  make_dataset(config, small_halls(), folder.path() / "four", {}, {});
  set_thread_count(0);
  EXPECT_EQ(files_of(folder.path() / "four"), expected);

  const fs::path shards = folder.path() / "shards";
  EXPECT_EQ(make_dataset(config, small_halls(), shards, {}, {1, 3}).missing_halls, 3);
  EXPECT_EQ(make_dataset(config, small_halls(), shards, {}, {0, 3}).missing_halls, 1);
  EXPECT_FALSE(fs::exists(shards / "manifest.json"));
  EXPECT_EQ(make_dataset(config, small_halls(), shards, {}, {2, 3}).missing_halls, 0);
  EXPECT_EQ(files_of(shards), expected);

  const fs::path stopped = folder.path() / "stopped";
  for (const int at : {2, 3, 6}) {
    int steps = 0;
    const auto stop = [&](const DatasetProgress&) {
      if (++steps == at) throw Stop();
    };
    EXPECT_THROW(make_dataset(config, small_halls(), stopped, {}, {}, stop), Stop);
  }
  make_dataset(config, small_halls(), stopped, {}, {});
  EXPECT_EQ(files_of(stopped), expected);

  DatasetConfig other = config;
  other.seed = 6;
  make_dataset(other, small_halls(), folder.path() / "other", {}, {});
  EXPECT_NE(files_of(folder.path() / "other").at("images/000003.jpg"), expected.at("images/000003.jpg"));
}

class MadeSet : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new test::TemporaryFolder();
    summary_ = make_dataset(small_set(), small_halls(), set(), {}, {});
  }
  static void TearDownTestSuite() { delete folder_; }
  static fs::path set() { return folder_->path() / "set"; }

  static test::TemporaryFolder* folder_;
  static DatasetSummary summary_;
};
test::TemporaryFolder* MadeSet::folder_ = nullptr;
DatasetSummary MadeSet::summary_;

TEST_F(MadeSet, BoxesAreTheExtentsOfMasksThatShareNoPixel) {
  int labels = 0, left_out = 0;
  for (int number = 0; number < 4; ++number) {
    const HallRecord record = read_hall_record(set() / record_name(number));
    for (const ImageRecord& image : record.images) {
      SCOPED_TRACE(image.name);
      const cv::Mat ids = cv::imread((set() / "instances" / (image.name + ".png")).string(), cv::IMREAD_UNCHANGED);
      ASSERT_EQ(ids.type(), CV_16UC1);
      std::set<int> named;
      for (const ImageLabel& label : image.labels.labels) {
        const cv::Mat mask = ids == label.object_id;
        EXPECT_EQ(cv::boundingRect(mask), label.box);
        EXPECT_EQ(cv::countNonZero(mask), label.area_px);
        EXPECT_GE(label.visible, 0.3);
        EXPECT_GE(std::max(label.box.width, label.box.height), 8);
        EXPECT_EQ((label.amodal_box & label.box), label.box) << "what is visible is part of the whole";
        EXPECT_NEAR(label.visible, (1 - label.occluded) * (1 - label.truncated), 1e-9);
        EXPECT_TRUE(named.insert(label.object_id).second);
        ++labels;
      }
      for (const LeftOut& object : image.labels.left_out) {
        EXPECT_EQ(cv::boundingRect(ids == object.object_id), object.box);
        EXPECT_EQ(object.why == LeftOut::Why::kSmall, std::max(object.box.width, object.box.height) < 8);
        EXPECT_TRUE(named.insert(object.object_id).second);
        ++left_out;
      }
      for (int v = 0; v < ids.rows; ++v) {
        for (int u = 0; u < ids.cols; ++u) {
          const int id = ids.at<std::uint16_t>(v, u);
          ASSERT_TRUE(id == 0 || named.contains(id)) << "an object that nobody speaks of";
        }
      }
      if (image.kind == "empty") {
        EXPECT_TRUE(named.empty());
      }
    }
  }
  EXPECT_EQ(labels, summary_.labels.at(0));
  EXPECT_EQ(left_out, summary_.hidden + summary_.small);
  EXPECT_GT(labels, 5);
}

TEST_F(MadeSet, DarknetListsNameEachPictureOnce) {
  std::map<std::string, std::string> split_of;
  for (const std::string split : {"train", "valid", "test"}) {
    std::ifstream list(set() / (split + ".txt"));
    for (std::string line; std::getline(list, line);) {
      EXPECT_TRUE(fs::exists(set() / line)) << line;
      EXPECT_TRUE(split_of.emplace(line, split).second) << line;
    }
  }
  EXPECT_EQ(split_of.size(), 14u);
  EXPECT_EQ(read_file(set() / "dataset.names"), "conveyor\n");
  EXPECT_EQ(read_file(set() / "dataset.data"),
            "classes = 1\ntrain = train.txt\nvalid = valid.txt\ntest = test.txt\nnames = dataset.names\n");
  for (int number = 0; number < 4; ++number) {
    const HallRecord record = read_hall_record(set() / record_name(number));
    for (const ImageRecord& image : record.images) {
      EXPECT_EQ(split_of.at("images/" + image.name + ".jpg"), record.split) << "one hall, one split";
      std::ifstream lines(set() / "labels" / (image.name + ".txt"));
      for (const ImageLabel& label : image.labels.labels) {
        int class_index = -1;
        double cx = 0, cy = 0, w = 0, h = 0;
        ASSERT_TRUE(lines >> class_index >> cx >> cy >> w >> h) << image.name;
        EXPECT_EQ(class_index, 0);
        EXPECT_NEAR((cx - 0.5 * w) * 192, label.box.x, 1e-4);
        EXPECT_NEAR((cy - 0.5 * h) * 108, label.box.y, 1e-4);
        EXPECT_NEAR(w * 192, label.box.width, 1e-4);
        EXPECT_NEAR(h * 108, label.box.height, 1e-4);
      }
      int more = 0;
      EXPECT_FALSE(lines >> more) << image.name;
    }
  }
}

// What COCO's own reader relies on (cocodataset.org, "Data format").
TEST_F(MadeSet, CocoFilesHoldWhatReadersNeed) {
  std::size_t images = 0, annotations = 0, left_out = 0;
  for (const std::string split : {"train", "valid", "test"}) {
    const Json coco = Json::parse(read_file(set() / "annotations" / ("instances_" + split + ".json")));
    std::map<int, Json> image_of;
    for (const Json& image : coco.at("images")) {
      EXPECT_TRUE(image_of.emplace(image.at("id").get<int>(), image).second);
      const cv::Mat picture = cv::imread((set() / "images" / image.at("file_name").get<std::string>()).string());
      EXPECT_EQ(picture.cols, image.at("width").get<int>());
      EXPECT_EQ(picture.rows, image.at("height").get<int>());
      EXPECT_EQ(image.at("intrinsics").size(), 4u);
      EXPECT_EQ(image.at("X_WC").size(), 7u);
    }
    ASSERT_EQ(coco.at("categories").size(), 1u);
    EXPECT_EQ(coco.at("categories").at(0).at("id"), 1);
    EXPECT_EQ(coco.at("categories").at(0).at("name"), "conveyor");
    std::set<int> ids;
    for (const Json& annotation : coco.at("annotations")) {
      EXPECT_TRUE(ids.insert(annotation.at("id").get<int>()).second);
      EXPECT_GT(annotation.at("id").get<int>(), 0);
      const Json& image = image_of.at(annotation.at("image_id").get<int>());
      EXPECT_EQ(annotation.at("category_id"), 1);
      EXPECT_EQ(annotation.at("iscrowd"), 0);
      const auto box = annotation.at("bbox").get<std::vector<double>>();
      EXPECT_GE(box.at(0), 0);
      EXPECT_GE(box.at(1), 0);
      EXPECT_LE(box.at(0) + box.at(2), image.at("width").get<double>());
      EXPECT_LE(box.at(1) + box.at(3), image.at("height").get<double>());
      EXPECT_LE(annotation.at("area").get<double>(), box.at(2) * box.at(3));
      for (const Json& polygon : annotation.at("segmentation")) {
        EXPECT_GE(polygon.size(), 6u);
        EXPECT_EQ(polygon.size() % 2, 0u);
      }
      const cv::Size size(image.at("width"), image.at("height"));
      EXPECT_EQ(annotation.at("rle").at("size"), (Json{size.height, size.width}));
      const std::string name = fs::path(image.at("file_name").get<std::string>()).stem();
      const cv::Mat mask =
          cv::imread((set() / "instances" / (name + ".png")).string(), cv::IMREAD_UNCHANGED) == annotation.at("object").get<int>();
      EXPECT_EQ(cv::norm(test::from_runs(test::read_runs(annotation.at("rle").at("counts")), size), mask, cv::NORM_INF), 0.0);
      // Polygons leave out points up to a pixel from the line, of small objects, too.
      const cv::Mat filled = test::filled(annotation.at("segmentation"), size);
      EXPECT_LT(cv::countNonZero(filled != mask), 0.25 * annotation.at("area").get<double>() + 12) << name;
      EXPECT_EQ(annotation.at("amodal_bbox").size(), 4u);
      for (const char* share : {"visible", "occluded", "truncated"}) {
        EXPECT_GE(annotation.at(share).get<double>(), 0.0);
        EXPECT_LE(annotation.at(share).get<double>(), 1.0);
      }
    }
    for (const Json& object : coco.at("left_out")) EXPECT_TRUE(image_of.contains(object.at("image_id").get<int>()));
    images += coco.at("images").size();
    annotations += coco.at("annotations").size();
    left_out += coco.at("left_out").size();
  }
  EXPECT_EQ(images, 14u);
  EXPECT_EQ(static_cast<int>(annotations), summary_.labels.at(0));
  EXPECT_EQ(static_cast<int>(left_out), summary_.hidden + summary_.small);
}

// The same boxes from both formats, by the reader that training and detection use.
TEST_F(MadeSet, ReadsBackAlikeFromBothFormats) {
  for (const std::string split : {"train", "valid", "test"}) {
    const LabelledSet darknet = read_labelled_set(set(), split);
    const LabelledSet coco = read_labelled_set(set() / "annotations" / ("instances_" + split + ".json"), "all");
    EXPECT_EQ(darknet.classes, coco.classes);
    ASSERT_EQ(darknet.images.size(), coco.images.size());
    for (std::size_t i = 0; i < coco.images.size(); ++i) {
      EXPECT_EQ(fs::weakly_canonical(darknet.images[i].file), fs::weakly_canonical(coco.images[i].file));
      ASSERT_EQ(darknet.images[i].boxes.size(), coco.images[i].boxes.size());
      for (std::size_t k = 0; k < coco.images[i].boxes.size(); ++k) {
        const LabelledBox &a = darknet.images[i].boxes[k], &b = coco.images[i].boxes[k];
        EXPECT_EQ(a.ignored, b.ignored);
        EXPECT_EQ(a.class_index, b.class_index);
        EXPECT_NEAR(a.share.x, b.share.x, 1e-6);
        EXPECT_NEAR(a.share.y, b.share.y, 1e-6);
        EXPECT_NEAR(a.share.width, b.share.width, 1e-6);
        EXPECT_NEAR(a.share.height, b.share.height, 1e-6);
      }
    }
  }
}

TEST_F(MadeSet, ChecksumsAreThoseOfTheFiles) {
  const Json manifest = Json::parse(read_file(set() / "manifest.json"));
  auto files = files_of(set());
  files.erase("SHA256SUMS");
  files.erase("manifest.json");
  EXPECT_EQ(manifest.at("sha256").get<decltype(files)>(), files);
  EXPECT_EQ(manifest.at("images"), 14);
  const std::string check = "cd '" + set().string() + "' && sha256sum --check --quiet --strict SHA256SUMS";
  EXPECT_EQ(std::system(check.c_str()), 0);
}

TEST_F(MadeSet, DepthIsInMillimetresAllOver) {
  const HallRecord record = read_hall_record(set() / record_name(0));
  for (const ImageRecord& image : record.images) {
    const cv::Mat depth = cv::imread((set() / "depth" / (image.name + ".png")).string(), cv::IMREAD_UNCHANGED);
    ASSERT_EQ(depth.type(), CV_16UC1);
    EXPECT_GT(cv::countNonZero(depth), depth.size().area() * 9 / 10) << "a closed room";
    EXPECT_GT(cv::mean(depth)[0], 300.0);
    EXPECT_LT(cv::mean(depth)[0], 15000.0);
  }
}

TEST(DatasetFolder, BelongsToOneSet) {
  const test::TemporaryFolder folder;
  DatasetConfig config = small_set();
  config.count = 2;
  make_dataset(config, small_halls(), folder.path() / "set", {}, {});
  config.jpeg_quality = 50;
  EXPECT_ERROR(make_dataset(config, small_halls(), folder.path() / "set", {}, {}), "dataset.yaml", "other settings");
  make_folder(folder.path() / "mine");
  write_file(folder.path() / "mine" / "notes.txt", "keep");
  EXPECT_ERROR(make_dataset(config, small_halls(), folder.path() / "mine", {}, {}), "mine", "no set of training pictures");
  EXPECT_EQ(read_file(folder.path() / "mine" / "notes.txt"), "keep");
  config.classes = {"teapot"};
  EXPECT_ERROR(make_dataset(config, small_halls(), folder.path() / "new", {}, {}), "teapot", "conveyor");
  EXPECT_FALSE(fs::exists(folder.path() / "new"));
}

TEST(DatasetFolder, RefusesPartsOfAnotherSet) {
  const test::TemporaryFolder folder;
  const fs::path one = folder.path() / "one", other = folder.path() / "other";
  DatasetConfig config = small_set();
  config.count = 2;
  config.images_per_hall = 1;
  make_dataset(config, small_halls(), one, {}, {.index = 0, .count = 2});
  config.seed += 1;
  make_dataset(config, small_halls(), other, {}, {.index = 1, .count = 2});
  // As if the shards were copied together.
  fs::copy(one, other, fs::copy_options::recursive | fs::copy_options::skip_existing);
  EXPECT_ERROR(make_dataset(config, small_halls(), other, {}, {}), "000000.json", "other settings");
}

TEST(DatasetFolder, MakesAgainWhatIsGoneAndBearsWhatAKillLeft) {
  const test::TemporaryFolder folder;
  const fs::path set = folder.path() / "set";
  DatasetConfig config = small_set();
  config.count = 3;
  config.images_per_hall = 1;
  make_folder(set);
  write_file(set / ".dataset.partial-7.yaml", "half");
  make_dataset(config, small_halls(), set, {}, {});
  const auto expected = files_of(set);
  fs::remove(set / "images" / "000001.jpg");
  fs::remove(set / "halls" / "000002.json");
  make_dataset(config, small_halls(), set, {}, {});
  EXPECT_EQ(files_of(set), expected);
  EXPECT_ERROR(generated_source("flat", 1, {{"sensors.cameras.camera.widht", "640"}}), "widht", "width");
}

TEST(DatasetSplits, AreAsEvenAsCanBe) {
  for (const int halls : {1, 3, 10, 40, 1000}) {
    std::map<std::string, int> counts;
    for (const std::string& split : split_halls(halls, 1, 0.2, 0.1)) ++counts[split];
    if (halls < 3) continue;
    EXPECT_NEAR(counts["train"], 0.7 * halls, 1.2);
    EXPECT_NEAR(counts["valid"], 0.2 * halls, 1.0);
    EXPECT_NEAR(counts["test"], 0.1 * halls, 1.0);
  }
  // Each source has its part in each split.
  for (const int sources : {2, 5}) {
    const std::vector<std::string> splits = split_halls(200, sources, 0.1, 0.1);
    std::map<std::pair<int, std::string>, int> counts;
    for (int h = 0; h < 200; ++h) ++counts[{h % sources, splits[static_cast<std::size_t>(h)]}];
    for (int source = 0; source < sources; ++source) {
      for (const char* split : {"valid", "test"}) EXPECT_NEAR((counts[{source, split}]), 20.0 / sources, 1.0) << sources << " " << split;
    }
  }
  for (int halls = 3; halls < 12; ++halls) {
    const std::vector<std::string> splits = split_halls(halls, 2, 0.1, 0.1);
    for (const char* split : {"train", "valid", "test"}) EXPECT_NE(std::find(splits.begin(), splits.end(), split), splits.end()) << halls;
  }
  EXPECT_EQ(split_halls(1, 1, 0.1, 0.1), (std::vector<std::string>{"train"}));
}

Hall a_cell() { return generated_source("cell", 11, {})->hall(3); }

TEST(ViewSampler, LooksAtObjectsFromTheOpenAndAwayFromThemOnDemand) {
  const Hall hall = a_cell();
  const RayCaster caster(hall.scene);
  const CameraConfig camera = hall.scenario.sensors.cameras.begin()->second;
  const ViewConfig config;
  const ViewSampler views(caster, hall.scenario, camera.intrinsics(), camera.mount.X_BC(), config, {"conveyor"});
  Dice dice(RandomStream(1, "test", "views"));
  std::map<ViewKind, int> kinds;
  for (int i = 0; i < 1000; ++i) ++kinds[views.draw_kind(dice)];
  EXPECT_NEAR(kinds[ViewKind::kRoute], 400, 60);
  EXPECT_NEAR(kinds[ViewKind::kEmpty], 100, 40);
  const auto share = [&](const Pose& X_WC) {
    int seen = 0, rays = 0;
    for (int v = 8; v < 720; v += 16) {
      for (int u = 8; u < 1280; u += 16, ++rays) {
        const Hit hit = caster.cast(
            {.origin = X_WC.translation().cast<float>(), .direction = (X_WC.linear() * camera.intrinsics().ray(u, v)).cast<float>()});
        seen += hit.valid() && hall.scene->instances[static_cast<std::size_t>(hit.instance)].object >= 0;
      }
    }
    return static_cast<double>(seen) / rays;
  };
  const Eigen::AlignedBox3f room = caster.bounds();
  for (int i = 0; i < 30; ++i) {
    const auto object = views.draw(ViewKind::kObject, dice), empty = views.draw(ViewKind::kEmpty, dice);
    ASSERT_TRUE(object && empty);
    EXPECT_GE(share(object->X_WC(0)), config.least_share);
    EXPECT_EQ(share(empty->X_WC(0)), 0.0);
    for (const auto& view : {*object, *empty}) {
      EXPECT_TRUE(room.contains(view.X_WC(0).translation().cast<float>()));
      // 8 ms of exposure at the speeds of the configuration.
      EXPECT_LT((view.X_WC(4'000'000).translation() - view.X_WC(-4'000'000).translation()).norm(), 0.008 * config.speed_mps + 1e-9);
    }
  }
}

TEST(ViewSampler, CaresForTheAskedClassesAlone) {
  const Hall hall = a_cell();
  auto scene = std::make_shared<Scene>(*hall.scene);
  ASSERT_GT(scene->objects.size(), 1u);
  scene->objects.front().class_name = "press";
  const RayCaster caster(scene);
  const CameraConfig camera = hall.scenario.sensors.cameras.begin()->second;
  const ViewSampler presses(caster, hall.scenario, camera.intrinsics(), camera.mount.X_BC(), {}, {"press"});
  Dice dice(RandomStream(1, "test", "views"));
  const auto seen = [&](const Pose& X_WC) {
    std::set<int> objects;
    for (int v = 8; v < 720; v += 16) {
      for (int u = 8; u < 1280; u += 16) {
        const Hit hit = caster.cast(
            {.origin = X_WC.translation().cast<float>(), .direction = (X_WC.linear() * camera.intrinsics().ray(u, v)).cast<float>()});
        if (hit.valid()) objects.insert(scene->instances[static_cast<std::size_t>(hit.instance)].object);
      }
    }
    objects.erase(-1);
    return objects;
  };
  int others = 0;
  for (int i = 0; i < 15; ++i) {
    const auto object = presses.draw(ViewKind::kObject, dice), empty = presses.draw(ViewKind::kEmpty, dice);
    ASSERT_TRUE(object && empty);
    EXPECT_TRUE(seen(object->X_WC(0)).contains(0));
    const std::set<int> in_empty = seen(empty->X_WC(0));
    EXPECT_FALSE(in_empty.contains(0));
    others += !in_empty.empty();
  }
  EXPECT_GT(others, 0) << "a view without a press may show conveyors";
  EXPECT_FALSE(ViewSampler(caster, hall.scenario, camera.intrinsics(), camera.mount.X_BC(), {}, {}).draw(ViewKind::kObject, dice));
}

TEST(HallHeights, TheFloorIsWhereOneWalks) {
  EXPECT_EQ(floor_of(-0.3), 0.0) << "a slab";
  EXPECT_EQ(floor_of(0.4), 0.4);
  EXPECT_EQ(floor_of(-7.5), -7.5) << "a hall far below";
}

// Darknet's layout has no word for a lens, COCO's file has.
TEST(Dataset, SaysWhatTheCameraIs) {
  const test::TemporaryFolder folder;
  DatasetConfig config = small_set();
  config.count = 1;
  const auto made = [&](const std::string& name, const std::string& rectify) {
    std::vector<std::unique_ptr<HallSource>> sources;
    sources.push_back(generated_source("flat", 5,
                                       {{"sensors.cameras.camera.width", "192"},
                                        {"sensors.cameras.camera.height", "108"},
                                        {"sensors.cameras.camera.colour.rectify", rectify}}));
    make_dataset(config, sources, folder.path() / name, {}, {});
    const ImageRecord record = read_hall_record(folder.path() / name / record_name(0)).images.at(0);
    const Json image = Json::parse(read_file(folder.path() / name / "annotations" / "instances_train.json")).at("images").at(0);
    EXPECT_EQ(image.at("intrinsics").at(0), record.intrinsics.fx);
    const Distortion lens = sources.front()->hall(0).scenario.sensors.cameras.at("camera").colour.lens;
    if (rectify == "false") {
      EXPECT_EQ(image.at("distortion"), (Json{lens.k1, lens.k2, lens.p1, lens.p2, lens.k3, lens.k4, lens.k5, lens.k6}));
      EXPECT_EQ(coefficients(record.distortion), coefficients(lens));
    } else {
      EXPECT_FALSE(image.contains("distortion"));
    }
    return record;
  };
  const ImageRecord plain = made("plain", "true"), bent = made("bent", "false");
  EXPECT_TRUE(plain.distortion.is_none());
  EXPECT_FALSE(bent.distortion.is_none());
  // The bent picture shows more than the rectified one, at a shorter focal length.
  EXPECT_LT(bent.intrinsics.fx, 0.99 * plain.intrinsics.fx);
}

TEST(Dataset, SplitsWithoutPicturesHaveNoFile) {
  const test::TemporaryFolder folder;
  DatasetConfig config = small_set();
  config.count = 2;
  config.images_per_hall = 1;
  config.test_share = 0.0;
  const DatasetSummary summary = make_dataset(config, small_halls(), folder.path() / "set", {.yolo = false, .coco = true}, {});
  EXPECT_EQ(summary.splits, (std::map<std::string, int>{{"train", 1}, {"valid", 1}}));
  EXPECT_EQ(splits_of(folder.path() / "set"), (std::vector<std::string>{"train", "valid"}));
  EXPECT_EQ(read_labelled_set(folder.path() / "set", "all").images.size(), 2u);
}

TEST(Appearance, ChangesLooksAndNothingElse) {
  const Hall hall = a_cell();
  Scene scene = *hall.scene;
  Dice dice(RandomStream(2, "test", "look"));
  vary_light(scene, {}, dice);
  vary_materials(scene, {}, dice);
  EXPECT_FALSE(scene.lights.empty());
  EXPECT_LE(scene.lights.size(), hall.scene->lights.size());
  ASSERT_EQ(scene.materials.size(), hall.scene->materials.size());
  EXPECT_EQ(scene.triangle_count(), hall.scene->triangle_count());
  int changed = 0;
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    const Material &now = scene.materials[i], &before = hall.scene->materials[i];
    if (!before.emissive.isZero(0.0f)) {
      EXPECT_EQ(now.base_colour, before.base_colour) << "lamps keep their look";
    }
    EXPECT_LT(now.base_colour_texture.texture, static_cast<int>(scene.textures.size()));
    EXPECT_GE(now.base_colour.minCoeff(), 0.0f);
    EXPECT_LE(now.base_colour.maxCoeff(), 1.0f);
    changed += now.base_colour != before.base_colour || now.base_colour_texture.texture != before.base_colour_texture.texture;
  }
  EXPECT_GT(changed, static_cast<int>(scene.materials.size()) / 3);
  for (std::size_t i = 0; i < hall.scene->textures.size(); ++i) EXPECT_EQ(scene.textures[i].rgba, hall.scene->textures[i].rgba);
  Scene dark = *hall.scene;
  vary_light(dark, {.off_share = 1.0}, dice);
  EXPECT_EQ(dark.lights.size(), 1u);
}

TEST(Things, StandInTheOpenAndLieOnSomething) {
  const Hall hall = a_cell();
  Scene scene = *hall.scene;
  Scenario scenario = hall.scenario;
  const HallHeights before(*hall.scene);
  Dice dice(RandomStream(3, "test", "things"));
  while (scenario.motion.clutter.size() < 4) add_things(scene, scenario, {.loose_max = 8, .parcels_max = 4, .standing_max = 4}, dice);
  EXPECT_EQ(scene.movers.size(), scenario.motion.clutter.size());
  EXPECT_EQ(scene.objects.size(), hall.scene->objects.size());
  const RobotMotion route(scenario.robot);
  for (std::size_t i = hall.scene->instances.size(); i < scene.instances.size(); ++i) {
    const Instance& thing = scene.instances[i];
    EXPECT_EQ(thing.object, -1);
    if (thing.name != "standing thing") continue;
    const Eigen::Vector2d at = thing.X_WM.translation().head<2>().cast<double>();
    EXPECT_LT(before.at(at), 0.05) << "nothing stood there";
    for (Stamp stamp = 0; stamp < route.duration(); stamp += 500'000'000) {
      EXPECT_GT((route.X_WB(stamp).translation().head<2>() - at).norm(), 0.6);
    }
  }
  // After they fell.
  scenario.robot.drive.model = "exact";
  RayCaster caster(std::make_shared<const Scene>(scene));
  HallMotion motion(scenario, caster);
  motion.advance_to(from_seconds(1.0));
  const HallMoment moment = motion.moment(from_seconds(1.0), from_seconds(1.0));
  for (const HallMoment::Place& place : moment.movers) {
    EXPECT_TRUE(place.present);
    EXPECT_GT(place.X_WG_end.translation().z(), -0.05f) << "fell through the floor";
    EXPECT_LT((place.X_WG_end.translation() - place.X_WG_begin.translation()).norm(), 0.05f);
  }
}

}  // namespace
}  // namespace waretwin

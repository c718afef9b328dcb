#include <gtest/gtest.h>

#include <set>

#include "core/pose.h"
#include "mapper/associate/paper_associator.h"
#include "mapper/associate/similarity.h"
#include "mapper/segment/cuboid_search.h"
#include "mapper/segment/hsv_histogram.h"
#include "tests/mapper/traced_frame.h"

namespace waretwin {
namespace {

const std::vector<float> kRed = {1, 0, 0}, kBlue = {0, 0, 1};

// Points on the surface grid of an upright box, and a detection of it.
SegmentedObject seen(const std::string& name, const Cuboid& cuboid, const cv::Rect2f& box = {100, 100, 50, 50},
                     const std::vector<float>& hsv = kRed) {
  SegmentedObject object;
  object.detection = {name, box, 0.9f};
  for (int x = 0; x <= 10; ++x) {
    for (int y = 0; y <= 10; ++y) {
      for (int z = 0; z <= 10; ++z) {
        const Eigen::Vector3d p_O = (Eigen::Vector3d(x, y, z) / 10.0 - Eigen::Vector3d::Constant(0.5)).cwiseProduct(cuboid.size);
        object.points_W.push_back((cuboid.pose() * p_O).cast<float>());
        object.pixels.push_back(static_cast<int>(object.pixels.size()));
      }
    }
  }
  object.cuboid = search_cuboid(object.points_W, to_radians(1));
  object.hsv = hsv;
  return object;
}

AssociationContext at_frame(int id) {
  AssociationContext context;
  context.frame_id = id;
  context.intrinsics = test::kinect(640, 360);
  return context;
}

Cuboid cube(double x, double side = 0.5) { return test::box(x, 0, 0, 0, side, side, side); }

TEST(PaperAssociator, JoinsTheSameObjectAndUpdatesIt) {
  PaperAssociator associator({});
  ObjectList map;
  EXPECT_EQ(associator.associate({seen("box", cube(1.0))}, at_frame(1), map), std::vector<int>{1});
  ASSERT_EQ(map.size(), 1u);
  EXPECT_EQ(map[0].observations, 1);
  // Moved by 0.1 of 0.5 m: IoU 0.4 / 0.6.
  EXPECT_EQ(associator.associate({seen("box", cube(1.1), {105, 100, 50, 50}, {0.9f, 0.1f, 0})}, at_frame(3), map), std::vector<int>{1});
  ASSERT_EQ(map.size(), 1u);
  EXPECT_EQ(map[0].observations, 2);
  EXPECT_EQ(map[0].first_frame, 1);
  EXPECT_EQ(map[0].last_frame, 3);
  EXPECT_EQ(map[0].box, cv::Rect2f(105, 100, 50, 50));
  EXPECT_FLOAT_EQ(map[0].hsv[1], 0.1f);
  // The cuboid is that of all points together.
  EXPECT_NEAR(map[0].cuboid.size.x(), 0.6, 1e-5);
  EXPECT_NEAR(map[0].cuboid.centre.x(), 1.05, 1e-5);
  EXPECT_NEAR(map[0].cuboid.size.z(), 0.5, 1e-5);
}

// One condition after the other fails; everything else holds.
TEST(PaperAssociator, EachConditionAloneKeepsObjectsApart) {
  struct Case {
    const char* what;
    SegmentedObject object;
    int frame;
    bool joined;
  };
  const Cuboid moved = cube(1.1);  // IoU 2/3
  const Case cases[] = {
      {"all hold", seen("box", moved), 10, true},
      {"eq. 1: class", seen("crate", moved), 10, false},
      {"eq. 2: 10 frames later", seen("box", moved), 11, false},
      {"eq. 3: 2D IoU exactly 1/3", seen("box", moved, {125, 100, 50, 50}), 10, false},
      {"eq. 3: 2D IoU 0.54", seen("box", moved, {115, 100, 50, 50}), 10, true},
      {"eq. 4: another colour", seen("box", moved, {100, 100, 50, 50}, kBlue), 10, false},
      {"eq. 4: correlation 0.32", seen("box", moved, {100, 100, 50, 50}, {0.32f, 0, 0.95f}), 10, true},
      {"eq. 5: 3D IoU 0.45", seen("box", cube(1.19)), 10, false},
      {"eq. 5: 3D IoU 0.52", seen("box", cube(1.158)), 10, true},
  };
  for (const Case& c : cases) {
    PaperAssociator associator({});
    ObjectList map;
    associator.associate({seen("box", cube(1.0))}, at_frame(1), map);
    const std::vector<int> ids = associator.associate({c.object}, at_frame(c.frame), map);
    EXPECT_EQ(ids[0], c.joined ? 1 : 2) << c.what;
    EXPECT_EQ(map.size(), c.joined ? 1u : 2u) << c.what;
  }
}

TEST(PaperAssociator, OverlapAboveTheMergingLimitBeatsEverything) {
  PaperAssociator associator({});
  ObjectList map;
  associator.associate({seen("sofa", cube(1.0))}, at_frame(1), map);
  // IoU 0.48 / 0.52 = 0.92, another class, colour and place in the image, long after.
  EXPECT_EQ(associator.associate({seen("bed", cube(1.02), {400, 10, 20, 20}, kBlue)}, at_frame(100), map), std::vector<int>{1});
  ASSERT_EQ(map.size(), 1u);
  EXPECT_EQ(map[0].class_name, "bed");
  EXPECT_EQ(map[0].last_frame, 100);
}

TEST(PaperAssociator, SecondVisitNeedsNoFrameGapAndTheProjectedBox) {
  // The robot comes back after 50 frames; the object stands elsewhere in the image and its points are 0.1 m off.
  AssociationContext later = at_frame(51);
  later.X_WC = test::camera_pose(-0.5, 0, 0.5, 0, to_radians(10));
  const auto box = projected_box(cube(1.1), later.X_WC, later.intrinsics);
  ASSERT_TRUE(box);
  for (const bool open : {false, true}) {
    AssociateConfig config;
    if (open) {
      config.max_frame_gap = 0;
      config.iou2d_mode = "projected";
    }
    PaperAssociator associator(config);
    ObjectList map;
    associator.associate({seen("box", cube(1.0), {10, 10, 50, 50})}, at_frame(1), map);
    associator.associate({seen("box", cube(1.1), *box)}, later, map);
    EXPECT_EQ(map.size(), open ? 1u : 2u);
  }
}

TEST(PaperAssociator, PairsOneToOneByLargestOverlap) {
  PaperAssociator associator({});
  ObjectList map;
  associator.associate({seen("box", cube(1.0))}, at_frame(1), map);
  // Both could be object 1; the nearer one is.
  EXPECT_EQ(associator.associate({seen("box", cube(1.15)), seen("box", cube(0.95))}, at_frame(2), map), (std::vector<int>{2, 1}));
}

TEST(PaperAssociator, MergesObjectsThatGrowTogetherAndReportsIt) {
  PaperAssociator associator({});
  ObjectList map;
  // Two halves of one object, seen apart.
  EXPECT_EQ(associator.associate({seen("box", test::box(1.0, 0, 0, 0, 0.5, 0.6, 0.4), {0, 0, 50, 50}),
                                  seen("box", test::box(1.3, 0, 0, 0, 0.5, 0.6, 0.4), {200, 0, 50, 50})},
                                 at_frame(1), map),
            (std::vector<int>{1, 2}));
  EXPECT_TRUE(associator.take_merges().empty());
  // Now the whole is seen twice over: first it joins one half, then what is left overlaps enough.
  const Cuboid whole = test::box(1.15, 0, 0, 0, 0.8, 0.6, 0.4);
  std::vector<int> ids = associator.associate({seen("box", whole, {200, 0, 50, 50})}, at_frame(2), map);
  ids = associator.associate({seen("box", whole, {0, 0, 50, 50})}, at_frame(3), map);
  std::set<int> alive;
  for (const MappedObject& mapped : map) alive.insert(mapped.id);
  if (map.size() == 2) {
    // The other half is still half: let the whole join it as well.
    ids = associator.associate({seen("box", whole, {200, 0, 50, 50}), seen("box", whole, {0, 0, 50, 50})}, at_frame(4), map);
  }
  ASSERT_EQ(map.size(), 1u);
  EXPECT_EQ(map[0].id, 1);
  for (const int id : ids) EXPECT_EQ(id, 1);
  EXPECT_EQ(associator.take_merges(), (std::vector<std::pair<int, int>>{{2, 1}}));
  EXPECT_TRUE(associator.take_merges().empty());
  EXPECT_NEAR(map[0].cuboid.size.x(), 0.8, 1e-4);
  // Id 2 is used up.
  EXPECT_EQ(associator.associate({seen("box", cube(5.0))}, at_frame(5), map), std::vector<int>{3});
}

TEST(PaperAssociator, GoesOnFromAResumedMap) {
  ObjectList map(1);
  map[0].id = 7;
  map[0].class_name = "box";
  map[0].cuboid = seen("box", cube(1.0)).cuboid;
  PaperAssociator associator({});
  EXPECT_EQ(associator.associate({seen("box", cube(9.0))}, at_frame(1), map), std::vector<int>{8});
}

TEST(PaperAssociator, PointsStayBoundedByTheObjectsSize) {
  AssociateConfig config;
  config.point_voxel_m = 0.02;
  PaperAssociator associator(config);
  ObjectList map;
  const RandomStream random(1, "camera", "points");
  std::size_t after_ten = 0;
  for (int frame = 1; frame <= 40; ++frame) {
    SegmentedObject object = seen("box", cube(1.0, 0.2));
    for (std::size_t i = 0; i < 3000; ++i) {
      const auto draw = static_cast<std::uint64_t>(frame) * 3000 + i;
      object.points_W.emplace_back(0.9 + 0.2 * random.uniform(draw, 0), 0.2 * random.uniform(draw, 1) - 0.1, 0.2 * random.uniform(draw, 2));
    }
    associator.associate({object}, at_frame(frame), map);
    if (frame == 10) after_ten = map[0].points_W.size();
  }
  ASSERT_EQ(map.size(), 1u);
  EXPECT_LE(map[0].points_W.size(), 12u * 12u * 12u);
  EXPECT_LT(static_cast<double>(map[0].points_W.size()), 1.05 * static_cast<double>(after_ten));
  EXPECT_NEAR(map[0].cuboid.size.x(), 0.2, 0.001);
}

TEST(Similarity, Iou2dByHand) {
  EXPECT_DOUBLE_EQ(iou_2d({0, 0, 2, 2}, {1, 1, 2, 2}), 1.0 / 7.0);
  EXPECT_DOUBLE_EQ(iou_2d({0, 0, 2, 2}, {0, 0, 2, 2}), 1.0);
  EXPECT_DOUBLE_EQ(iou_2d({0, 0, 2, 2}, {2, 0, 2, 2}), 0.0);
  EXPECT_DOUBLE_EQ(iou_2d({0, 0, 0, 0}, {0, 0, 0, 0}), 0.0);
}

TEST(Similarity, CorrelationByHand) {
  EXPECT_NEAR(normalised_correlation({3, 4}, {3, 4}), 1.0, 1e-12);
  EXPECT_NEAR(normalised_correlation({3, 4}, {30, 40}), 1.0, 1e-12);
  EXPECT_NEAR(normalised_correlation({3, 4}, {4, -3}), 0.0, 1e-12);
  EXPECT_NEAR(normalised_correlation({3, 4}, {5, 0}), 0.6, 1e-12);
  EXPECT_NEAR(literal_correlation({3, 4}, {3, 4}), 25.0 / std::sqrt(50.0), 1e-12);
  EXPECT_EQ(normalised_correlation({}, {}), 0.0);
}

TEST(Similarity, ProjectedBoxHoldsEveryPixelOfTheCuboid) {
  const Intrinsics intrinsics = test::kinect(640, 360);
  const Pose X_WC = test::camera_pose(0, 0, 1.4, 0.1, to_radians(45));
  for (const double yaw : {0.0, 0.5, 1.2}) {
    const test::TracedScene scene = {{test::box(1.2, 0.1, 0.2, yaw, 0.6, 0.4, 0.3)}, {}};
    const test::TracedFrame traced = test::trace(scene, intrinsics, X_WC);
    const auto box = projected_box(scene.boxes[0], X_WC, intrinsics);
    ASSERT_TRUE(box && traced.boxes[0]);
    EXPECT_NEAR(box->x, traced.boxes[0]->x, 1.01);
    EXPECT_NEAR(box->y, traced.boxes[0]->y, 1.01);
    EXPECT_NEAR(box->br().x, traced.boxes[0]->br().x, 1.01);
    EXPECT_NEAR(box->br().y, traced.boxes[0]->br().y, 1.01);
  }
  EXPECT_FALSE(projected_box(test::box(-2, 0, 0, 0, 0.5, 0.5, 0.5), X_WC, intrinsics));
  // Around the camera: everything is covered.
  EXPECT_EQ(projected_box(test::box(0, 0, 0, 0, 10, 10, 10), X_WC, intrinsics), cv::Rect2f(0, 0, 640, 360));
}

TEST(HsvHistogram, SumsToOneAndTellsColoursApart) {
  cv::Mat picture(40, 60, CV_8UC3, cv::Scalar(30, 30, 200));
  picture(cv::Rect(30, 0, 30, 40)).setTo(cv::Scalar(200, 60, 20));
  const std::vector<float> left = hsv_histogram(picture, {0, 0, 30, 40}), right = hsv_histogram(picture, {30, 0, 30, 40}),
                           both = hsv_histogram(picture, {-10, -10, 100, 100}), outside = hsv_histogram(picture, {100, 100, 5, 5});
  EXPECT_EQ(left.size(), 192u);
  float sum = 0;
  for (const float share : both) sum += share;
  EXPECT_NEAR(sum, 1.0, 1e-5);
  EXPECT_NEAR(normalised_correlation(left, right), 0.0, 1e-9);
  EXPECT_NEAR(normalised_correlation(left, both), std::sqrt(0.5), 1e-6);
  for (const float share : outside) EXPECT_EQ(share, 0.0f);
}

}  // namespace
}  // namespace waretwin

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "harness/pictures/map_pictures.h"
#include "tests/harness/score_fixtures.h"

namespace waretwin {
namespace {

// A square of side 2 at height z, counter-clockwise from above.
PictureMesh square(float z, std::array<std::uint8_t, 3> colour) {
  PictureMesh mesh;
  mesh.vertices = {{-1, -1, z}, {1, -1, z}, {1, 1, z}, {-1, 1, z}};
  mesh.colours.assign(4, colour);
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

PictureMesh joined(PictureMesh a, const PictureMesh& b) {
  const auto offset = static_cast<std::uint32_t>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  a.colours.insert(a.colours.end(), b.colours.begin(), b.colours.end());
  for (const auto& t : b.triangles) a.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  return a;
}

TEST(Rasteriser, FillsEveryPixelOfASquareOnce) {
  Picture picture(PictureView::from_above({-2, -2}, {2, 2}, 10.0, 0), cv::Vec3b(0, 0, 0));
  picture.draw(square(0.0f, {200, 200, 200}), 10.0);
  cv::Mat channel;
  cv::extractChannel(picture.image(), channel, 0);
  // From 1 m to 3 m at 10 pixels a metre: pixel centres 10 to 30.
  EXPECT_EQ(cv::countNonZero(channel), 21 * 21);
}

TEST(Rasteriser, ShowsWhatIsNearerToTheViewer) {
  const PictureMesh both = joined(square(1.0f, {255, 0, 0}), square(0.0f, {0, 255, 0}));
  Picture picture(PictureView::from_above({-1, -1}, {1, 1}, 10.0, 5), cv::Vec3b(0, 0, 0));
  picture.draw(both, 10.0);
  const cv::Vec3b upper = picture.image().at<cv::Vec3b>(15, 15);
  EXPECT_GT(upper[2], 0) << "red lies on top";
  EXPECT_EQ(upper[1], 0);
  Picture cut(PictureView::from_above({-1, -1}, {1, 1}, 10.0, 5), cv::Vec3b(0, 0, 0));
  cut.draw(both, 0.5);
  EXPECT_GT(cut.image().at<cv::Vec3b>(15, 15)[1], 0) << "red is cut off at the ceiling";
}

TEST(Rasteriser, PutsTheTargetOfAPerspectiveViewInTheMiddle) {
  const PictureView view = PictureView::perspective({3, -4, 2}, {1, 1, 0}, 641, 481, 1.0);
  const auto middle = view.project({1, 1, 0});
  ASSERT_TRUE(middle.has_value());
  EXPECT_NEAR(middle->x(), 320.0, 1e-9);
  EXPECT_NEAR(middle->y(), 240.0, 1e-9);
  EXPECT_NEAR(middle->z(), std::sqrt(4.0 + 25.0 + 4.0), 1e-9);
  EXPECT_LT(view.project({1, 1, 0.5})->y(), 240.0) << "the world's z points up";
  EXPECT_FALSE(view.project({5, -9, 4}).has_value()) << "behind";
}

TEST(MapPicture, DrawsCuboidsAndPathsWithoutAMesh) {
  MapScene scene;
  scene.mapped = {test::object(1, "conveyor", 0, 0)};
  scene.truth = {test::object(1, "conveyor", 0.2, 0)};
  scene.trajectory = {{0, make_upright_pose(-2, -2, 0, 0)}, {1, make_upright_pose(2, -2, 0, 0)}};
  scene.true_trajectory = scene.trajectory;
  for (const cv::Mat& image : {draw_from_above(scene, 2.5), draw_oblique(scene, 2.5)}) {
    ASSERT_FALSE(image.empty());
    double low = 0.0, high = 0.0;
    cv::minMaxLoc(image.reshape(1), &low, &high);
    EXPECT_LT(low, 100.0) << "something is drawn";
  }
  EXPECT_FALSE(draw_from_above(MapScene{}, 2.5).empty()) << "an empty map has a picture too";
}

}  // namespace
}  // namespace waretwin

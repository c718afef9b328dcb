#include "sim/object_views.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "core/parallel.h"
#include "sim/colour_camera.h"
#include "sim/pixel_extent.h"
#include "sim/renderer.h"
#include "tests/sim/fixtures.h"

namespace waretwin {
namespace {

using namespace fixtures;

// From the origin along x: a point (x, y, z) is at u = 49.5 - 100 y / x, v = 39.5 - 100 z / x, between the centres of pixels.
const Intrinsics kCamera = Intrinsics::checked(100, 80, 100, 100, 49.5, 39.5);

Pose ahead() {
  Pose X_WC = Pose::Identity();
  X_WC.linear() = optical_from_forward();
  return X_WC;
}

// The instance image of the rays themselves, one by one.
cv::Mat labels(const RayCaster& caster, const PictureRays& rays) {
  cv::Mat ids = cv::Mat::zeros(rays.intrinsics.height, rays.intrinsics.width, CV_16UC1);
  const Scene& scene = caster.scene();
  for (int v = 0; v < ids.rows; ++v) {
    for (int u = 0; u < ids.cols; ++u) {
      const Hit hit = caster.cast(rays.at(u, v));
      if (!hit.valid()) continue;
      const int object = scene.instances[static_cast<std::size_t>(hit.instance)].object;
      if (object >= 0) ids.at<std::uint16_t>(v, u) = static_cast<std::uint16_t>(scene.objects[static_cast<std::size_t>(object)].id);
    }
  }
  return ids;
}

std::vector<ObjectView> views_of(const RayCaster& caster, const PictureRays& rays) {
  return object_views(caster, rays, labels(caster, rays));
}

// The object's pixels on the picture's plane and its margin, found in a hall without anything else, with one ray a pixel: 3 width x 3
// height.
cv::Mat alone(const RayCaster& caster, const PictureRays& rays, int id) {
  Scene scene = caster.scene();
  std::erase_if(scene.instances, [&](const Instance& instance) {
    return instance.object < 0 || scene.objects[static_cast<std::size_t>(instance.object)].id != id;
  });
  const RayCaster only(std::make_shared<const Scene>(std::move(scene)));
  const int width = rays.intrinsics.width, height = rays.intrinsics.height;
  cv::Mat mask = cv::Mat::zeros(3 * height, 3 * width, CV_8UC1);
  for (int v = 0; v < mask.rows; ++v) {
    for (int u = 0; u < mask.cols; ++u) {
      if (only.cast(rays.at(u - width, v - height)).valid()) mask.at<std::uint8_t>(v, u) = 255;
    }
  }
  return mask;
}

// The view's mask on the whole picture.
cv::Mat in_picture(const ObjectView& view, const cv::Size& size) {
  cv::Mat mask = cv::Mat::zeros(size, CV_8UC1);
  if (view.amodal_px > 0) view.amodal_mask.copyTo(mask(view.mask_box));
  return mask;
}

cv::Rect box_around(const cv::Mat& mask, const cv::Point& origin) {
  PixelExtent extent;
  for (int v = 0; v < mask.rows; ++v) {
    for (int u = 0; u < mask.cols; ++u) {
      if (mask.at<std::uint8_t>(v, u) != 0) extent.add(u + origin.x, v + origin.y);
    }
  }
  return extent.box();
}

class PanelScene {
 public:
  PanelScene() {
    scene_.name = "panels";
    box_ = add_mesh(scene_, unit_box(), add_material(scene_, {1, 1, 1}));
  }
  // An upright sheet across the x axis.
  int sheet(float x, float y0, float y1, float z0, float z1, int object) {
    return add_instance(scene_, box_, placed({x, y0, z0}, {1e-5f, y1 - y0, z1 - z0}), object);
  }
  int object() { return add_object(scene_, "conveyor"); }
  Scene& scene() { return scene_; }
  int box() const { return box_; }
  RayCaster caster() { return RayCaster(std::make_shared<const Scene>(scene_)); }

 private:
  Scene scene_;
  int box_;
};

TEST(ObjectViews, AnObjectBeforeEverythingIsWhollyVisible) {
  PanelScene panels;
  panels.sheet(2, -0.5f, 0.5f, -0.4f, 0.4f, panels.object());
  panels.sheet(3, -5, 5, -5, 5, -1);
  const RayCaster caster = panels.caster();
  const auto views = views_of(caster, pinhole_rays(kCamera, ahead(), 0.5f));
  ASSERT_EQ(views.size(), 1u);
  const ObjectView& view = views[0];
  EXPECT_EQ(view.id, 1);
  EXPECT_EQ(view.visible_px, 50 * 40);
  EXPECT_EQ(view.amodal_px, 50 * 40);
  EXPECT_EQ(view.amodal_px_total, 50 * 40);
  EXPECT_EQ(view.visible_box, cv::Rect(25, 20, 50, 40));
  EXPECT_EQ(view.amodal_box, cv::Rect(25, 20, 50, 40));
  EXPECT_EQ(view.mask_box, cv::Rect(25, 20, 50, 40));
  EXPECT_EQ(view.visible(), 1.0);
  EXPECT_EQ(view.occluded(), 0.0);
  EXPECT_EQ(view.truncated(), 0.0);
  EXPECT_FALSE(view.crosses_camera_plane);
  EXPECT_FALSE(view.leaves_margin);
}

TEST(ObjectViews, HalfBehindAnotherObject) {
  PanelScene panels;
  panels.sheet(2, -0.5f, 0.5f, -0.4f, 0.4f, panels.object());
  panels.sheet(1, 0, 0.3f, -1, 1, panels.object());  // columns 20 to 49, from the top to the bottom of the picture and beyond
  const RayCaster caster = panels.caster();
  const auto views = views_of(caster, pinhole_rays(kCamera, ahead(), 0.5f));
  ASSERT_EQ(views.size(), 2u);
  EXPECT_EQ(views[0].visible_px, 25 * 40);
  EXPECT_EQ(views[0].amodal_px, 50 * 40);
  EXPECT_EQ(views[0].occluded(), 0.5);
  EXPECT_EQ(views[0].truncated(), 0.0);
  EXPECT_EQ(views[0].visible(), 0.5);
  EXPECT_EQ(views[0].visible_box, cv::Rect(50, 20, 25, 40));
  EXPECT_EQ(views[0].amodal_box, cv::Rect(25, 20, 50, 40));
  EXPECT_EQ(cv::countNonZero(views[0].amodal_mask), 50 * 40);
  EXPECT_EQ(views[1].occluded(), 0.0);
  EXPECT_EQ(views[1].amodal_px, 30 * 80);
  EXPECT_EQ(views[1].amodal_px_total, 30 * 200);
  EXPECT_EQ(views[1].amodal_box, cv::Rect(20, -60, 30, 200));
  EXPECT_DOUBLE_EQ(views[1].truncated(), 0.6);
}

TEST(ObjectViews, HalfBeyondThePicture) {
  PanelScene panels;
  panels.sheet(2, -1.5f, -0.5f, -0.4f, 0.4f, panels.object());  // columns 75 to 124
  const RayCaster caster = panels.caster();
  const auto views = views_of(caster, pinhole_rays(kCamera, ahead(), 0.5f));
  ASSERT_EQ(views.size(), 1u);
  EXPECT_EQ(views[0].amodal_px, 25 * 40);
  EXPECT_EQ(views[0].truncated(), 0.5);
  EXPECT_EQ(views[0].occluded(), 0.0);
  EXPECT_EQ(views[0].visible(), 0.5);
  EXPECT_EQ(views[0].visible_box, cv::Rect(75, 20, 25, 40));
  EXPECT_EQ(views[0].mask_box, cv::Rect(75, 20, 25, 40));
  EXPECT_EQ(views[0].amodal_box, cv::Rect(75, 20, 50, 40));
}

TEST(ObjectViews, WhollyHiddenAndWhollyBeyondThePicture) {
  PanelScene panels;
  panels.sheet(2, -0.5f, 0.5f, -0.4f, 0.4f, panels.object());
  panels.sheet(1, -2, 2, -2, 2, -1);
  panels.sheet(2, -2.5f, -1.5f, -0.4f, 0.4f, panels.object());  // columns 125 to 174
  panels.sheet(-2, -0.5f, 0.5f, -0.4f, 0.4f, panels.object());  // behind the camera
  panels.sheet(2, -9.5f, -8.5f, -0.4f, 0.4f, panels.object());  // beyond the margin
  const RayCaster caster = panels.caster();
  const auto views = views_of(caster, pinhole_rays(kCamera, ahead(), 0.5f));
  ASSERT_EQ(views.size(), 2u);
  EXPECT_EQ(views[0].id, 1);
  EXPECT_EQ(views[0].occluded(), 1.0);
  EXPECT_EQ(views[0].visible(), 0.0);
  EXPECT_TRUE(views[0].visible_box.empty());
  EXPECT_EQ(views[0].amodal_px, 50 * 40);
  EXPECT_EQ(views[1].id, 2);
  EXPECT_EQ(views[1].truncated(), 1.0);
  EXPECT_EQ(views[1].occluded(), 0.0);
  EXPECT_EQ(views[1].amodal_box, cv::Rect(125, 20, 50, 40));
  EXPECT_TRUE(views[1].mask_box.empty());
  EXPECT_TRUE(views[1].amodal_mask.empty());
}

TEST(ObjectViews, AnObjectBesideTheCameraCountsWithWhatIsBeforeIt) {
  PanelScene panels;
  const int object = panels.object();
  add_instance(panels.scene(), panels.box(), placed({-3, -0.6f, -1}, {6, 0.1f, 0.8f}), object);  // a beam along the way, beside and below
  const RayCaster caster = panels.caster();
  const PictureRays rays = pinhole_rays(kCamera, ahead(), 0.5f);
  const auto views = views_of(caster, rays);
  ASSERT_EQ(views.size(), 1u);
  EXPECT_TRUE(views[0].crosses_camera_plane);
  EXPECT_TRUE(views[0].leaves_margin);
  const cv::Mat reference = alone(caster, rays, 1);
  EXPECT_EQ(views[0].amodal_px, cv::countNonZero(reference(cv::Rect(100, 80, 100, 80))));
  EXPECT_GT(views[0].amodal_px, 100);
  const auto total = static_cast<double>(cv::countNonZero(reference));
  EXPECT_NEAR(static_cast<double>(views[0].amodal_px_total), total, 0.02 * total);
}

TEST(ObjectViews, HolesCoverNothing) {
  PanelScene panels;
  Texture texture;  // the left half is a hole
  texture.width = 2;
  texture.height = 1;
  texture.nearest = true;
  texture.rgba = {255, 255, 255, 0, 255, 255, 255, 255};
  panels.scene().textures.push_back(texture);
  const int material = add_material(panels.scene(), {1, 1, 1});
  panels.scene().materials.back().alpha_mask = true;
  panels.scene().materials.back().base_colour_texture.texture = 0;
  Mesh quad;  // u of the texture grows to the right of the picture
  add_quad(quad, {0, 0.5f, -0.4f}, {0, -0.5f, -0.4f}, {0, -0.5f, 0.4f}, {0, 0.5f, 0.4f});
  const int mesh = add_mesh(panels.scene(), quad, material);
  Eigen::Affine3f X_WM = Eigen::Affine3f::Identity();
  X_WM.translation().x() = 2;
  add_instance(panels.scene(), mesh, X_WM, panels.object());
  panels.sheet(4, -1, 1, -0.8f, 0.8f, panels.object());  // the same outline, behind it
  const RayCaster caster = panels.caster();
  const auto views = views_of(caster, pinhole_rays(kCamera, ahead(), 0.5f));
  ASSERT_EQ(views.size(), 2u);
  EXPECT_EQ(views[0].amodal_box, cv::Rect(50, 20, 25, 40));
  EXPECT_EQ(views[0].amodal_px, 25 * 40);
  EXPECT_EQ(views[0].visible(), 1.0);
  EXPECT_EQ(views[1].amodal_px, 50 * 40);
  EXPECT_EQ(views[1].visible_box, cv::Rect(25, 20, 25, 40));
  EXPECT_EQ(views[1].occluded(), 0.5);
}

TEST(ObjectViews, AreThoseOfTheMoment) {
  PanelScene panels;
  panels.sheet(2, -0.5f, 0.5f, -0.4f, 0.4f, panels.object());
  const int parcel = panels.sheet(1, 0, 1, -1, 1, -1);
  RayCaster caster = panels.caster();
  caster.set_shutter(0, 1000);
  // From beside the object to before all of it: an edge at u = 24.5, 49.5, 74.5 at the beginning, the middle and the end.
  caster.set_motion(parcel, placed({1, 0.25f, -1}, {1e-5f, 1, 2}), placed({1, -0.25f, -1}, {1e-5f, 1, 2}));
  caster.commit();
  for (const auto& [moment, occluded] : {std::pair<Stamp, double>{0, 0.0}, {500, 0.5}, {800, 0.8}, {1000, 1.0}}) {
    const auto views = views_of(caster, pinhole_rays(kCamera, ahead(), caster.time_of(moment)));
    ASSERT_EQ(views.size(), 1u);
    EXPECT_NEAR(views[0].occluded(), occluded, 1e-12) << moment;
  }
  caster.set_present(parcel, false);
  caster.commit();
  EXPECT_EQ(views_of(caster, pinhole_rays(kCamera, ahead(), 0.5f))[0].visible(), 1.0);
}

TEST(ObjectViews, FollowAnObjectThatMovesOrGoes) {
  PanelScene panels;
  const int sheet = panels.sheet(2, -0.5f, 0.5f, -0.4f, 0.4f, panels.object());
  panels.sheet(1, -2, 2, -2, 2, -1);
  RayCaster caster = panels.caster();
  const PictureRays rays = pinhole_rays(kCamera, ahead(), 0.5f);
  ASSERT_EQ(views_of(caster, rays).size(), 1u);
  caster.set_transform(sheet, placed({4, -0.48f, -0.4f}, {1e-5f, 0.96f, 0.8f}));
  caster.commit();
  EXPECT_EQ(views_of(caster, rays).at(0).amodal_px, 24 * 20) << "columns 38 to 61";
  caster.set_present(sheet, false);
  caster.commit();
  EXPECT_TRUE(views_of(caster, rays).empty());
  caster.set_present(sheet, true);
  caster.commit();
  EXPECT_EQ(views_of(caster, rays).size(), 1u);
}

// Conveyors, with posts that stand before some of them; every other post is an object, too.
std::shared_ptr<const RayCaster> crowded_hall() {
  Scene scene = busy_hall(8);
  const int post = add_mesh(scene, unit_box(), add_material(scene, {1, 0, 0}));
  for (int i = 0; i < 4; ++i) {
    const float x = -4.0f + 2.6f * static_cast<float>(i), y = i % 2 == 0 ? 1.2f : -1.3f;
    add_instance(scene, post, placed({x, y, 0}, {0.25f, 0.05f, 1.5f}, 0.3f), i % 2 == 0 ? add_object(scene, "post") : -1);
  }
  return caster_of(std::move(scene));
}

// Places in the hall, among them some with conveyors beside and half behind the camera.
std::vector<Pose> hall_poses() {
  std::vector<Pose> poses;
  for (const double yaw : {0.0, 0.9, 2.2, -1.3, 3.0}) {
    for (const double x : {-4.0, -1.0, 1.2}) {
      Pose X_BC = Pose::Identity();
      X_BC.linear() = rotation_from_rpy(0, 0.5, 0) * optical_from_forward();
      X_BC.translation().z() = 1.3;
      poses.push_back(make_upright_pose(x, 0.4, 0, yaw) * X_BC);
    }
  }
  return poses;
}

void expect_as_alone(const RayCaster& caster, const PictureRays& rays, const ObjectView& view) {
  const cv::Size size(rays.intrinsics.width, rays.intrinsics.height);
  const cv::Mat reference = alone(caster, rays, view.id);
  const cv::Mat inside = reference(cv::Rect(size.width, size.height, size.width, size.height));
  const cv::Mat mask = in_picture(view, size);
  EXPECT_EQ(cv::norm(mask, inside, cv::NORM_L1), 0.0) << view.id;
  EXPECT_EQ(cv::countNonZero(inside), view.amodal_px);
  const cv::Rect box = box_around(reference, -cv::Point(size));
  const auto total = static_cast<double>(cv::countNonZero(reference));
  if (view.beyond_step == 1) {
    EXPECT_EQ(static_cast<double>(view.amodal_px_total), total);
    EXPECT_EQ(view.amodal_box, box);
  } else {
    EXPECT_NEAR(static_cast<double>(view.amodal_px_total), total, 0.02 * total + 2.0 * view.beyond_step * view.beyond_step);
    EXPECT_LE(std::abs(view.amodal_box.x - box.x), view.beyond_step);
    EXPECT_LE(std::abs(view.amodal_box.br().x - box.br().x), view.beyond_step);
    EXPECT_LE(std::abs(view.amodal_box.y - box.y), view.beyond_step);
    EXPECT_LE(std::abs(view.amodal_box.br().y - box.br().y), view.beyond_step);
  }
}

TEST(ObjectViews, AreThoseOfAHallWithoutTheRest) {
  const auto caster = crowded_hall();
  const Intrinsics camera = Intrinsics::from_field_of_view(120, 90, 1.5, 1.2);
  Renderer renderer(caster, {});
  RenderRequest request;
  request.colour = false;
  int seen = 0, hidden = 0, cut = 0, listed = 0;
  for (const Pose& X_WC : hall_poses()) {
    const PictureRays rays = pinhole_rays(camera, X_WC, 0.5f);
    const cv::Mat instances = renderer.render(camera, X_WC, request).instances;
    const auto views = object_views(*caster, rays, instances);
    int visible = 0;
    std::vector<int> ids;
    for (const ObjectView& view : views) {
      ids.push_back(view.id);
      expect_as_alone(*caster, rays, view);
      // What is seen of it is a part of what it covers.
      const cv::Mat shown = instances == view.id;
      EXPECT_EQ(cv::countNonZero(shown & ~in_picture(view, instances.size())), 0);
      EXPECT_EQ(cv::countNonZero(shown), view.visible_px);
      EXPECT_EQ(box_around(shown, {0, 0}), view.visible_box);
      EXPECT_NEAR(view.visible(), (1.0 - view.truncated()) * (1.0 - view.occluded()), 1e-12);
      visible += view.visible_px;
      seen += view.visible_px > 0 ? 1 : 0;
      hidden += view.occluded() > 0.0 ? 1 : 0;
      cut += view.truncated() > 0.0 ? 1 : 0;
      ++listed;
    }
    // Every pixel belongs to one object at most: together they are all pixels of objects.
    EXPECT_EQ(visible, cv::countNonZero(instances));
    for (const TrueObject& object : caster->scene().objects) {
      if (std::find(ids.begin(), ids.end(), object.id) != ids.end()) continue;
      EXPECT_LE(cv::countNonZero(alone(*caster, rays, object.id)), 4) << "object " << object.id << " is left out";
    }
  }
  EXPECT_GE(seen, 10);
  EXPECT_GE(hidden, 5);
  EXPECT_GE(cut, 10);
  EXPECT_GE(listed, 20);
}

// Rows at their own times from a camera that drives, through a lens that bends: the rays are far from the pinhole's.
TEST(ObjectViews, TakeAnyRays) {
  const auto caster = crowded_hall();
  const Intrinsics camera = Intrinsics::from_field_of_view(120, 90, 1.5, 1.2);
  int listed = 0;
  for (const Pose& X_WC : hall_poses()) {
    PictureRays rays = pinhole_rays(camera, X_WC, 0.5f);
    rays.at = [&, X_WC](int u, int v) {
      const Pose X_WC_row = X_WC * Pose(Eigen::Translation3d(0.002 * (v - 45), 0, 0.001 * (v - 45)));
      const Eigen::Vector3d d = camera.ray(u, v);
      const bool inside = u >= 0 && v >= 0 && u < camera.width && v < camera.height;
      const double bend = inside ? 1.0 - 0.08 * d.head<2>().squaredNorm() : 1.0;
      Ray ray;
      ray.origin = (inside ? X_WC_row : X_WC).translation().cast<float>();
      ray.direction = (X_WC.linear() * Eigen::Vector3d(bend * d.x(), bend * d.y(), 1.0)).cast<float>();
      return ray;
    };
    for (const ObjectView& view : views_of(*caster, rays)) {
      expect_as_alone(*caster, rays, view);
      listed += view.amodal_px > 0 ? 1 : 0;
    }
  }
  EXPECT_GE(listed, 10);
}

// A real camera's picture, taken row by row through its lens while it drives past a post that moves: the rays give the labels of the
// picture to the pixel, and what is seen is a part of what is covered.
TEST(ObjectViews, AgreeWithTheColourCamera) {
  Scene scene = busy_hall(8);
  const int post = add_instance(scene, add_mesh(scene, unit_box(), add_material(scene, {1, 0, 0})));
  const auto caster = std::make_shared<RayCaster>(std::make_shared<const Scene>(std::move(scene)));
  caster->set_shutter(0, 50'000'000);
  caster->set_motion(post, placed({-1.2f, -1.5f, 0}, {0.1f, 0.1f, 1.5f}), placed({-1.0f, -1.5f, 0}, {0.1f, 0.1f, 1.5f}));
  caster->commit();
  Renderer renderer(caster, {});
  constexpr Stamp kStamp = 25'000'000;
  int seen = 0, hidden = 0;
  for (const bool rectify : {true, false}) {
    CameraConfig config = CameraConfig::make("azure_kinect");
    config.width = 320;
    config.height = 180;
    config.colour.rectify = rectify;
    ASSERT_TRUE(config.colour.rolling_shutter);
    ColourCamera camera(config, 1, "camera", renderer);
    const auto X_WC = [](Stamp stamp) {
      const double t = to_seconds(stamp);
      Pose X_BC = Pose::Identity();
      X_BC.linear() = rotation_from_rpy(0, 0.5, 0) * optical_from_forward();
      X_BC.translation().z() = 1.3;
      return make_upright_pose(-1.0 + 1.0 * t, 0.3, 0, -1.5 + 2.0 * t) * X_BC;
    };
    const cv::Mat instances = camera.look(kStamp, X_WC, false).instances;
    const PictureRays rays = camera.picture_rays(kStamp, X_WC);
    EXPECT_EQ(cv::norm(labels(*caster, rays), instances, cv::NORM_L1), 0.0);
    const PictureRays pinhole = pinhole_rays(rays.intrinsics, X_WC(kStamp), 0.5f);
    EXPECT_GT(cv::countNonZero(labels(*caster, pinhole) != instances), 20) << "the effects are there";
    for (const ObjectView& view : object_views(*caster, rays, instances)) {
      expect_as_alone(*caster, rays, view);
      EXPECT_EQ(cv::countNonZero((instances == view.id) & ~in_picture(view, instances.size())), 0);
      seen += view.visible_px > 0 ? 1 : 0;
      hidden += view.occluded() > 0.0 ? 1 : 0;
    }
  }
  EXPECT_GE(seen, 2);
  EXPECT_GE(hidden, 1);
}

TEST(ObjectViews, AreTheSameAtAnyNumberOfThreads) {
  const auto caster = crowded_hall();
  const Intrinsics camera = Intrinsics::from_field_of_view(120, 90, 1.5, 1.2);
  std::size_t listed = 0;
  for (const Pose& X_WC : hall_poses()) {
    const PictureRays rays = pinhole_rays(camera, X_WC, 0.5f);
    const cv::Mat instances = labels(*caster, rays);
    set_thread_count(1);
    const auto one = object_views(*caster, rays, instances);
    listed += one.size();
    for (const int threads : {2, 4}) {
      set_thread_count(threads);
      const auto many = object_views(*caster, rays, instances);
      ASSERT_EQ(many.size(), one.size());
      for (std::size_t i = 0; i < one.size(); ++i) {
        EXPECT_EQ(many[i].id, one[i].id);
        EXPECT_EQ(many[i].visible_px, one[i].visible_px);
        EXPECT_EQ(many[i].amodal_px, one[i].amodal_px);
        EXPECT_EQ(many[i].amodal_px_total, one[i].amodal_px_total);
        EXPECT_EQ(many[i].amodal_box, one[i].amodal_box);
        ASSERT_EQ(many[i].mask_box, one[i].mask_box);
        EXPECT_EQ(many[i].amodal_mask.empty(), one[i].amodal_mask.empty());
        if (one[i].amodal_mask.empty()) continue;
        EXPECT_EQ(cv::norm(many[i].amodal_mask, one[i].amodal_mask, cv::NORM_L1), 0.0);
      }
    }
  }
  set_thread_count(0);
  EXPECT_GE(listed, 20u);
}

TEST(PixelExtent, IsTheSmallestBoxOfAnId) {
  cv::Mat_<std::uint16_t> ids = cv::Mat_<std::uint16_t>::zeros(10, 12);
  ids(2, 3) = ids(5, 7) = ids(5, 8) = 4;
  ids(9, 11) = 65535;
  const auto extents = extents_of(ids);
  ASSERT_EQ(extents.size(), 2u);
  EXPECT_EQ(extents.at(4).box(), cv::Rect(3, 2, 6, 4));
  EXPECT_EQ(extents.at(4).pixels, 3);
  EXPECT_EQ(extents.at(65535).box(), cv::Rect(11, 9, 1, 1));
  EXPECT_TRUE(PixelExtent().box().empty());
}

}  // namespace
}  // namespace waretwin

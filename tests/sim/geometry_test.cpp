// Depth, instances, classes and normals against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"
#include "sim/renderer.h"
#include "sim/surfaces.h"
#include "tests/sim/fixtures.h"

namespace waretwin {
namespace {

using fixtures::add_instance;
using fixtures::add_material;
using fixtures::add_mesh;
using fixtures::add_object;
using fixtures::caster_of;
using fixtures::looking;
using fixtures::placed;

Intrinsics small_camera() { return Intrinsics::from_field_of_view(203, 151, to_radians(80), to_radians(60)); }

FrameImages geometry(const std::shared_ptr<const RayCaster>& caster, const Intrinsics& intrinsics, const Pose& X_WC) {
  RenderRequest request;
  request.colour = false;
  request.classes = request.normals = true;
  return Renderer(caster, {}).render(intrinsics, X_WC, request);
}

// Depth of a plane with unit normal n through q along the optical axis.
double plane_depth(const Pose& X_WC, const Eigen::Vector3d& ray_C, const Eigen::Vector3d& n, const Eigen::Vector3d& q) {
  return n.dot(q - X_WC.translation()) / n.dot(X_WC.linear() * ray_C);
}

TEST(Depth, CornerOfThreePlanes) {
  const auto caster = caster_of(fixtures::room(-3, 9, -4, 4, 5));
  for (const Pose& X_WC : {looking({5, 1, 1.4}, 0.3, 0.4, 0.1), looking({-1, -2, 2.2}, 2.5, -0.2, 0.7), looking({0, 0, 1}, 0, 0)}) {
    const Intrinsics k = small_camera();
    const FrameImages images = geometry(caster, k, X_WC);
    for (int v = 0; v < k.height; ++v) {
      for (int u = 0; u < k.width; ++u) {
        // A convex room: the wall met first is the nearest plane ahead.
        double expected = 1e9;
        for (const auto& [n, q] : {std::pair<Eigen::Vector3d, Eigen::Vector3d>{{1, 0, 0}, {9, 0, 0}},
                                   {{1, 0, 0}, {-3, 0, 0}},
                                   {{0, 1, 0}, {0, 4, 0}},
                                   {{0, 1, 0}, {0, -4, 0}},
                                   {{0, 0, 1}, {0, 0, 5}},
                                   {{0, 0, 1}, {0, 0, 0}}}) {
          const double z = plane_depth(X_WC, k.ray(u, v), n, q);
          if (z > 0) expected = std::min(expected, z);
        }
        ASSERT_NEAR(images.depth.at<float>(v, u), expected, 1e-5 * expected) << u << " " << v;
      }
    }
  }
}

TEST(Depth, SphereWithinItsTessellation) {
  constexpr int kSteps = 120;
  Scene scene;
  add_instance(scene, add_mesh(scene, fixtures::unit_sphere(kSteps), add_material(scene, {1, 1, 1})),
               placed({3, 0.2f, 1}, {0.8f, 0.8f, 0.8f}));
  const Pose X_WC = looking({0, 0, 1.2});
  const Intrinsics k = small_camera();
  const FrameImages images = geometry(caster_of(std::move(scene)), k, X_WC);
  // A facet lies inside the sphere by at most its sagitta, r (1 - cos(pi / steps)) for the long edge of a facet.
  const double sagitta = 0.8 * (1.0 - std::cos(std::numbers::pi / kSteps));
  int inside = 0;
  for (int v = 0; v < k.height; ++v) {
    for (int u = 0; u < k.width; ++u) {
      const Eigen::Vector3d d = X_WC.linear() * k.ray(u, v), m = X_WC.translation() - Eigen::Vector3d(3, 0.2, 1);
      const double a = d.squaredNorm(), b = m.dot(d), c = m.squaredNorm() - 0.64;
      const double discriminant = b * b - a * c;
      if (discriminant < 0.0) {
        ASSERT_EQ(images.depth.at<float>(v, u), 0.0f);
        continue;
      }
      const double z = (-b - std::sqrt(discriminant)) / a;
      const Eigen::Vector3d n = (m + z * d) / 0.8;
      const double cosine = -n.dot(d) / std::sqrt(a);
      if (cosine < 0.3) continue;  // the rim, where a facet's edge decides
      ++inside;
      ASSERT_GE(images.depth.at<float>(v, u), z * (1 - 1e-5));
      ASSERT_LE(images.depth.at<float>(v, u), z + sagitta / cosine / std::sqrt(a) * 1.05 + 1e-5 * z);
    }
  }
  EXPECT_GT(inside, 1000);
}

TEST(Depth, SameSurfaceThroughMirroredAndScaledInstances) {
  // The box from (0,0,0) to (1,1,1), mirrored in x and stretched: it covers x in [2, 4].
  Scene scene;
  const int object = add_object(scene, "box");
  const int mesh = add_mesh(scene, fixtures::unit_box(), add_material(scene, {1, 1, 1}));
  const Eigen::Affine3f X_WM = Eigen::Translation3f(4, -1, 0.5f) * Eigen::Scaling(-2.0f, 3.0f, 1.5f);
  add_instance(scene, mesh, X_WM, object);
  const auto caster = caster_of(std::move(scene));
  const Pose X_WC = looking({0, 0, 1});
  const Intrinsics k = small_camera();
  const FrameImages images = geometry(caster, k, X_WC);
  int hits = 0;
  for (int v = 0; v < k.height; ++v) {
    for (int u = 0; u < k.width; ++u) {
      const Eigen::Vector3d p = X_WC * (2.0 * k.ray(u, v));  // on the front face's plane
      const bool in_face = p.y() > -1 && p.y() < 2 && p.z() > 0.5 && p.z() < 2;
      ASSERT_EQ(images.instances.at<std::uint16_t>(v, u), in_face ? 1 : 0);
      ASSERT_EQ(images.classes.at<std::uint16_t>(v, u), in_face ? 1 : 0);
      if (!in_face) continue;
      ++hits;
      ASSERT_NEAR(images.depth.at<float>(v, u), 2.0, 2e-5);
      const cv::Vec3f n = images.normals.at<cv::Vec3f>(v, u);
      ASSERT_NEAR(n[0], 0, 1e-5);
      ASSERT_NEAR(n[1], 0, 1e-5);
      ASSERT_NEAR(n[2], -1, 1e-5);
    }
  }
  EXPECT_GT(hits, 3000);
}

TEST(Depth, ObjectsKeepTheirIdsAndClasses) {
  Scene scene = fixtures::room(-1, 6, -3, 3, 3);
  const int mesh = add_mesh(scene, fixtures::unit_box(), add_material(scene, {1, 1, 1}));
  const int a = add_object(scene, "crate"), b = add_object(scene, "pallet"), c = add_object(scene, "crate");
  add_instance(scene, mesh, placed({3, -1.5f, 0.5f}, {1, 1, 1}), a);
  add_instance(scene, mesh, placed({3, -0.5f, 0.5f}, {1, 1, 1}), b);
  add_instance(scene, mesh, placed({3, 0.5f, 0.5f}, {1, 1, 1}), c);
  EXPECT_EQ(class_names(scene), (std::vector<std::string>{"background", "crate", "pallet"}));
  const Intrinsics k = small_camera();
  const FrameImages images = geometry(caster_of(std::move(scene)), k, looking({0, 0, 1}));
  const auto pixel_of = [&k](double y, double z) {
    const Eigen::Vector2d p = k.project({-y, 1 - z, 3});
    return cv::Point(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y())));
  };
  const std::array<std::array<double, 3>, 4> expected = {{{-1, 1, 1}, {0, 2, 2}, {1, 3, 1}, {1.8, 0, 0}}};
  for (const auto& [y, id, label] : expected) {
    EXPECT_EQ(images.instances.at<std::uint16_t>(pixel_of(y, 1)), static_cast<int>(id));
    EXPECT_EQ(images.classes.at<std::uint16_t>(pixel_of(y, 1)), static_cast<int>(label));
  }
}

TEST(RayCaster, AlphaMaskMakesHoles) {
  Scene scene;
  Texture texture;  // 8 x 1 texels, every other one a hole
  texture.width = 8;
  texture.height = 1;
  texture.nearest = true;
  for (int i = 0; i < 8; ++i) {
    for (const int value : {255, 255, 255, i % 2 == 0 ? 255 : 0}) texture.rgba.push_back(static_cast<std::uint8_t>(value));
  }
  scene.textures.push_back(texture);
  const int material = add_material(scene, {1, 1, 1});
  scene.materials.back().alpha_mask = true;
  scene.materials.back().base_colour_texture.texture = 0;
  Mesh fence;
  fixtures::add_quad(fence, {0, 0, 0}, {0, 8, 0}, {0, 8, 1}, {0, 0, 1});
  add_instance(scene, add_mesh(scene, fence, material));
  const auto caster = caster_of(std::move(scene));
  for (int i = 0; i < 80; ++i) {
    Ray ray;
    ray.origin = {-1, 0.05f + 0.1f * static_cast<float>(i), 0.5f};
    const bool solid = (i / 10) % 2 == 0;
    EXPECT_EQ(caster->cast(ray).valid(), solid) << i;
    EXPECT_EQ(caster->occluded(ray), solid) << i;
  }
}

TEST(RayCaster, BothSidesOfASingleSidedSheet) {
  Scene scene;
  Mesh sheet;
  fixtures::add_quad(sheet, {0, -1, -1}, {0, 1, -1}, {0, 1, 1}, {0, -1, 1});
  add_instance(scene, add_mesh(scene, sheet, add_material(scene, {1, 1, 1})));
  const auto caster = caster_of(std::move(scene));
  Ray ray;
  ray.origin = {-2, 0.1f, 0};
  EXPECT_NEAR(caster->cast(ray).distance, 2, 1e-6);
  ray.origin.x() = 2;
  ray.direction = -Eigen::Vector3f::UnitX();
  EXPECT_NEAR(caster->cast(ray).distance, 2, 1e-6);
}

TEST(RayCaster, NoRaySlipsThroughSharedEdges) {
  // A closed sphere seen from its centre: every ray must hit, also those that aim at vertices and edges.
  Scene scene;
  const Mesh sphere = fixtures::unit_sphere(24);
  add_instance(scene, add_mesh(scene, sphere, add_material(scene, {1, 1, 1})));
  const auto caster = caster_of(std::move(scene));
  std::vector<Ray> rays;
  for (std::size_t t = 0; t < sphere.triangles.size(); t += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3f a = sphere.positions[sphere.triangles[t + k]], b = sphere.positions[sphere.triangles[t + (k + 1) % 3]];
      for (const Eigen::Vector3f& target : {a, Eigen::Vector3f(0.5f * (a + b)), Eigen::Vector3f(0.3f * a + 0.7f * b)}) {
        Ray ray;
        ray.direction = target;
        rays.push_back(ray);
      }
    }
  }
  std::vector<Hit> hits(rays.size());
  caster->cast(rays, hits);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    EXPECT_TRUE(hits[i].valid());
    EXPECT_TRUE(caster->occluded(rays[i]));
  }
}

TEST(RayCaster, PacketsAgreeWithSingleRaysAndWithEveryTriangle) {
  Scene scene;
  const RandomStream random(7, "test", "soup");
  Mesh soup;
  const auto point = [&random](std::uint64_t i) {
    const auto a = random.uniform_pair(i, 0), b = random.uniform_pair(i, 1);
    return Eigen::Vector3f(a[0], a[1], b[0]);
  };
  for (std::uint64_t i = 0; i < 60; ++i) {
    const Eigen::Vector3f c = 4.0f * point(4 * i);
    fixtures::add_triangle(soup, c + point(4 * i + 1), c + point(4 * i + 2), c + point(4 * i + 3));
  }
  add_instance(scene, add_mesh(scene, soup, add_material(scene, {1, 1, 1})));
  const auto caster = caster_of(std::move(scene));
  std::vector<Ray> rays;
  for (std::uint64_t i = 0; i < 1003; ++i) {
    Ray ray;
    ray.origin = 6.0f * point(10000 + 2 * i) - Eigen::Vector3f::Ones();
    ray.direction = 5.0f * point(10001 + 2 * i) - ray.origin;
    rays.push_back(ray);
  }
  std::vector<Hit> hits(rays.size());
  std::vector<std::uint8_t> blocked(rays.size());
  caster->cast(rays, hits, Coherence::kCoherent);
  caster->occluded(rays, blocked);
  int found = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Hit one = caster->cast(rays[i]);
    EXPECT_EQ(one.valid(), hits[i].valid());
    EXPECT_EQ(one.primitive, hits[i].primitive);
    if (one.valid()) {
      EXPECT_NEAR(one.distance, hits[i].distance, 1e-5f * one.distance);
    }
    EXPECT_EQ(blocked[i] != 0, one.valid());
    // Every triangle in turn, in doubles (Cramer's rule).
    double nearest = 1e9;
    int primitive = -1;
    bool close_call = false;
    for (std::size_t t = 0; t < soup.triangles.size(); t += 3) {
      const Eigen::Vector3d a = soup.positions[t].cast<double>(), b = soup.positions[t + 1].cast<double>(),
                            c = soup.positions[t + 2].cast<double>();
      Eigen::Matrix3d m;
      m << b - a, c - a, -rays[i].direction.cast<double>();
      const Eigen::Vector3d x = m.inverse() * (rays[i].origin.cast<double>() - a);
      const double margin = std::min({x[0], x[1], 1 - x[0] - x[1]});
      if (x[2] > 0 && std::abs(margin) < 1e-5) close_call = true;
      if (x[2] > 0 && margin >= 0 && x[2] < nearest) {
        nearest = x[2];
        primitive = static_cast<int>(t / 3);
      }
    }
    if (close_call) continue;
    EXPECT_EQ(one.primitive, primitive);
    found += primitive >= 0 ? 1 : 0;
  }
  EXPECT_GT(found, 150);
}

TEST(RayCaster, MovesInstances) {
  Scene scene;
  const int box =
      add_instance(scene, add_mesh(scene, fixtures::unit_box(), add_material(scene, {1, 1, 1})), placed({1, -0.5f, -0.5f}, {1, 1, 1}));
  RayCaster caster(std::make_shared<const Scene>(std::move(scene)));
  EXPECT_NEAR(caster.cast(Ray{}).distance, 1, 1e-6);
  caster.set_transform(box, placed({3, -0.5f, -0.5f}, {1, 1, 1}));
  caster.commit();
  EXPECT_NEAR(caster.cast(Ray{}).distance, 3, 1e-6);
  EXPECT_NEAR(caster.bounds().max().x(), 4, 1e-5);
}

TEST(RayCaster, InstancesMoveEvenlyDuringTheShutter) {
  Scene scene;
  const int mesh = add_mesh(scene, fixtures::unit_box(), add_material(scene, {1, 1, 1}));
  const int box = add_instance(scene, mesh, placed({1, -0.5f, -0.5f}, {1, 1, 1}));
  add_instance(scene, mesh, placed({8, -5, -5}, {1, 10, 10}));
  RayCaster caster(std::make_shared<const Scene>(std::move(scene)));
  EXPECT_EQ(caster.time_of(5), 0.5f) << "an empty shutter";
  caster.set_shutter(1000, 3000);
  caster.set_motion(box, placed({1, -0.5f, -0.5f}, {1, 1, 1}), placed({3, -0.5f, -0.5f}, {1, 1, 1}));
  caster.commit();
  std::vector<Ray> rays;
  for (const Stamp moment : {0, 1000, 1500, 2000, 2750, 3000, 9000}) {
    Ray ray;
    ray.time = caster.time_of(moment);
    const float share = std::clamp(static_cast<float>(moment - 1000) / 2000.0f, 0.0f, 1.0f);
    EXPECT_EQ(ray.time, share);
    EXPECT_NEAR(caster.cast(ray).distance, 1.0f + 2.0f * share, 1e-5f);
    rays.push_back(ray);
  }
  std::vector<Hit> hits(rays.size());
  caster.cast(rays, hits);
  for (std::size_t i = 0; i < rays.size(); ++i) EXPECT_NEAR(hits[i].distance, 1.0f + 2.0f * rays[i].time, 1e-5f);
  EXPECT_NEAR(caster.transform(box).translation().x(), 2.0f, 1e-6f) << "the middle of the shutter";

  caster.set_present(box, false);
  caster.commit();
  EXPECT_NEAR(caster.cast(Ray{}).distance, 8.0f, 1e-5f);
  caster.set_present(box, true);
  caster.set_transform(box, placed({5, -0.5f, -0.5f}, {1, 1, 1}));
  caster.commit();
  EXPECT_NEAR(caster.cast(rays.back()).distance, 5.0f, 1e-5f) << "no motion is left over";
}

TEST(RayCaster, RejectsWhatItCannotUse) {
  EXPECT_THROW(RayCaster(std::make_shared<const Scene>()), Error);
  const auto scene = std::make_shared<const Scene>(fixtures::room(0, 1, 0, 1, 1));
  EXPECT_THROW(RayCaster(scene, {.isa = "mmx"}), Error);
  RayCaster oldest(scene, {.isa = "sse2"});
  Ray ray;
  ray.origin = {0.5f, 0.5f, 0.5f};
  EXPECT_NEAR(oldest.cast(ray).distance, 0.5, 1e-6);
}

TEST(Renderer, SameBytesAtAnyThreadCount) {
  // Pairs of coincident surfaces of different objects and colours: only a fixed tree decides which one is seen.
  Scene scene = fixtures::busy_hall(16);
  const int red = add_material(scene, {0.9f, 0.1f, 0.1f}), blue = add_material(scene, {0.1f, 0.1f, 0.9f});
  Mesh sheets[2];
  for (int i = 0; i < 400; ++i) {
    const float y = -2.0f + 0.2f * static_cast<float>(i % 20), z = 0.1f + 0.15f * static_cast<float>(i / 20);
    for (Mesh& sheet : sheets) fixtures::add_quad(sheet, {2, y, z}, {2, y, z + 0.2f}, {2, y + 0.3f, z + 0.2f}, {2, y + 0.3f, z});
  }
  const int first = add_object(scene, "sheet"), second = add_object(scene, "sheet");
  add_instance(scene, add_mesh(scene, sheets[0], red), Eigen::Affine3f::Identity(), first);
  add_instance(scene, add_mesh(scene, sheets[1], blue), Eigen::Affine3f::Identity(), second);
  const auto shared = std::make_shared<const Scene>(std::move(scene));
  const Intrinsics k = Intrinsics::from_field_of_view(333, 187, to_radians(90), to_radians(59));
  for (const char* quality : {"fast", "path"}) {
    std::vector<FrameImages> all;
    for (const int threads : {1, 2, 4}) {
      set_thread_count(threads);
      RenderOptions options;
      options.quality = quality;
      options.samples = 2;
      all.push_back(Renderer(std::make_shared<const RayCaster>(shared), options).render(k, looking({-2, 0.3, 1.2}, 0.1, 0.2), {}));
    }
    set_thread_count(0);
    for (const FrameImages& images : all) {
      EXPECT_EQ(std::memcmp(images.colour.data, all[0].colour.data, images.colour.total() * images.colour.elemSize()), 0) << quality;
      EXPECT_EQ(std::memcmp(images.depth.data, all[0].depth.data, images.depth.total() * images.depth.elemSize()), 0);
      EXPECT_EQ(std::memcmp(images.instances.data, all[0].instances.data, images.instances.total() * images.instances.elemSize()), 0);
    }
  }
}

TEST(Renderer, PictureDependsOnItsOwnKeyAlone) {
  const auto caster = caster_of(fixtures::busy_hall(8));
  const Intrinsics k = small_camera();
  RenderRequest request;
  request.stamp = 5;
  Renderer used(caster, {});
  used.render(Intrinsics::from_field_of_view(64, 48, 1, 1), looking({1, 0, 2}), {});
  const cv::Mat after = used.render(k, looking({-2, 0, 1.2}), request).colour;
  const cv::Mat fresh = Renderer(caster, {}).render(k, looking({-2, 0, 1.2}), request).colour;
  EXPECT_EQ(std::memcmp(after.data, fresh.data, after.total() * after.elemSize()), 0);
  request.stamp = 6;
  const cv::Mat later = used.render(k, looking({-2, 0, 1.2}), request).colour;
  EXPECT_NE(std::memcmp(after.data, later.data, after.total() * after.elemSize()), 0);
}

TEST(Renderer, RejectsAnUnknownQuality) {
  RenderOptions options;
  options.quality = "best";
  EXPECT_THROW(Renderer(caster_of(fixtures::room(0, 1, 0, 1, 1)), options), Error);
}

}  // namespace
}  // namespace waretwin

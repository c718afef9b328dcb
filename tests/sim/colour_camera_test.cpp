// Colour pictures against closed forms: where the lens, the shutter and the exposure put things, and that labels follow.
#include "sim/colour_camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>

#include "core/parallel.h"
#include "sensors/tone_curve.h"
#include "tests/sim/fixtures.h"

namespace waretwin {
namespace {

using fixtures::add_instance;
using fixtures::add_material;
using fixtures::add_mesh;
using fixtures::add_object;
using fixtures::caster_of;
using fixtures::looking;

// All effects off but what a test asks for.
CameraConfig quiet(int width = 640, int height = 360) {
  CameraConfig camera;
  camera.width = width;
  camera.height = height;
  camera.colour.set_ideal();
  return camera;
}

// The same with a focal length of 320 pixels whatever its size: a part of the picture costs less.
CameraConfig cut_out(int width, int height) {
  CameraConfig camera = quiet(width, height);
  camera.horizontal_fov_deg = to_degrees(2.0 * std::atan(width / 640.0));
  camera.vertical_fov_deg = to_degrees(2.0 * std::atan(height / 640.0));
  return camera;
}

// Shines by itself and reflects nothing, so that its pixels have one value.
int add_glowing(Scene& scene, const Eigen::Vector3f& radiance) {
  const int material = add_material(scene, {0, 0, 0});
  scene.materials.back().emissive = radiance;
  return material;
}

// A wall at x = 4 m, an object of radiance 1 on one side of an edge through (4, 0, 1) and black on the other: y > 0, or z < 1.
Scene half_white_wall(bool vertical) {
  Scene scene;
  Mesh white, black;
  if (vertical) {
    fixtures::add_quad(white, {4, 0, -9}, {4, 0, 9}, {4, 19, 9}, {4, 19, -9});
    fixtures::add_quad(black, {4, 0, -9}, {4, 0, 9}, {4, -19, 9}, {4, -19, -9});
  } else {
    fixtures::add_quad(white, {4, -19, 1}, {4, 19, 1}, {4, 19, -19}, {4, -19, -19});
    fixtures::add_quad(black, {4, -19, 1}, {4, 19, 1}, {4, 19, 19}, {4, -19, 19});
  }
  const int object = add_object(scene, "white");
  add_instance(scene, add_mesh(scene, white, add_glowing(scene, {1, 1, 1})), Eigen::Affine3f::Identity(), object);
  add_instance(scene, add_mesh(scene, black, add_glowing(scene, {0, 0, 0})));
  scene.ambient = scene.background = {0, 0, 0};
  return scene;
}

RenderOptions quality(const char* name, int samples = 1) {
  RenderOptions options;
  options.quality = name;
  options.samples = samples;
  options.bounces = 0;
  return options;
}

bool same_bytes(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && std::memcmp(a.data, b.data, a.total() * a.elemSize()) == 0;
}

Pose driving(Stamp stamp) {
  const double t = to_seconds(stamp);
  return looking({-2.0 + 0.6 * t, 0.3, 1.2}, 0.1 + 0.5 * t, 0.4);
}

TEST(ColourCamera, WithoutEffectsItIsTheRenderersPicture) {
  const auto caster = caster_of(fixtures::busy_hall(16));
  for (const char* name : {"fast", "path"}) {
    Renderer renderer(caster, quality(name));
    for (const char* preset : {"ideal", "azure_kinect_gaussian"}) {
      CameraConfig camera = CameraConfig::make(preset);
      camera.width = 320;
      camera.height = 180;
      RenderRequest request;
      request.seed = 9;
      request.sensor = "eye";
      request.stamp = 123'000'000;
      request.classes = true;
      const FrameImages plain = renderer.render(camera.intrinsics(), driving(request.stamp), request);
      const FrameImages images = ColourCamera(camera, 9, "eye", renderer).look(request.stamp, driving, true, true);
      EXPECT_TRUE(same_bytes(images.colour, plain.colour)) << name;
      EXPECT_TRUE(same_bytes(images.depth, plain.depth));
      EXPECT_TRUE(same_bytes(images.instances, plain.instances));
      EXPECT_TRUE(same_bytes(images.classes, plain.classes));
    }
  }
}

TEST(ColourCamera, RadianceIsWhatTheColoursAreMadeOf) {
  Renderer renderer(caster_of(fixtures::busy_hall(16)), {});
  RenderRequest request;
  request.radiance = true;
  const FrameImages images = renderer.render(quiet(320, 180).intrinsics(), driving(0), request);
  for (int v = 0; v < 180; ++v) {
    for (int u = 0; u < 320; ++u) {
      const cv::Vec4f light = images.radiance.at<cv::Vec4f>(v, u);
      ASSERT_EQ(images.colour.at<cv::Vec3b>(v, u), cv::Vec3b(tone_mapped(light[2]), tone_mapped(light[1]), tone_mapped(light[0])));
    }
  }
}

TEST(ColourCamera, LensPutsPointsWhereItProjectsThem) {
  // Small glowing squares on a wall, named by their object; the middle of their pixels is where the lens projects theirs.
  Scene scene;
  const int glowing = add_glowing(scene, {1, 1, 1});
  std::vector<Eigen::Vector3d> centres;
  for (float y = -3.6f; y < 3.7f; y += 0.9f) {
    for (float z = -1.8f; z < 1.9f; z += 0.9f) {
      Mesh square;
      fixtures::add_quad(square, {4, y - 0.05f, z - 0.05f}, {4, y + 0.05f, z - 0.05f}, {4, y + 0.05f, z + 0.05f},
                         {4, y - 0.05f, z + 0.05f});
      add_instance(scene, add_mesh(scene, square, glowing), Eigen::Affine3f::Identity(), add_object(scene, "square"));
      centres.emplace_back(4, y, z);
    }
  }
  CameraConfig camera = quiet(1280, 720);
  camera.colour.lens_distortion = true;
  camera.colour.rectify = false;
  const Lens lens = camera.view();
  Renderer renderer(caster_of(std::move(scene)), {});
  const Pose X_WC = looking({0, 0, 0});
  const FrameImages images = ColourCamera(camera, 1, "camera", renderer)
                                 .look(
                                     0, [&](Stamp) { return X_WC; }, true);
  std::vector<Eigen::Vector2d> sums(centres.size() + 1, Eigen::Vector2d::Zero());
  std::vector<int> counts(centres.size() + 1, 0);
  for (int v = 0; v < 720; ++v) {
    for (int u = 0; u < 1280; ++u) {
      const std::uint16_t id = images.instances.at<std::uint16_t>(v, u);
      ASSERT_EQ(images.colour.at<cv::Vec3b>(v, u)[0] > 0, id > 0);
      if (id == 0) continue;
      sums[id] += Eigen::Vector2d(u, v);
      ++counts[id];
      ASSERT_NEAR(images.depth.at<float>(v, u), 4.0, 1e-4);
    }
  }
  double farthest = 0.0;
  for (std::size_t i = 0; i < centres.size(); ++i) {
    ASSERT_GT(counts[i + 1], 100);
    const Eigen::Vector2d expected = *lens.project(X_WC.inverse() * centres[i]);
    EXPECT_LT((sums[i + 1] / counts[i + 1] - expected).norm(), 0.5) << centres[i].transpose();
    farthest = std::max(farthest, (expected - lens.intrinsics().project(X_WC.inverse() * centres[i])).norm());
  }
  EXPECT_GT(farthest, 20.0);  // the lens did something
}

TEST(ColourCamera, RectifiedEdgesAreStraightAndWhereAPinholeHasThem) {
  // Bars of 0.4 m on a wall, along z and along y; in path quality an edge's pixels say how much of them is covered, and the tone curve is
  // nearly straight between bars and background.
  for (const bool vertical : {true, false}) {
    Scene scene;
    const int glowing = add_glowing(scene, {0.7f, 0.7f, 0.7f});
    Mesh bars;
    std::vector<double> edges;
    for (float a = -3.8f; a < 3.9f; a += 0.8f) {
      const float b = a + 0.4f;
      edges.push_back(static_cast<double>(a));
      edges.push_back(static_cast<double>(b));
      if (vertical) {
        fixtures::add_quad(bars, {4, a, -9}, {4, b, -9}, {4, b, 9}, {4, a, 9});
      } else {
        fixtures::add_quad(bars, {4, -9, a}, {4, -9, b}, {4, 9, b}, {4, 9, a});
      }
    }
    add_instance(scene, add_mesh(scene, bars, glowing), Eigen::Affine3f::Identity(), add_object(scene, "bar"));
    scene.background = {0.5f, 0.5f, 0.5f};
    CameraConfig camera = quiet(320, 180);
    camera.colour.lens_distortion = true;
    const Intrinsics k = camera.intrinsics();
    Renderer renderer(caster_of(std::move(scene)), quality("path", 36));
    const Pose X_WC = looking({0, 0, 0});
    const FrameImages images = ColourCamera(camera, 1, "camera", renderer)
                                   .look(
                                       0, [&](Stamp) { return X_WC; }, true);
    const int half = (tone_mapped(0.5f) + tone_mapped(0.7f)) / 2, lines = vertical ? 180 : 320, places = vertical ? 320 : 180;
    int found = 0;
    for (const double edge : edges) {
      const Eigen::Vector2d pixel = k.project(X_WC.inverse() * Eigen::Vector3d(4, vertical ? edge : 0, vertical ? 0 : edge));
      const double expected = vertical ? pixel.x() : pixel.y();
      if (expected < 3 || expected > places - 4) continue;
      for (int line = 0; line < lines; ++line) {
        const auto value = [&](int place) {
          return static_cast<int>(vertical ? images.colour.at<cv::Vec3b>(line, place)[0] : images.colour.at<cv::Vec3b>(place, line)[0]);
        };
        // The crossing of one half near the expected place.
        double at = -1.0;
        for (int place = static_cast<int>(expected) - 2; place < static_cast<int>(expected) + 3; ++place) {
          if ((value(place) < half) != (value(place + 1) < half)) {
            at = place + static_cast<double>(half - value(place)) / (value(place + 1) - value(place));
          }
        }
        ASSERT_NEAR(at, expected, 0.5) << vertical << " line " << line;
        ++found;
      }
    }
    EXPECT_GT(found, 1500);
  }
}

TEST(ColourCamera, RowsSeeTheCameraAtTheirTime) {
  CameraConfig camera = quiet();
  camera.colour.rolling_shutter = true;
  const Intrinsics k = camera.intrinsics();
  Renderer renderer(caster_of(half_white_wall(true)), {});
  ColourCamera eye(camera, 1, "camera", renderer);
  EXPECT_EQ(eye.row_delay(359) - eye.row_delay(0), from_seconds(camera.colour.readout_s));
  EXPECT_EQ(eye.row_delay(359), -eye.row_delay(0));
  const double omega = 1.5;
  const Stamp stamp = 100'000'000;
  const FrameImages images = eye.look(
      stamp,
      [&](Stamp at) {
        return looking({0, 0, 1}, omega * (to_seconds(at) - 0.1));
      },
      true);
  // Turning to the left by omega * t moves the edge to the right, f * tan(omega * t).
  const auto edge = [&](int v) { return k.cx + k.fx * std::tan(omega * camera.colour.readout_s * (v - 179.5) / 359.0); };
  EXPECT_NEAR(edge(359) - edge(0), k.fx * omega * camera.colour.readout_s, 0.01);
  EXPECT_GT(edge(359) - edge(0), 9.0);
  for (int v = 0; v < 360; ++v) {
    for (int u = 300; u < 340; ++u) {
      if (std::abs(u - edge(v)) < 0.01) continue;
      ASSERT_EQ(images.instances.at<std::uint16_t>(v, u), u < edge(v) ? 1 : 0) << u << " " << v;
      ASSERT_EQ(images.colour.at<cv::Vec3b>(v, u)[1], u < edge(v) ? tone_mapped(1.0f) : 0) << u << " " << v;
    }
  }
}

// The white share of pixel v's exposure, counted moment by moment: edge(t) is where the edge is, white lies below it.
double white_share(double v, double middle_s, double exposure_s, const std::function<double(double)>& edge) {
  constexpr int kMoments = 2000;
  int white = 0;
  for (int i = 0; i < kMoments; ++i) white += v > edge(middle_s + exposure_s * ((i + 0.5) / kMoments - 0.5)) ? 1 : 0;
  return static_cast<double>(white) / kMoments;
}

TEST(ColourCamera, EdgesAreBlurredAsWideAsTheyMove) {
  CameraConfig camera = cut_out(100, 30);
  camera.colour.motion_blur = true;
  camera.colour.exposure_s = 0.02;
  const Intrinsics k = camera.intrinsics();
  const auto caster = caster_of(half_white_wall(true));
  struct Case {
    double turn_rad_s, sideways_mps;
  };
  for (const char* name : {"fast", "path"}) {
    Renderer renderer(caster, quality(name, 64));
    ColourCamera eye(camera, 1, "camera", renderer);
    for (const Case& c : {Case{2.0, 0.0}, {0.7, 0.0}, {-1.2, 0.0}, {0.0, 3.0}}) {
      const auto X_WC = [&](Stamp at) { return looking({0, -c.sideways_mps * to_seconds(at), 1}, c.turn_rad_s * to_seconds(at)); };
      const FrameImages images = eye.look(0, X_WC, true);
      // Moving right brings the edge to the left, f v / z.
      const double width = std::abs(k.fx * (c.turn_rad_s - c.sideways_mps / 4.0) * camera.colour.exposure_s);
      EXPECT_GT(width, 4.0);
      for (const int v : {0, 14, 29}) {
        for (int u = 0; u < 100; ++u) {
          // White on the left: covered by 1 from half a width before the edge.
          const double share = std::clamp(0.5 - (u - k.cx) / width, 0.0, 1.0);
          const double inexact = 0.6 / width + 0.02;  // a pixel's own half, sampled or as a whole
          const auto low = tone_mapped(static_cast<float>(share - inexact)), high = tone_mapped(static_cast<float>(share + inexact));
          ASSERT_GE(images.colour.at<cv::Vec3b>(v, u)[0], share == 1.0 ? tone_mapped(0.999f) - 1 : low - 1)
              << name << " " << width << " " << u;
          ASSERT_LE(images.colour.at<cv::Vec3b>(v, u)[0], share == 0.0 && std::abs(u - k.cx) > 0.5 * width + 1.0 ? 0 : high + 1)
              << name << " " << width << " " << u;
        }
      }
    }
  }
}

TEST(ColourCamera, BlurAlongTheColumnsMeetsTheRollingShutter) {
  // The camera pitches; a level edge runs with the rows' readout or against it, which stretches or shortens its blur.
  CameraConfig camera = cut_out(30, 360);
  camera.colour.motion_blur = camera.colour.rolling_shutter = true;
  camera.colour.exposure_s = 0.02;
  camera.colour.readout_s = 0.2;
  const Intrinsics k = camera.intrinsics();
  const auto caster = caster_of(half_white_wall(false));
  for (const char* name : {"fast", "path"}) {
    Renderer renderer(caster, quality(name, 64));
    ColourCamera eye(camera, 1, "camera", renderer);
    for (const double omega : {-1.6, 1.6}) {
      const FrameImages images = eye.look(
          0,
          [&](Stamp at) {
            return looking({0, 0, 1}, 0.0, omega * to_seconds(at));
          },
          true);
      const auto edge = [&](double t) { return k.cy - k.fy * std::tan(omega * t); };
      int between = 0;
      for (int v = 150; v < 210; ++v) {
        const double share = white_share(v, camera.colour.readout_s * (v - 179.5) / 359.0, camera.colour.exposure_s, edge);
        between += share > 0.0 && share < 1.0 ? 1 : 0;
        const float inexact = 0.08f;
        EXPECT_GE(images.colour.at<cv::Vec3b>(v, 15)[0], tone_mapped(static_cast<float>(share) - inexact) - 1) << name << " " << v;
        EXPECT_LE(images.colour.at<cv::Vec3b>(v, 15)[0], tone_mapped(static_cast<float>(share) + inexact) + 1) << name << " " << v;
      }
      const double still = k.fy * 1.6 * camera.colour.exposure_s, rate = -omega * k.fy * camera.colour.readout_s / 359.0;
      EXPECT_NEAR(between, still / (1.0 - rate), 1.5);
    }
  }
}

TEST(ColourCamera, LabelsAreThoseOfTheColours) {
  // Every object shines in a colour of its own and nothing mixes them but resampling.
  Scene scene = fixtures::busy_hall(8);
  scene.lights.clear();
  scene.ambient = scene.background = {0, 0, 0};
  for (Material& material : scene.materials) {
    material.base_colour = {0, 0, 0, 1};
    material.metallic = 0.0f;
    material.roughness = 1.0f;
    material.base_colour_texture.texture = -1;
  }
  std::vector<cv::Vec3b> colour_of = {{0, 0, 0}};
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const Eigen::Vector3f light(0.1f + 0.2f * static_cast<float>(i), 0.9f - 0.2f * static_cast<float>(i), 0.4f);
    colour_of.emplace_back(tone_mapped(light.z()), tone_mapped(light.y()), tone_mapped(light.x()));
    const int material = add_glowing(scene, light);
    for (Instance& instance : scene.instances) {
      if (instance.object != static_cast<int>(i)) continue;
      scene.meshes.push_back(scene.meshes[static_cast<std::size_t>(instance.mesh)]);
      scene.meshes.back().material = material;
      instance.mesh = static_cast<int>(scene.meshes.size()) - 1;
    }
  }
  for (bool rectify : {false, true}) {
    CameraConfig camera = quiet(640, 360);
    camera.colour.lens_distortion = camera.colour.rolling_shutter = true;
    camera.colour.rectify = rectify;
    Renderer renderer(caster_of(scene), {});
    const FrameImages images = ColourCamera(camera, 1, "camera", renderer).look(0, driving, true, true);
    int labelled = 0, mixed = 0;
    for (int v = 1; v < 359; ++v) {
      for (int u = 1; u < 639; ++u) {
        const std::uint16_t id = images.instances.at<std::uint16_t>(v, u);
        ASSERT_EQ(images.classes.at<std::uint16_t>(v, u), id > 0 ? 1 : 0);
        labelled += id > 0 ? 1 : 0;
        bool alone = true;
        for (int y = v - 1; y <= v + 1; ++y) {
          for (int x = u - 1; x <= u + 1; ++x) alone = alone && images.instances.at<std::uint16_t>(y, x) == id;
        }
        if (alone || !rectify) {
          ASSERT_EQ(images.colour.at<cv::Vec3b>(v, u), colour_of[id]) << u << " " << v;
        } else {
          ++mixed;
        }
      }
    }
    EXPECT_GT(labelled, 1000);
    EXPECT_GT(mixed, rectify ? 300 : -1);
  }
}

TEST(ColourCamera, RowsSeeMovingThingsAtTheirTime) {
  // The camera stands, a board slides sideways by 6 m/s: its edge leans, its depth does not, and in quality path it is blurred.
  Scene scene;
  Mesh board;
  fixtures::add_quad(board, {0, 0, -9}, {0, 0, 9}, {0, 19, 9}, {0, 19, -9});
  add_instance(scene, add_mesh(scene, board, add_glowing(scene, {1, 1, 1})), Eigen::Affine3f::Identity(), add_object(scene, "board"));
  scene.ambient = scene.background = {0, 0, 0};
  const auto caster = std::make_shared<RayCaster>(std::make_shared<const Scene>(std::move(scene)));
  CameraConfig camera = cut_out(200, 60);
  camera.colour.rolling_shutter = camera.colour.motion_blur = true;
  const Intrinsics k = camera.intrinsics();
  const Stamp stamp = 400'000'000;
  const double speed = 6.0;
  for (const char* name : {"fast", "path"}) {
    Renderer renderer(caster, quality(name, 64));
    ColourCamera eye(camera, 1, "camera", renderer);
    const Stamp span = eye.half_span();
    EXPECT_EQ(span, from_seconds(0.5 * camera.colour.readout_s + 0.5 * camera.colour.exposure_s));
    const auto at = [&](Stamp when) {
      Eigen::Affine3f X = Eigen::Affine3f::Identity();
      X.translation() = Eigen::Vector3f(4, static_cast<float>(speed * to_seconds(when - stamp)), 0);
      return X;
    };
    caster->set_shutter(stamp - span, stamp + span);
    caster->set_motion(0, at(stamp - span), at(stamp + span));
    caster->commit();
    const FrameImages images = eye.look(
        stamp,
        [](Stamp) {
          return looking({0, 0, 1});
        },
        true);
    const auto edge = [&](double after_s) { return k.cx - k.fx * speed * after_s / 4.0; };
    EXPECT_GT(edge(-0.01) - edge(0.01), 9.0);
    for (int v = 0; v < 60; ++v) {
      const double middle = camera.colour.readout_s * (v - 29.5) / 59.0;
      for (int u = 80; u < 120; ++u) {
        const cv::Vec3b seen = images.colour.at<cv::Vec3b>(v, u);
        if (std::abs(u - edge(middle)) > 0.02) {
          ASSERT_EQ(images.instances.at<std::uint16_t>(v, u), u < edge(middle) ? 1 : 0) << name << " " << u << " " << v;
        }
        if (std::abs(u - edge(0.0)) > 0.02) {
          ASSERT_EQ(images.depth.at<float>(v, u) > 0.0f, u < edge(0.0)) << name;
        }
        if (std::string(name) == "fast") continue;
        const double width = edge(-0.5 * camera.colour.exposure_s) - edge(0.5 * camera.colour.exposure_s);
        const double share = std::clamp(0.5 - (u - edge(middle)) / width, 0.0, 1.0);
        const double inexact = 0.6 / width + 0.02;  // a pixel's own half
        ASSERT_GE(seen[0], tone_mapped(static_cast<float>(share - inexact)) - 1) << u << " " << v;
        ASSERT_LE(seen[0], tone_mapped(static_cast<float>(share + inexact)) + 1) << u << " " << v;
        if (share > 0.2 && share < 0.8) {
          ASSERT_GT(seen[0], 20);
          ASSERT_LT(seen[0], tone_mapped(0.98f));
        }
      }
    }
  }
}

TEST(ColourCamera, DepthIsThatOfTheStampInTheView) {
  const auto caster = caster_of(fixtures::busy_hall(16));
  Renderer renderer(caster, {});
  CameraConfig camera;
  camera.width = 320;
  camera.height = 180;
  RenderRequest request;
  request.colour = false;
  const cv::Mat ideal = renderer.render(camera.intrinsics(), driving(7'000'000), request).depth;
  EXPECT_TRUE(same_bytes(ColourCamera(camera, 1, "camera", renderer).look(7'000'000, driving, true).depth, ideal));
  // Unrectified, a pixel's depth lies along its own ray: depth times ray, seen from outside, is on the same walls.
  camera.colour.rectify = false;
  const Lens view = camera.view();
  const cv::Mat bent = ColourCamera(camera, 1, "camera", renderer).look(7'000'000, driving, true).depth;
  int checked = 0;
  for (int v = 3; v < 180; v += 7) {
    for (int u = 2; u < 320; u += 7) {
      const float z = bent.at<float>(v, u);
      ASSERT_GT(z, 0.0f);
      Ray ray;
      ray.origin = driving(7'000'000).translation().cast<float>();
      ray.direction = (driving(7'000'000).linear() * *view.ray(u, v)).cast<float>();
      ASSERT_NEAR(caster->cast(ray).distance, z, 1e-4f * z);
      ++checked;
    }
  }
  EXPECT_GT(checked, 1000);
}

TEST(ColourCamera, PicturesAreTheSameAtAnyThreadCountAndInAnyOrder) {
  const auto scene = std::make_shared<const Scene>(fixtures::busy_hall(16));
  CameraConfig camera;
  camera.width = 333;
  camera.height = 187;
  for (const char* name : {"fast", "path"}) {
    std::vector<FrameImages> all;
    for (const int threads : {1, 2, 4}) {
      set_thread_count(threads);
      Renderer renderer(std::make_shared<const RayCaster>(scene), quality(name, 2));
      ColourCamera eye(camera, 1, "camera", renderer);
      if (threads > 1) eye.look(5, driving, true);  // another picture before
      all.push_back(eye.look(66'000'000, driving, true, true));
    }
    set_thread_count(0);
    for (const FrameImages& images : all) {
      EXPECT_TRUE(same_bytes(images.colour, all[0].colour)) << name;
      EXPECT_TRUE(same_bytes(images.depth, all[0].depth));
      EXPECT_TRUE(same_bytes(images.instances, all[0].instances));
      EXPECT_TRUE(same_bytes(images.classes, all[0].classes));
    }
  }
}

}  // namespace
}  // namespace waretwin

// Belts and what they carry.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "sim/motion/belt_surface.h"
#include "sim/motion/hall_motion.h"
#include "sim/motion/held.h"
#include "tests/sim/motion_scene.h"

namespace waretwin {
namespace {

using fixtures::MotionScene;

BeltConfig belt_of(const std::string& object, double speed, double heading_deg = 0.0) {
  BeltConfig belt;
  belt.object = object;
  belt.speed_mps = speed;
  belt.heading_deg = heading_deg;
  return belt;
}

ItemStream parcels(double x, double y, double z, int most) {
  ItemStream stream;
  stream.name = "parcel";
  stream.x_m = x;
  stream.y_m = y;
  stream.z_m = z;
  stream.most = most;
  stream.body.friction = 0.6;
  return stream;
}

TEST(BeltSurface, IsReadFromTheTriangles) {
  MotionScene hall;
  const double yaw = 0.3;
  hall.add_conveyor("c1", 1.0, 2.0, yaw, 3.0, 0.5, 0.75, 0.06);
  const auto caster = hall.caster();
  // A heading that is a little off runs along the side all the same.
  const auto found = find_belt_surfaces(*caster, belt_of("c*", 0.5, to_degrees(yaw) + 8.0), 0);
  ASSERT_EQ(found.size(), 1u);
  const BeltSurface& belt = found[0];
  EXPECT_NEAR(belt.top, 0.75, 1e-4);
  EXPECT_NEAR(belt.length, 3.0, 1e-4);
  EXPECT_NEAR(belt.left, 0.25, 0.005);
  EXPECT_NEAR(belt.right, -0.25, 0.005);
  EXPECT_NEAR(belt.left_guard, 0.06, 1e-4);
  EXPECT_NEAR(belt.right_guard, 0.06, 1e-4);
  EXPECT_NEAR(belt.direction.x(), std::cos(yaw), 1e-9);
  const Eigen::Vector2d at = belt.coordinates(belt.point(1.2, -0.1));
  EXPECT_NEAR(at.x(), 1.2, 1e-9);
  EXPECT_NEAR(at.y(), -0.1, 1e-9);
  EXPECT_NEAR((belt.point(0.0, 0.0) - Eigen::Vector2d(1.0, 2.0)).norm(), 0.0, 1e-4);
  EXPECT_TRUE(belt.carries(belt.point(2.9, 0.2)));
  EXPECT_FALSE(belt.carries(belt.point(3.1, 0.2)));
}

TEST(BeltSurface, CoordinatesOfAnArc) {
  BeltSurface arc;
  arc.curve = true;
  arc.pivot = {1.0, -1.0};
  arc.radius = 2.0;
  arc.first_angle = 3.0;  // runs across the seam of atan2
  arc.length = 2.0 * 1.2;
  for (const double along : {0.0, 0.7, 2.4}) {
    const Eigen::Vector2d p = arc.point(along, 0.3), at = arc.coordinates(p);
    EXPECT_NEAR(at.x(), along, 1e-9);
    EXPECT_NEAR(at.y(), 0.3, 1e-9);
    EXPECT_NEAR(arc.travel(p).dot(p - arc.pivot), 0.0, 1e-9);
    EXPECT_NEAR(arc.speed_factor(p), 1.7 / 2.0, 1e-9);
  }
  EXPECT_LT(arc.coordinates(arc.point(-0.1, 0.0)).x(), 0.0);
  EXPECT_GT(arc.coordinates(arc.point(2.5, 0.0)).x(), 2.4);
}

TEST(Belts, UnknownObjectsAreRefused) {
  MotionScene hall;
  hall.add_conveyor("c1", 0, 0, 0, 2, 0.5, 0.7, 0);
  hall.scenario.motion.belts = {belt_of("d*", 0.5)};
  const auto caster = hall.caster();
  try {
    HallMotion motion(hall.scenario, *caster);
    FAIL() << "d* is no object";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("motion.belts.0.object 'd*'"), std::string::npos) << error.what();
  }
}

TEST(Belts, CarryAtTheirSpeedAndHandOver) {
  MotionScene hall;
  // Two belts in a row and one across, at three speeds; a sink at the end.
  hall.add_conveyor("a", 0.0, 0.0, 0.0, 2.0, 0.5, 0.75, 0.05);
  hall.add_conveyor("b", 2.01, 0.0, 0.0, 3.0, 0.5, 0.75, 0.05);
  MotionConfig& motion = hall.scenario.motion;
  motion.belts = {belt_of("a", 0.3), belt_of("b", 0.5)};
  motion.streams = {parcels(0.3, 0.0, 0.752, 4)};
  motion.streams[0].every_s = 4.0;
  ItemSink sink;
  sink.x_m = 4.9;
  sink.z_m = 0.8;
  motion.sinks = {sink};
  for (int i = 0; i < 4; ++i) hall.add_mover("parcel", {0.4f, 0.3f, 0.2f});
  const auto caster = hall.caster();
  HallMotion moves(hall.scenario, *caster);
  moves.advance_to(from_seconds(40.0));
  const MotionReport report = moves.report();
  EXPECT_EQ(report.items_in, 11);
  EXPECT_GE(report.items_delivered, 7);
  EXPECT_EQ(report.items_fell_off, 0);
  EXPECT_EQ(report.items_fell_through, 0);
  EXPECT_EQ(report.items_in, report.items_delivered + report.items_in_hall);
  ASSERT_EQ(report.belts.size(), 2u);
  for (const BeltReport& belt : report.belts) {
    EXPECT_NEAR(belt.mean_ratio, 1.0, 0.01) << belt.name;
    EXPECT_NEAR(belt.worst_ratio, 1.0, 0.01) << belt.name;
    EXPECT_GT(belt.carried_s, 10.0);
  }
}

TEST(Belts, StopAndStart) {
  MotionScene hall;
  hall.add_conveyor("a", 0.0, 0.0, 0.0, 6.0, 0.5, 0.75, 0.05);
  MotionConfig& motion = hall.scenario.motion;
  motion.belts = {belt_of("a", 0.4)};
  motion.belts[0].changes = {{.at_s = 4.0, .speed_mps = 0.0}, {.at_s = 6.0, .speed_mps = -0.4}};
  motion.belts[0].acceleration_mps2 = 0.8;
  motion.streams = {parcels(1.0, 0.0, 0.751, 1)};
  hall.add_mover("parcel", {0.4f, 0.3f, 0.2f});
  const auto caster = hall.caster();
  HallMotion moves(hall.scenario, *caster);
  const auto x_at = [&](double time_s) {
    moves.advance_to(from_seconds(time_s));
    return static_cast<double>(moves.moment(from_seconds(time_s), from_seconds(time_s)).movers[0].X_WG_end.translation().x());
  };
  const double x2 = x_at(2.0), x3 = x_at(3.0), x4 = x_at(4.0), x5 = x_at(5.0), x6 = x_at(6.0), x7 = x_at(7.0), x8 = x_at(8.0);
  EXPECT_NEAR(x3 - x2, 0.4, 0.002);
  EXPECT_NEAR(x5 - x4, 0.4 * 0.4 / (2 * 0.8), 0.004) << "braked at 0.8 m/s^2";
  EXPECT_NEAR(x6 - x5, 0.0, 0.001);
  EXPECT_NEAR(x8 - x7, -0.4, 0.002);
}

TEST(Belts, NoObjectRunsTwice) {
  MotionScene hall;
  hall.add_conveyor("c1", 0, 0, 0, 2, 0.5, 0.7, 0);
  hall.scenario.motion.belts = {belt_of("c*", 0.5), belt_of("c1", 0.3)};
  const auto caster = hall.caster();
  EXPECT_THROW(HallMotion(hall.scenario, *caster), Error);
}

TEST(Belts, ClutterThatLiesOnABeltStartsWithIt) {
  MotionScene hall;
  hall.add_conveyor("a", 0.0, 0.0, 0.0, 6.0, 0.5, 0.75, 0.05);
  MotionConfig& motion = hall.scenario.motion;
  motion.belts = {belt_of("a", 0.0)};
  motion.belts[0].changes = {{.at_s = 8.0, .speed_mps = 0.3}};
  ClutterConfig thing;
  thing.name = "thing";
  thing.x_m = 2.0;
  thing.z_m = 0.85;
  thing.spread_x_m = thing.spread_y_m = 0.01;
  motion.clutter = {thing};
  hall.add_mover("thing", {0.12f, 0.10f, 0.05f});
  const auto caster = hall.caster();
  HallMotion moves(hall.scenario, *caster);
  const auto x_at = [&](double time_s) {
    moves.advance_to(from_seconds(time_s));
    return static_cast<double>(moves.moment(from_seconds(time_s), from_seconds(time_s)).movers[0].X_WG_end.translation().x());
  };
  const double still = x_at(7.9), begun = x_at(10.0), later = x_at(14.0);
  EXPECT_NEAR(still, 2.0, 0.1);
  EXPECT_NEAR(later - begun, 4.0 * 0.3, 0.01);
}

TEST(Items, APlaceInTheHallIsTakenByAnotherWithoutASweep) {
  // One place for an item: the next comes in at the infeed as soon as the one before has left at the other end.
  MotionScene hall;
  hall.add_conveyor("a", 0.0, 0.0, 0.0, 3.0, 0.5, 0.75, 0.05);
  MotionConfig& motion = hall.scenario.motion;
  motion.belts = {belt_of("a", 0.5)};
  motion.streams = {parcels(0.4, 0.0, 0.751, 1)};
  motion.streams[0].every_s = 1.0;
  ItemSink sink;
  sink.x_m = 2.6;
  sink.z_m = 0.85;
  motion.sinks = {sink};
  hall.add_mover("parcel", {0.3f, 0.3f, 0.2f});
  const auto caster = hall.caster();
  HallMotion moves(hall.scenario, *caster);
  for (int i = 2; i <= 600; ++i) {
    const Stamp end = from_seconds(0.02 * i), begin = end - 50'000'000;
    moves.advance_to(end);
    const auto place = moves.moment(begin, end).movers[0];
    if (!place.present) continue;
    EXPECT_LT((place.X_WG_end.translation() - place.X_WG_begin.translation()).norm(), 0.5f * 0.05f + 0.01f);
  }
  EXPECT_GE(moves.report().items_delivered, 2);
}

TEST(Belts, ASteepStopSlides) {
  // A belt that stops at once under a parcel with friction mu: it slides on v^2 / (2 mu g).
  MotionScene hall;
  hall.add_conveyor("a", 0.0, 0.0, 0.0, 6.0, 0.5, 0.75, 0.0);
  MotionConfig& motion = hall.scenario.motion;
  motion.belts = {belt_of("a", 1.0)};
  motion.belts[0].friction = 0.3;
  motion.belts[0].acceleration_mps2 = 100.0;
  motion.belts[0].changes = {{.at_s = 3.0, .speed_mps = 0.0}};
  motion.streams = {parcels(0.5, 0.0, 0.751, 1)};
  motion.streams[0].yaw_spread_deg = 0.0;
  hall.add_mover("parcel", {0.4f, 0.3f, 0.05f});
  const auto caster = hall.caster();
  HallMotion moves(hall.scenario, *caster);
  const auto x_at = [&](double time_s) {
    moves.advance_to(from_seconds(time_s));
    return static_cast<double>(moves.moment(from_seconds(time_s), from_seconds(time_s)).movers[0].X_WG_end.translation().x());
  };
  const double before = x_at(3.0), after = x_at(5.0);
  EXPECT_NEAR(after - before, 1.0 / (2 * 0.3 * 9.81), 0.015);
}

TEST(Items, SidesHoldAndWhatHasNoneLetsFall) {
  // A belt whose parcels are steered against its side: turned by 20 deg on a belt that runs straight, they stay between rails.
  for (const double rail : {0.05, 0.0}) {
    MotionScene hall;
    hall.add_conveyor("a", 0.0, 0.0, 0.0, 6.0, 0.4, 0.75, rail);
    // Pushed sideways by a walker that crosses slowly beside the belt.
    MotionConfig& motion = hall.scenario.motion;
    motion.belts = {belt_of("a", 0.3)};
    motion.streams = {parcels(0.5, 0.0, 0.751, 1)};
    hall.add_mover("parcel", {0.3f, 0.3f, 0.2f});
    WalkerConfig pusher;
    pusher.name = "pusher";
    pusher.loop = false;
    pusher.speed_mps = 0.1;
    Waypoint from, to;
    from.x_m = 2.0;
    from.y_m = -1.0;
    from.heading_deg = 90;
    to.x_m = 2.0;
    to.y_m = rail > 0.0 ? -0.32 : 0.1;  // leaves a held parcel 0.37 m between itself and the far rail
    pusher.path = {from, to};
    motion.walkers = {pusher};
    hall.add_mover("pusher", {0.3f, 3.0f, 1.2f});
    const auto caster = hall.caster();
    HallMotion moves(hall.scenario, *caster);
    moves.advance_to(from_seconds(16.0));
    EXPECT_EQ(moves.report().items_fell_off, rail > 0.0 ? 0 : 1);
    EXPECT_EQ(moves.report().items_fell_through, 0);
  }
}

TEST(Items, ClutterSettlesAndStaysWhateverTheSeed) {
  MotionScene hall;
  hall.add_box({2.0f, 2.0f, 0.0f}, {1.0f, 1.0f, 0.7f});
  ClutterConfig thing;
  thing.name = "tool";
  thing.count = 6;
  thing.x_m = thing.y_m = 2.5;
  thing.z_m = 1.0;
  hall.scenario.motion.clutter = {thing};
  hall.scenario.motion.settle_s = 4.0;
  for (int i = 0; i < 6; ++i) hall.add_mover("tool", {0.2f, 0.05f, 0.04f});
  const auto caster = hall.caster();
  HallMotion moves(hall.scenario, *caster);
  moves.advance_to(from_seconds(0.1));
  const HallMoment early = moves.moment(0, 0);
  moves.advance_to(from_seconds(5.0));
  const HallMoment late = moves.moment(from_seconds(5.0), from_seconds(5.0));
  for (std::size_t i = 0; i < 6; ++i) {
    ASSERT_TRUE(early.movers[i].present);
    EXPECT_LT((early.movers[i].X_WG_end.matrix() - late.movers[i].X_WG_end.matrix()).norm(), 2e-3f) << "it lies still";
    EXPECT_GT(early.movers[i].X_WG_end.translation().z(), -0.03f);
  }
  hall.scenario.seed = 99;
  const auto caster2 = hall.caster();
  HallMotion again(hall.scenario, *caster2);
  again.advance_to(from_seconds(0.1));
  EXPECT_EQ(again.moment(0, 0).movers[3].X_WG_end.matrix(), early.movers[3].X_WG_end.matrix());
}

TEST(Walkers, GoRoundAndPushAside) {
  MotionScene hall;
  WalkerConfig walker;
  walker.name = "picker";
  Waypoint a, b;
  a.x_m = 0.0;
  b.x_m = 3.0;
  walker.path = {a, b};
  hall.scenario.motion.walkers = {walker};
  hall.add_mover("picker", {0.4f, 0.6f, 1.8f});
  const auto caster = hall.caster();
  HallMotion moves(hall.scenario, *caster);
  float farthest = 0.0f;
  for (int i = 1; i <= 300; ++i) {
    moves.advance_to(from_seconds(0.1 * i));
    const auto place = moves.moment(from_seconds(0.1 * i - 0.02), from_seconds(0.1 * i)).movers[0];
    EXPECT_TRUE(place.present);
    EXPECT_NEAR(place.X_WG_end.translation().y(), 0.0f, 1e-5f);
    EXPECT_LT((place.X_WG_end.translation() - place.X_WG_begin.translation()).norm(), 1.2f * 0.02f + 1e-4f);
    farthest = std::max(farthest, place.X_WG_end.translation().x());
    moves.moment(from_seconds(0.1 * i), from_seconds(0.1 * i)).show(*caster);
    Ray ray;
    ray.origin = {-5.0f, 0.0f, 1.0f};
    EXPECT_LT(caster->cast(ray).distance, 10.0f) << "it is where it can be seen";
  }
  EXPECT_NEAR(farthest, 3.0f, 0.01f);
}

TEST(Held, StandsStillInOnePlaceAfterTheOther) {
  MotionScene hall;
  WalkerConfig walker;
  Waypoint a;
  a.x_m = 5.0;
  walker.path = {a};
  hall.scenario.motion.walkers = {walker};
  HeldConfig board;
  board.stand = "stand.glb";
  board.hold_s = 2.0;
  board.move_s = 0.5;
  board.places = {{.x_m = 1.0, .y_m = 0.0, .z_m = 0.5, .yaw_deg = 180.0},
                  {.x_m = 2.0, .y_m = 1.0, .z_m = 0.5, .yaw_deg = 90.0, .tilt_deg = 30.0},
                  {.x_m = 3.0, .y_m = 0.0, .z_m = 0.7, .roll_deg = 20.0}};
  hall.scenario.motion.held = {board};
  hall.add_mover("walker", {0.4f, 0.6f, 1.8f});
  hall.add_mover("board", {0.02f, 0.8f, 0.6f});
  hall.add_mover("stand", {0.1f, 0.1f, 0.4f});
  const auto caster = hall.caster();
  HallMotion moves(hall.scenario, *caster);
  const auto place = [&](double time_s, std::size_t mover) {
    moves.advance_to(from_seconds(time_s));
    return moves.moment(from_seconds(time_s), from_seconds(time_s)).movers[mover].X_WG_end;
  };
  EXPECT_TRUE(place(0.5, 1).translation().isApprox(Eigen::Vector3f(1.0f, 0.0f, 0.5f), 1e-6f));
  EXPECT_TRUE(place(2.0, 1).translation().isApprox(Eigen::Vector3f(1.0f, 0.0f, 0.5f), 1e-6f));
  EXPECT_TRUE(place(2.25, 1).translation().isApprox(Eigen::Vector3f(1.5f, 0.5f, 0.5f), 1e-4f)) << "half way";
  for (const double time_s : {2.5, 3.5, 4.5}) {
    EXPECT_TRUE(place(time_s, 1).translation().isApprox(Eigen::Vector3f(2.0f, 1.0f, 0.5f), 1e-5f)) << time_s;
  }
  // Facing y, leaning back by 30 deg: the face looks up by as much; its stand does not.
  const auto second = held_X_WG(board, 3.0), stand = stand_X_WG(board, 3.0);
  EXPECT_TRUE(second.linear().col(0).isApprox(Eigen::Vector3d(0.0, std::cos(to_radians(30.0)), 0.5), 1e-9));
  EXPECT_TRUE(stand.linear().col(0).isApprox(Eigen::Vector3d::UnitY(), 1e-9));
  EXPECT_TRUE(stand.translation().isApprox(second.translation(), 1e-12));
  EXPECT_TRUE(place(60.0, 1).translation().isApprox(Eigen::Vector3f(3.0f, 0.0f, 0.7f), 1e-5f)) << "it stays in its last place";
  EXPECT_TRUE(place(60.0, 2).linear().isApprox(Eigen::Matrix3f::Identity(), 1e-5f));
  EXPECT_TRUE(place(60.0, 0).translation().isApprox(Eigen::Vector3f(5.0f, 0.0f, 0.0f), 1e-5f)) << "the walker is who it was";
}

TEST(HallMotion, SameSeedSameBytesOtherSeedOthers) {
  MotionScene hall;
  hall.add_conveyor("a", 0.0, 0.0, 0.0, 3.0, 0.5, 0.75, 0.05);
  hall.scenario.motion.belts = {belt_of("a", 0.3)};
  hall.scenario.motion.streams = {parcels(0.3, 0.0, 0.80, 3)};
  for (int i = 0; i < 3; ++i) hall.add_mover("parcel", {0.3f, 0.2f, 0.2f});
  const auto digest = [&] {
    const auto caster = hall.caster();
    HallMotion moves(hall.scenario, *caster);
    moves.advance_to(from_seconds(12.0));
    return moves.digest();
  };
  const std::string first = digest();
  EXPECT_EQ(first, digest());
  hall.scenario.seed = 2;
  EXPECT_NE(first, digest());
}

}  // namespace
}  // namespace waretwin

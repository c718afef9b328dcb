// What a camera on a vehicle could see at all: points on surfaces, places where a vehicle can stand, lines of sight between them.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/pose.h"
#include "scenes/scenario.h"
#include "sensors/camera_config.h"
#include "sim/ray_caster.h"

namespace waretwin {

struct SurfaceSample {
  Eigen::Vector3f p_W;
  Eigen::Vector3f normal;  // outwards where the mesh winds counter-clockwise; either side counts
  bool viewable = false;   // find_viewable
  bool seen = false;       // the caller's to set
};

// `count` points spread over the triangles of all instances of an object (an index into Scene::objects; `id` is its TrueObject::id) in
// proportion to area, the same in every run.
std::vector<SurfaceSample> sample_surface(const RayCaster& caster, int object, int id, int count);

// Where the robot can stand: a grid of `spacing` metres inside the hall's bounds, those with nothing between 3 cm above the floor and the
// robot's height within half its diagonal (searched with rays, so a thin post may be missed).
std::vector<Eigen::Vector2f> free_places(const RayCaster& caster, const RobotConfig& robot, double spacing);

// From the eye almost to the sample, or an empty ray (far < near) where it is seen at a flatter angle than 5 deg.
Ray sight(const Eigen::Vector3f& eye, const SurfaceSample& sample);

// The height of an eye over the places, and the straight-line distances at which it sees; metres.
struct Lookout {
  float height = 0.0f, least = 0.0f, reach = 0.0f;
};

// Marks the samples that an eye sees from one of the places, with nothing in between.
void find_viewable(const RayCaster& caster, std::span<SurfaceSample> samples, const std::vector<Eigen::Vector2f>& places,
                   const std::vector<Lookout>& lookouts);

// Indices of the samples that are viewable, not yet seen, and seen by a frame of the camera at X_WC: in the image and the depth field,
// within the depth range, with nothing in between of the hall (nullptr: an empty one) and of the vehicle's own shape, if there is one.
struct VehicleInView {
  const RayCaster* shape_B = nullptr;
  Pose X_WB = Pose::Identity();
};
std::vector<std::size_t> seen_in_frame(const RayCaster* hall, std::span<const SurfaceSample> samples, const CameraConfig& camera,
                                       const Pose& X_WC, const VehicleInView& own_body = {});

}  // namespace waretwin

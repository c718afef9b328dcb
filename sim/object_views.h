// What a picture shows of each true object, and what it would show of it if nothing stood before it.
//
// An object's amodal pixels are those whose ray meets the object in a hall where nothing else stands; its visible pixels are those that the
// instance image gives it. Both come from the same rays, so a visible pixel is always an amodal one. The picture is thought to go on beyond
// its border by its own width and height on each side; what an object covers there counts, too. Holes of alpha-masked surfaces cover
// nothing.
#pragma once

#include <cstdint>
#include <functional>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "core/pose.h"
#include "sensors/intrinsics.h"
#include "sim/ray_caster.h"

namespace waretwin {

// The rays of one picture.
struct PictureRays {
  // A pinhole camera near the rays: tells where to look for an object. The closer it is to the rays, the fewer of them are cast.
  Intrinsics intrinsics;
  Pose X_WC = Pose::Identity();
  // The ray that gave pixel (u, v) its id; beyond the picture, from (-width, -height) to (2 width - 1, 2 height - 1), the ray along which
  // it would go on. Directions have z = 1 in the camera's frame. May be called from several threads at once.
  std::function<Ray(int u, int v)> at;
};

// Of an ideal camera, all pixels at one moment: `time` as Ray::time.
PictureRays pinhole_rays(const Intrinsics& intrinsics, const Pose& X_WC, float time);

// Boxes are in whole pixels: x and y are the first column and row, so that a box of width w ends with column x + w - 1.
struct ObjectView {
  int id = 0;  // TrueObject::id
  int visible_px = 0;
  int amodal_px = 0;                  // in the picture
  std::int64_t amodal_px_total = 0;   // with what lies beyond the picture; at least 1
  cv::Rect visible_box;               // around the visible pixels; empty where there are none
  cv::Rect amodal_box;                // around all amodal pixels, also beyond the picture
  cv::Rect mask_box;                  // around the amodal pixels in the picture; empty where there are none
  cv::Mat amodal_mask;                // CV_8UC1, of the size of mask_box: 255 = amodal
  int beyond_step = 1;                // beyond the picture one ray stands for this many pixels squared, and boxes are that coarse
  bool crosses_camera_plane = false;  // a part lies beside or behind the camera, where no pixel can show it, and counts nowhere
  bool leaves_margin = false;         // covers pixels at the very edge of what is looked at beyond the picture: there may be more

  // Shares in [0, 1]. visible = (1 - truncated) * (1 - occluded).
  double visible() const { return static_cast<double>(visible_px) / static_cast<double>(amodal_px_total); }
  // Of the amodal pixels in the picture, those that something stands before; 0 where none is in the picture.
  double occluded() const { return amodal_px == 0 ? 0.0 : 1.0 - static_cast<double>(visible_px) / static_cast<double>(amodal_px); }
  // Of all amodal pixels, those beyond the picture.
  double truncated() const { return 1.0 - static_cast<double>(amodal_px) / static_cast<double>(amodal_px_total); }
};

// The views of all objects that have an amodal pixel in the picture or beyond it, in the order of Scene::objects. `instances`: the
// picture's instance image (CV_16UC1, as large as the intrinsics say). The caster must stand as it did when the picture was made.
std::vector<ObjectView> object_views(const RayCaster& ray_caster, const PictureRays& rays, const cv::Mat& instances);

}  // namespace waretwin

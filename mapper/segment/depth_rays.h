// The points of a depth picture in the world, each with the colour pixel that sees it.
#pragma once

#include <Eigen/Core>
#include <map>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "sensors/sensor_stream.h"

namespace waretwin {

// Where the stream has it, the depth camera's own picture: what was warped into the colour view lacks the border of everything that
// stands before something else, on one side more than on the other.
struct DepthPoints {
  int width = 0, height = 0;                         // of the thinned picture
  Eigen::Vector3d from_W = Eigen::Vector3d::Zero();  // where the rays start
  std::vector<float> depth;                          // metres along the axis; 0 = nothing measured
  std::vector<Eigen::Vector3f> points_W;             // metres; where something was measured
  std::vector<Eigen::Vector2f> pixels;               // of the colour picture, centre of the first pixel at (0.5, 0.5); else far outside
};

class DepthRays {
 public:
  // `native`: use the depth camera's own picture where there is one.
  DepthRays(const StreamInfo& info, int thin, bool native = true);

  // Depth outside [depth_min, depth_max] is nothing. The frame's pictures are loaded.
  DepthPoints points(const RgbdFrame& frame, const Pose& X_WC, double depth_min, double depth_max);

 private:
  struct View {
    Pose X_CD = Pose::Identity();
    Intrinsics colour;
    bool native = false;
    std::vector<Eigen::Vector3f> rays_C;  // in C's axes, scaled to z = 1 of D; zero where the pixel sees nothing
    int width = 0, height = 0;
  };
  const View& view_of(const RgbdFrame& frame);

  std::map<std::string, StreamInfo::Camera> cameras_;
  int thin_;
  bool native_;
  std::map<std::pair<std::string, bool>, View> views_;
};

}  // namespace waretwin

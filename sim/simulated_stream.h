// The sensor stream that the simulation makes: a robot drives its route through a hall and its sensors measure.
#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "core/fields.h"
#include "core/pose.h"
#include "scenes/scenario.h"
#include "scenes/scene.h"
#include "sensors/sensor_stream.h"
#include "sim/motion/hall_motion.h"
#include "sim/object_views.h"
#include "sim/render_options.h"

namespace waretwin {

class RayCaster;

struct SimulationConfig {
  RenderOptions render;
  bool colour = true;        // false: colour pictures stay black and cost nothing
  bool truth_depth = false;  // depth without error and field mask, in whole millimetres
  bool ideal_depth = true;   // no key: false leaves FrameTruth::ideal_depth empty where no depth camera needs it, and saves its rays
  int max_frames = 0;        // the stream ends after this many camera frames; 0 = the whole route
  std::string isa = "avx2";  // instruction set of the ray caster; see RayCasterOptions
  void visit(Fields& f);
};

// What only the harness may know about a camera frame. All images are height x width of the camera, in CameraConfig::view.
struct FrameTruth {
  Stamp stamp = 0;
  std::string sensor;
  Pose X_WB = Pose::Identity();
  Pose X_WC = Pose::Identity();
  cv::Mat instances;    // CV_16UC1, TrueObject::id, 0 = background; agrees with the colours to the pixel, row by row in time
  cv::Mat ideal_depth;  // CV_32FC1, metres along the optical axis at the stamp, no error, field or range limit; 0 = no surface
};

// Events come in order of stamps (a scan's is that of its first beam), equal stamps as odometry, laser, camera, then by sensor name. The
// drive starts at stamp 0 and every sensor measures from then until the robot has finished its route; a scan that would end after it is
// left out. Pictures are rendered by RgbdFrame::load only, from the frame's stamp and the seed alone, so that the frames a mapper drops
// cost nothing and change nothing. A frame's load stays usable for as long as the frame lives, also after the stream has gone: it keeps
// where everything was.
class SimulatedStream final : public SensorStream {
 public:
  // Throws Error for a route without waypoints, a scene without triangles, or a CPU without the instruction set.
  SimulatedStream(const Scenario& scenario, std::shared_ptr<const Scene> scene, const SimulationConfig& config);
  ~SimulatedStream() override;
  SimulatedStream(const SimulatedStream&) = delete;
  SimulatedStream& operator=(const SimulatedStream&) = delete;

  const StreamInfo& info() const override;
  std::optional<SensorEvent> next() override;

  // The vehicle at any time up to the newest event, exact; before the start it stands.
  Pose true_X_WB(Stamp stamp) const;
  // A sensor as it really sat on the vehicle: the mount with its bracket's error and its vibration (Mount). X_WC of a camera, X_WL of a
  // laser (of a scan's first beam, say). Throws Error for an unknown name.
  Pose true_X_WC(const std::string& camera, Stamp stamp) const;
  Pose true_X_WL(const std::string& laser, Stamp stamp) const;
  // What has moved and what the vehicle has touched so far.
  MotionReport motion() const;
  // Poses of the newest frame and, once it is loaded, its images; a frame that was not loaded has empty images.
  const FrameTruth& last_frame_truth() const;
  // What the newest frame shows of each object, and what it hides; made anew with every call. Nothing for a frame that was not loaded.
  std::vector<ObjectView> object_views();
  const Scene& scene() const;
  std::shared_ptr<const RayCaster> ray_caster() const;

  int frames_rendered() const;       // camera frames whose pictures were made
  double last_frame_ms() const;      // wall time of making the newest loaded frame's pictures; 0 before the first
  double duration_s() const;         // of the whole route
  double distance_driven_m() const;  // of the whole route

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace waretwin

#include "sim/depth_camera.h"

#include "core/error.h"
#include "sensors/depth_noise.h"
#include "sensors/depth_registration.h"
#include "sensors/stereo.h"
#include "sensors/time_of_flight.h"
#include "sim/stereo_camera.h"
#include "sim/time_of_flight_camera.h"

namespace waretwin {

namespace {

class GaussianDepthCamera final : public DepthCamera {
 public:
  GaussianDepthCamera(const CameraConfig& camera, std::uint64_t seed, const std::string& sensor) : noise_(camera, seed, sensor) {}

  DepthReading read(const cv::Mat& ideal, Stamp stamp, const std::function<Pose(Stamp)>&) override {
    DepthReading reading;
    reading.registered = ideal.clone();
    noise_.apply(reading.registered, stamp);
    return reading;
  }

 private:
  DepthNoiseModel noise_;
};

class TimeOfFlightDepthCamera final : public DepthCamera {
 public:
  TimeOfFlightDepthCamera(const CameraConfig& camera, std::uint64_t seed, const std::string& sensor,
                          std::shared_ptr<const RayCaster> ray_caster, const Surfaces& surfaces)
      : X_CD_(camera.X_CD()),
        exposure_s_(camera.time_of_flight.motion ? camera.time_of_flight.exposure_s : 0.0),
        model_(camera, seed, sensor),
        ray_caster_(ray_caster),
        optics_(std::move(ray_caster), surfaces, camera, model_.rays()),
        registration_(model_.rays(), X_CD_, camera.view()) {}

  DepthReading read(const cv::Mat&, Stamp stamp, const std::function<Pose(Stamp)>& X_WC) override {
    TimeOfFlightCamera::PulsePoses X_WD;
    TimeOfFlightCamera::PulseTimes times;
    for (std::size_t pulse = 0; pulse < kTimeOfFlightPulses; ++pulse) {
      const Stamp moment = stamp + from_seconds(pulse_time(static_cast<int>(pulse)) * exposure_s_);
      X_WD[pulse] = X_WC(moment) * X_CD_;
      times[pulse] = ray_caster_->time_of(moment);
    }
    DepthReading reading;
    reading.native = model_.read(optics_.look(X_WD, times), stamp);
    reading.registered = registration_(reading.native);
    return reading;
  }

 private:
  Pose X_CD_;
  double exposure_s_;
  TimeOfFlightModel model_;
  std::shared_ptr<const RayCaster> ray_caster_;
  TimeOfFlightCamera optics_;
  DepthRegistration registration_;
};

class StereoDepthCamera final : public DepthCamera {
 public:
  StereoDepthCamera(const CameraConfig& camera, std::uint64_t seed, const std::string& sensor, std::shared_ptr<const RayCaster> ray_caster,
                    const Surfaces& surfaces)
      : X_CD_(camera.X_CD()),
        model_(camera, seed, sensor),
        optics_(std::move(ray_caster), surfaces, camera),
        registration_(model_.rays(), X_CD_, camera.view()) {}

  DepthReading read(const cv::Mat&, Stamp stamp, const std::function<Pose(Stamp)>& X_WC) override {
    DepthReading reading;
    reading.native = model_.read(optics_.look(X_WC(stamp) * X_CD_, stamp), stamp);
    reading.registered = registration_(reading.native);
    return reading;
  }

 private:
  Pose X_CD_;
  StereoModel model_;
  StereoCamera optics_;
  DepthRegistration registration_;
};

}  // namespace

std::unique_ptr<DepthCamera> DepthCamera::make(const CameraConfig& camera, std::uint64_t seed, const std::string& sensor,
                                               std::shared_ptr<const RayCaster> ray_caster, const Surfaces& surfaces) {
  if (camera.depth_model == "gaussian") return std::make_unique<GaussianDepthCamera>(camera, seed, sensor);
  if (camera.depth_model == "time_of_flight") {
    return std::make_unique<TimeOfFlightDepthCamera>(camera, seed, sensor, std::move(ray_caster), surfaces);
  }
  if (camera.depth_model == "stereo") {
    return std::make_unique<StereoDepthCamera>(camera, seed, sensor, std::move(ray_caster), surfaces);
  }
  throw Error("depth_model '" + camera.depth_model + "' is not known; expected time_of_flight, stereo or gaussian");
}

}  // namespace waretwin

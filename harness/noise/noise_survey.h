// The noise of a depth camera, from a recording of any scene that has planes in it.
#pragma once

#include <functional>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "harness/noise/noise_config.h"
#include "harness/noise/noise_laws.h"
#include "harness/noise/plane_patch.h"
#include "sensors/sensor_stream.h"

namespace waretwin {

struct PatchCounts {
  long looked_at = 0, planar = 0, few_readings = 0, structured = 0, grazing = 0, out_of_range = 0;
};

// Pixels without a reading, of patches that have readings in a fifth of their pixels or more and lie about this far away.
struct MissingByRange {
  double from_m = 0.0, to_m = 0.0;
  long pixels = 0, missing = 0;
  double share() const { return pixels > 0 ? static_cast<double>(missing) / static_cast<double>(pixels) : 0.0; }
};

struct NoiseSurvey {
  NoiseConfig config;
  std::string source, camera;
  bool native = false;        // the depth camera's own images were measured, not those in the colour view
  int width = 0, height = 0;  // of the measured images
  StreamInfo::Camera calibration;
  int frames = 0, used_frames = 0;
  PatchCounts patches;
  double missing_share = 0.0;         // of all pixels
  double planar_missing_share = 0.0;  // of the pixels of planar patches
  double correlation = 0.0;           // of the residuals of neighbours, median of the planar patches; about 0 for independent pixels
  std::vector<MissingByRange> missing;
  std::vector<NoiseCell> cells;  // those with config.min_patches or more, by range, then incidence
  std::optional<GaussianLaw> gaussian;
  std::optional<TimeOfFlightLaw> time_of_flight;
};

// Gathers depth images of one camera.
class NoiseSurveyor {
 public:
  // `rays` as in measure_patch; depth_min_m and depth_max_m: planes outside are not trusted.
  NoiseSurveyor(const cv::Mat& rays, double depth_min_m, double depth_max_m, const NoiseConfig& config);

  // The same at any number of threads.
  void add(const cv::Mat& depth);

  // What was measured so far: counts, shares, cells and laws. Throws Error where no cell has patches enough.
  NoiseSurvey result() const;

 private:
  cv::Mat rays_;
  double depth_min_m_, depth_max_m_;
  NoiseConfig config_;
  std::vector<PlanePatch> candidates_;  // may turn out to be structured
  PatchCounts counts_;
  std::vector<MissingByRange> missing_;
  long pixels_ = 0, missing_pixels_ = 0;
};

// The rays of a lens as measure_patch wants them.
cv::Mat rays_of(const Lens& lens);

// Measures config.frames frames spread evenly over the stream: the depth camera's own images where the stream has them, else those in the
// colour view. Throws Error for a stream without camera or frames and where no planes are found. `progress`: share done.
NoiseSurvey survey_noise(SensorStream& stream, const NoiseConfig& config, const std::function<void(double)>& progress = {});

}  // namespace waretwin

#include "harness/noise/noise_survey.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/core.hpp>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"
#include "core/pose.h"
#include "core/statistics.h"

namespace waretwin {

namespace {

// Of a patch whose place counts for the share of missing pixels.
constexpr double kPlacedShare = 0.2;

std::size_t step_of(double value, double width) { return static_cast<std::size_t>(std::max(0.0, std::floor(value / width))); }

double incidence_deg(const PlanePatch& patch) { return to_degrees(std::acos(std::clamp(patch.cosine, 0.0, 1.0))); }

double median_correlation(const std::vector<PlanePatch>& patches) {
  std::vector<double> correlations;
  for (const PlanePatch& patch : patches) correlations.push_back(patch.correlation);
  return median(std::move(correlations));
}

// Mean of a figure over the fifth of the patches that lie about the one of median variance. The laws compare a cell's median with it, so it
// must belong to the same patches: where a cell holds two walls, its median distance may be that of neither.
double of_middle_patches(std::vector<const PlanePatch*> patches, double PlanePatch::*variance,
                         const std::function<double(const PlanePatch&)>& figure) {
  std::stable_sort(patches.begin(), patches.end(), [=](const PlanePatch* a, const PlanePatch* b) { return a->*variance < b->*variance; });
  const std::size_t count = patches.size(), first = 2 * count / 5, end = std::max(first + 1, count - first);
  double sum = 0.0;
  for (std::size_t i = first; i < end; ++i) sum += figure(*patches[i]);
  return sum / static_cast<double>(end - first);
}

NoiseCell summarise(const std::vector<const PlanePatch*>& patches, const NoiseConfig& config) {
  std::vector<double> freedoms, variances_z, variances_r;
  for (const PlanePatch* patch : patches) {
    freedoms.push_back(patch->readings - 3.0);
    variances_z.push_back(patch->variance_z);
    variances_r.push_back(patch->variance_r);
  }
  NoiseCell cell;
  cell.patches = static_cast<int>(patches.size());
  cell.depth_m = std::sqrt(of_middle_patches(patches, &PlanePatch::variance_z, [](const PlanePatch& p) { return p.depth_m * p.depth_m; }));
  cell.shape = of_middle_patches(patches, &PlanePatch::variance_r, [&](const PlanePatch& p) {
    return time_of_flight_shape(config.illumination * config.reflectivity * p.cosine / (p.range_m * p.range_m), config.background);
  });
  const double freedom = median(std::move(freedoms));
  cell.sigma_z = sigma_of_variances(std::move(variances_z), freedom);
  cell.sigma_r = sigma_of_variances(std::move(variances_r), freedom);
  return cell;
}

}  // namespace

cv::Mat rays_of(const Lens& lens) {
  cv::Mat rays(lens.intrinsics().height, lens.intrinsics().width, CV_32FC3, cv::Scalar::all(0));
  parallel_for(static_cast<std::size_t>(rays.rows), 8, [&](std::size_t begin, std::size_t end) {
    for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v) {
      for (int u = 0; u < rays.cols; ++u) {
        const auto ray = lens.ray(u, v);
        if (ray) rays.at<cv::Vec3f>(v, u) = {static_cast<float>(ray->x()), static_cast<float>(ray->y()), 1.0f};
      }
    }
  });
  return rays;
}

NoiseSurveyor::NoiseSurveyor(const cv::Mat& rays, double depth_min_m, double depth_max_m, const NoiseConfig& config)
    : rays_(rays), depth_min_m_(depth_min_m), depth_max_m_(depth_max_m), config_(config) {}

void NoiseSurveyor::add(const cv::Mat& depth) {
  const int side = config_.patch_px;
  const int columns = depth.cols / side, rows = depth.rows / side;
  std::vector<PlanePatch> patches(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  parallel_for(static_cast<std::size_t>(rows), 1, [&](std::size_t begin, std::size_t end) {
    for (int row = static_cast<int>(begin); row < static_cast<int>(end); ++row) {
      for (int column = 0; column < columns; ++column) {
        patches[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column)] =
            measure_patch(depth, rays_, {column * side, row * side, side, side}, config_);
      }
    }
  });
  pixels_ += static_cast<long>(depth.total());
  missing_pixels_ += static_cast<long>(depth.total()) - cv::countNonZero(depth);
  for (const PlanePatch& patch : patches) {
    ++counts_.looked_at;
    const int missing = patch.pixels - patch.readings;
    if (patch.readings >= kPlacedShare * patch.pixels) {
      const std::size_t step = step_of(patch.range_m, config_.range_step_m);
      if (missing_.size() <= step) missing_.resize(step + 1);
      missing_[step].pixels += patch.pixels;
      missing_[step].missing += missing;
    }
    if (patch.verdict == PatchVerdict::kFewReadings) ++counts_.few_readings;
    if (patch.verdict == PatchVerdict::kStructured) ++counts_.structured;
    if (patch.verdict == PatchVerdict::kGrazing) ++counts_.grazing;
    if (patch.verdict != PatchVerdict::kPlane) continue;
    if (patch.depth_m < depth_min_m_ || patch.depth_m > depth_max_m_) {
      ++counts_.out_of_range;
      continue;
    }
    candidates_.push_back(patch);
  }
}

NoiseSurvey NoiseSurveyor::result() const {
  // Of the candidates most are planes, so that their median tells how the camera's own errors hang together.
  const double correlation = median_correlation(candidates_);
  PatchCounts counts = counts_;
  std::vector<const PlanePatch*> planes;
  long planar_pixels = 0, planar_missing = 0;
  for (const PlanePatch& patch : candidates_) {
    if (patch.structure > structure_limit(patch.readings, correlation, config_)) {
      ++counts.structured;
      continue;
    }
    ++counts.planar;
    planar_pixels += patch.pixels;
    planar_missing += patch.pixels - patch.readings;
    planes.push_back(&patch);
  }
  if (planes.empty()) {
    throw Error("no planes were found in " + std::to_string(counts.looked_at) + " patches of " + std::to_string(config_.patch_px) + " x " +
                std::to_string(config_.patch_px) + " pixels: " + std::to_string(counts.few_readings) + " with too few readings, " +
                std::to_string(counts.structured) + " with edges or curves, " + std::to_string(counts.grazing) + " too grazing, " +
                std::to_string(counts.out_of_range) + " outside the trusted range; expected walls, floors or tables in view");
  }
  NoiseSurvey survey;
  survey.config = config_;
  survey.width = rays_.cols;
  survey.height = rays_.rows;
  survey.patches = counts;
  const auto share = [](long part, long whole) { return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0; };
  survey.missing_share = share(missing_pixels_, pixels_);
  survey.planar_missing_share = share(planar_missing, planar_pixels);
  for (std::size_t step = 0; step < missing_.size(); ++step) {
    if (missing_[step].pixels == 0) continue;
    MissingByRange row = missing_[step];
    row.from_m = static_cast<double>(step) * config_.range_step_m;
    row.to_m = static_cast<double>(step + 1) * config_.range_step_m;
    survey.missing.push_back(row);
  }
  std::vector<double> correlations;
  std::map<std::pair<std::size_t, std::size_t>, std::vector<const PlanePatch*>> cells;
  for (const PlanePatch* patch : planes) {
    correlations.push_back(patch->correlation);
    cells[{step_of(patch->range_m, config_.range_step_m), step_of(incidence_deg(*patch), config_.incidence_step_deg)}].push_back(patch);
  }
  survey.correlation = median(std::move(correlations));
  for (const auto& [place, patches] : cells) {
    if (static_cast<int>(patches.size()) < config_.min_patches) continue;
    NoiseCell cell = summarise(patches, config_);
    cell.range_from_m = static_cast<double>(place.first) * config_.range_step_m;
    cell.range_to_m = static_cast<double>(place.first + 1) * config_.range_step_m;
    cell.incidence_from_deg = static_cast<double>(place.second) * config_.incidence_step_deg;
    cell.incidence_to_deg = static_cast<double>(place.second + 1) * config_.incidence_step_deg;
    survey.cells.push_back(cell);
  }
  if (survey.cells.empty()) {
    throw Error("only " + std::to_string(planes.size()) + " planar patches were found, nowhere " + std::to_string(config_.min_patches) +
                " at the same range and angle; expected more frames (--frames) or a lower noise.min_patches");
  }
  survey.gaussian = fit_gaussian_law(survey.cells);
  survey.time_of_flight = fit_time_of_flight_law(survey.cells);
  return survey;
}

NoiseSurvey survey_noise(SensorStream& stream, const NoiseConfig& config, const std::function<void(double)>& progress) {
  const StreamInfo& info = stream.info();
  if (info.cameras.empty()) throw Error(info.source + ": holds no depth images; expected a recording of a depth camera");
  const int total = info.frame_count.value_or(config.frames);
  const int wanted = std::min(config.frames, total);
  std::optional<NoiseSurveyor> surveyor;
  std::string camera;
  bool native = false;
  int frames = 0, used = 0;
  while (used < wanted) {
    auto event = stream.next();
    if (!event) break;
    auto* frame = std::get_if<RgbdFrame>(&*event);
    if (frame == nullptr) continue;
    // The middles of `wanted` equal pieces.
    const auto place = static_cast<int>((2LL * used + 1) * total / (2LL * wanted));
    if (frames++ < place) continue;
    load_pictures(*frame);
    const StreamInfo::Camera& calibration = info.cameras.at(frame->sensor);
    if (!surveyor) {
      camera = frame->sensor;
      native = calibration.native.has_value() && !frame->native_depth.empty();
      surveyor.emplace(rays_of(native ? calibration.native->lens : Lens(calibration.intrinsics)), calibration.depth_min_m,
                       calibration.depth_max_m, config);
    }
    // One survey measures one lens.
    if (frame->sensor != camera || (native && frame->native_depth.empty())) continue;
    surveyor->add(native ? frame->native_depth : frame->depth);
    ++used;
    if (progress) progress(static_cast<double>(used) / wanted);
  }
  if (!surveyor) throw Error(info.source + ": holds no depth images; expected a recording of a depth camera");
  NoiseSurvey survey;
  try {
    survey = surveyor->result();
  } catch (const Error& error) {
    throw Error(info.source + ": " + error.what());
  }
  survey.source = info.source;
  survey.camera = camera;
  survey.native = native;
  survey.calibration = info.cameras.at(camera);
  survey.frames = total;
  survey.used_frames = used;
  return survey;
}

}  // namespace waretwin

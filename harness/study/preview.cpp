#include "harness/study/preview.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "core/files.h"
#include "harness/pictures/picture_file.h"
#include "harness/pictures/rasteriser.h"
#include "harness/study/study_setup.h"
#include "harness/study/study_text.h"
#include "sensors/depth_field.h"
#include "sim/motion/hall_motion.h"
#include "sim/still.h"

namespace waretwin {

namespace {

constexpr int kWidth = 640, kColumns = 4;
constexpr std::size_t kMostOnSheet = 48;
constexpr double kThumb = 0.6;  // of a picture on the sheet
const cv::Scalar kWhite(255, 255, 255), kOutline(80, 220, 255);

Intrinsics scaled(const Intrinsics& full, int width) {
  const double scale = static_cast<double>(width) / full.width;
  const int height = static_cast<int>(std::lround(scale * full.height));
  // A pixel's middle lies half a pixel from its edge at any scale.
  return {width, height, scale * full.fx, scale * full.fy, scale * (full.cx + 0.5) - 0.5, scale * (full.cy + 0.5) - 0.5};
}

// Dim where no depth is read, with the field's outline.
void mark_depth(cv::Mat& picture, const cv::Mat& depth, const CameraConfig& camera, const Intrinsics& view) {
  cv::Mat field(picture.size(), CV_8UC1, cv::Scalar::all(0));
  for (int v = 0; v < picture.rows; ++v) {
    for (int u = 0; u < picture.cols; ++u) {
      const bool inside = in_depth_field(camera.field, view.ray(u, v));
      field.at<std::uint8_t>(v, u) = inside ? 255 : 0;
      const auto z = static_cast<double>(depth.at<float>(v, u));
      if (inside && z >= camera.depth_min_m && z <= camera.depth_max_m) continue;
      cv::Vec3b& pixel = picture.at<cv::Vec3b>(v, u);
      for (int k = 0; k < 3; ++k) pixel[k] = static_cast<std::uint8_t>(pixel[k] * 2 / 5);
    }
  }
  std::vector<std::vector<cv::Point>> outlines;
  cv::findContours(field, outlines, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
  cv::drawContours(picture, outlines, -1, kOutline, 1, cv::LINE_AA);
}

cv::Mat sheet_of(const std::vector<cv::Mat>& pictures) {
  std::vector<cv::Mat> small;
  for (std::size_t i = 0; i < std::min(pictures.size(), kMostOnSheet); ++i) {
    cv::Mat& thumb = small.emplace_back();
    cv::resize(pictures[i], thumb, {}, kThumb, kThumb, cv::INTER_AREA);
  }
  cv::Size cell(0, 0);
  for (const cv::Mat& thumb : small) cell = {std::max(cell.width, thumb.cols), std::max(cell.height, thumb.rows)};
  const int columns = std::min(kColumns, static_cast<int>(small.size())), rows = (static_cast<int>(small.size()) + columns - 1) / columns;
  constexpr int kGap = 4;
  cv::Mat sheet(rows * (cell.height + kGap), columns * (cell.width + kGap), CV_8UC3, kWhite);
  for (int i = 0; i < static_cast<int>(small.size()); ++i) {
    const cv::Mat& thumb = small[static_cast<std::size_t>(i)];
    thumb.copyTo(sheet(cv::Rect(i % columns * (cell.width + kGap), i / columns * (cell.height + kGap), thumb.cols, thumb.rows)));
  }
  return sheet;
}

}  // namespace

int draw_previews(const StudyRequest& request, const StudyHooks& hooks) {
  const auto check = [&] {
    if (hooks.check) hooks.check();
  };
  const StudySetup setup = set_up_study(request, check);
  const CandidateInHall& baseline = setup.candidates.front().halls.front();
  if (baseline.config.scenario.sensors.cameras.empty())
    throw Error(request.file, "the vehicle has no camera; expected one to look through");
  const double moment = baseline.shared->coverage(baseline.baseline_robot, setup.study.coverage).best_moment(baseline.config.scenario);
  // Pictures of an earlier, larger study would be taken for this one's.
  std::error_code none;
  std::filesystem::remove_all(request.out / "preview", none);
  make_folder(request.out / "preview");
  std::map<const SharedHall*, std::shared_ptr<RayCaster>> casters;
  std::vector<cv::Mat> pictures;
  int drawn = 0;
  for (const Candidate& candidate : setup.candidates) {
    check();
    if (candidate.halls.empty()) continue;
    const CandidateInHall& in_hall = candidate.halls.front();
    const Scenario& scenario = in_hall.config.scenario;
    std::shared_ptr<RayCaster>& caster = casters[in_hall.shared.get()];
    if (!caster) caster = std::make_shared<RayCaster>(in_hall.shared->scene);
    HallMotion motion(scenario, *caster);
    const Stamp stamp = from_seconds(moment * to_seconds(motion.duration()));
    motion.advance_to(stamp);
    motion.moment(stamp, stamp).show(*caster);
    RenderOptions options;
    options.exposure = scenario.lighting.exposure;
    std::vector<cv::Mat> views;
    for (const auto& [name, camera] : scenario.sensors.cameras) {
      const Intrinsics view = scaled(camera.intrinsics(), kWidth);
      StillPicture still = render_still(caster, view, motion.X_WB(stamp) * camera.mount.X_BC(), options, scenario.seed);
      mark_depth(still.colour, still.depth, camera, view);
      if (scenario.sensors.cameras.size() > 1) draw_text(still.colour, {8, still.colour.rows - 10}, name, kWhite);
      views.push_back(still.colour);
    }
    int height = 0;
    for (const cv::Mat& view : views) height = std::max(height, view.rows);
    for (cv::Mat& view : views) cv::copyMakeBorder(view, view, 0, height - view.rows, 0, 0, cv::BORDER_CONSTANT);
    cv::Mat picture;
    cv::hconcat(views, picture);
    draw_text(picture, {8, 22},
              candidate.name + (candidate.number == 0 ? " (baseline): " : ": ") + values_text(setup.study, candidate.values), kWhite);
    write_png(request.out / "preview" / (candidate.name + ".png"), picture);
    if (pictures.size() < kMostOnSheet) pictures.push_back(picture);
    ++drawn;
    if (hooks.progress)
      hooks.progress({"preview", candidate.name, drawn, static_cast<int>(setup.candidates.size()),
                      static_cast<double>(candidate.number + 1) / static_cast<double>(setup.candidates.size())});
  }
  write_png(request.out / "preview.png", sheet_of(pictures));
  return drawn;
}

}  // namespace waretwin

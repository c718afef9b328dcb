#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "harness/generate/plan_picture.h"
#include "harness/pictures/rasteriser.h"
#include "harness/score/number_text.h"
#include "harness/study/chart.h"
#include "harness/study/study_pictures.h"

namespace waretwin {

namespace {

const cv::Scalar kNeverSeen(70, 70, 225), kInk(40, 40, 40), kSeen(140, 190, 60), kVehicle(90, 90, 90), kLabel(20, 20, 20);
constexpr int kHead = 44, kSide = 330;  // pixels above and beside the plan
constexpr int kMany = 12;               // looks at which the ramp ends
constexpr double kStrength = 0.6;       // of the colours over the plan

cv::Scalar colour_of(int looks) { return looks == 0 ? kNeverSeen : ramp_colour(0.25 + 0.75 * std::min(looks, kMany) / kMany); }

void draw_floor(cv::Mat& plan, const PictureView& view, const CoverageHall& hall, const FloorLooks& looks) {
  cv::Mat coloured = plan.clone();
  const double half = 0.5 * hall.floor_spacing_m();
  for (std::size_t i = 0; i < hall.floor().size(); ++i) {
    const SurfaceSample& sample = hall.floor()[i];
    if (!sample.viewable) continue;
    const Eigen::Vector3d p = sample.p_W.cast<double>();
    const auto a = view.project(p + Eigen::Vector3d(-half, half, 0)), b = view.project(p + Eigen::Vector3d(half, -half, 0));
    if (!a || !b) continue;
    cv::rectangle(coloured, cv::Point(static_cast<int>(std::lround(a->x())), static_cast<int>(std::lround(a->y()))),
                  cv::Point(static_cast<int>(std::lround(b->x())) - 1, static_cast<int>(std::lround(b->y())) - 1), colour_of(looks[i]),
                  cv::FILLED);
  }
  cv::addWeighted(coloured, kStrength, plan, 1.0 - kStrength, 0.0, plan);
}

void draw_legend(cv::Mat& side, int top) {
  const auto entry = [&](int row, const cv::Scalar& colour, const std::string& text) {
    const int y = top + 24 * row;
    cv::rectangle(side, {16, y - 12, 18, 14}, colour, cv::FILLED);
    cv::putText(side, text, {44, y}, cv::FONT_HERSHEY_SIMPLEX, 0.45, kInk, 1, cv::LINE_AA);
  };
  entry(0, kNeverSeen, "floor that could be seen, never seen");
  entry(1, colour_of(1), "seen once");
  entry(2, colour_of(kMany / 2), "seen " + std::to_string(kMany / 2) + " times");
  entry(3, colour_of(kMany), "seen " + std::to_string(kMany) + " times or more");
}

// The vehicle from above, forward up, with the floor around it that its cameras see at an instant.
void draw_blind_zone(cv::Mat& side, int top, const RobotConfig& robot, const BlindZone& blind) {
  double reach = 0.5;
  for (const auto* points : {&blind.seen, &blind.unseen}) {
    for (const Eigen::Vector2f& p : *points) reach = std::max(reach, static_cast<double>(p.cwiseAbs().maxCoeff()));
  }
  const double scale = (kSide - 40) / (2.0 * reach);
  const int centre_x = kSide / 2, centre_y = top + (kSide - 40) / 2 + 12;
  const auto at = [&](double x, double y) {
    return cv::Point(static_cast<int>(std::lround(centre_x - scale * y)), static_cast<int>(std::lround(centre_y - scale * x)));
  };
  const double half = 0.5 * blind.spacing_m;
  for (const bool seen : {false, true}) {
    for (const Eigen::Vector2f& p : seen ? blind.seen : blind.unseen) {
      const auto x = static_cast<double>(p.x()), y = static_cast<double>(p.y());
      cv::rectangle(side, at(x + half, y + half), at(x - half, y - half), seen ? kSeen : cv::Scalar(215, 215, 235), cv::FILLED);
    }
  }
  cv::rectangle(side, at(0.5 * robot.length_m, 0.5 * robot.width_m), at(-0.5 * robot.length_m, -0.5 * robot.width_m), kVehicle, cv::FILLED);
  cv::arrowedLine(side, at(-0.2 * robot.length_m, 0), at(0.35 * robot.length_m, 0), cv::Scalar(255, 255, 255), 2, cv::LINE_AA, 0, 0.4);
  cv::putText(side, "around the vehicle, at an instant", {16, top}, cv::FONT_HERSHEY_SIMPLEX, 0.45, kInk, 1, cv::LINE_AA);
  const std::string text =
      "blind " + number("%.0f %%", 100.0 * blind.floor_share) + " of the floor, " + number("%.2f m", blind.ahead_m) + " ahead";
  cv::putText(side, text, {16, centre_y + (kSide - 40) / 2 + 22}, cv::FONT_HERSHEY_SIMPLEX, 0.45, kInk, 1, cv::LINE_AA);
}

}  // namespace

cv::Mat coverage_map(const Scene& scene, const Scenario& scenario, const CoverageHall& hall, const FloorLooks& looks,
                     const Coverage& coverage, const BlindZone& blind, const std::string& title) {
  cv::Mat plan = draw_plan(scene, scenario.robot);
  const PictureView view = plan_view(scene);
  draw_floor(plan, view, hall, looks);
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const Cuboid& cuboid = scene.objects[i].cuboid;
    const auto at = view.project(cuboid.centre);
    if (!at) continue;
    const std::string text = std::to_string(scene.objects[i].id) + ": " + number("%.0f %%", 100.0 * coverage.objects[i]);
    draw_text(plan, {static_cast<int>(at->x()) - 28, static_cast<int>(at->y()) + 6}, text, cv::Scalar(255, 255, 255), 0.55);
  }
  cv::Mat picture(std::max(plan.rows, 2 * kSide + 60) + kHead, plan.cols + kSide, CV_8UC3, cv::Scalar(250, 250, 250));
  plan.copyTo(picture(cv::Rect(0, kHead, plan.cols, plan.rows)));
  cv::Mat side = picture(cv::Rect(plan.cols, kHead, kSide, picture.rows - kHead));
  draw_legend(side, 24);
  draw_blind_zone(side, 140, scenario.robot, blind);
  cv::putText(picture, title, {16, 29}, cv::FONT_HERSHEY_SIMPLEX, 0.65, kLabel, 1, cv::LINE_AA);
  return picture;
}

}  // namespace waretwin

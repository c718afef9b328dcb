#include "harness/calibrate/calibration.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/statistics.h"
#include "harness/calibrate/closed_form.h"
#include "harness/calibrate/line_search.h"

namespace waretwin {

namespace {

template <class T>
std::string chosen(const std::map<std::string, T>& sensors, const std::string& name, const std::string& kind) {
  std::string names;
  for (const auto& entry : sensors) names += (names.empty() ? "" : ", ") + entry.first;
  if (sensors.empty()) throw Error("calibrate: there is no " + kind + " in it; expected a camera and a laser");
  if (!name.empty() && !sensors.contains(name))
    throw Error("calibrate." + kind + ": '" + name + "' is not known; expected one of " + names);
  if (name.empty() && sensors.size() > 1) throw Error("calibrate." + kind + ": there are several; expected one of " + names);
  return name.empty() ? sensors.begin()->first : name;
}

constexpr const char* kNoBoard = "the corners fit no board";
constexpr const char* kNoLine = "the scan has no line where the board should be";

struct Views {
  std::vector<StillPose> still;
  std::vector<BoardView> views;     // of each
  std::vector<std::string> unused;  // why; empty: used so far
};

Views seen_boards(const std::vector<StillPose>& still, const Intrinsics& intrinsics, const CalibrateConfig& config) {
  Views seen;
  std::vector<double> misfits;
  for (const StillPose& pose : still) {
    const std::optional<BoardView> view = view_board(pose.corners, intrinsics, config.board);
    seen.still.push_back(pose);
    seen.views.push_back(view.value_or(BoardView{}));
    seen.unused.push_back(view ? "" : kNoBoard);
    if (view) misfits.push_back(view->rms_px);
  }
  if (misfits.empty()) return seen;
  // Corners that went astray in one pose stick out long before they look wrong.
  constexpr double kFarWorse = 4.0, kGood_px = 0.2;
  const double most = std::min(config.largest_corner_px, std::max(kGood_px, kFarWorse * median(misfits)));
  for (std::size_t i = 0; i < still.size(); ++i) {
    if (seen.unused[i].empty() && seen.views[i].rms_px > most) seen.unused[i] = kNoBoard;
  }
  return seen;
}

// The poses that are used must determine the mounting; throws otherwise.
void expect_determined(const Views& seen, const CalibrateConfig& config, const Pose& X_BC) {
  std::vector<Eigen::Vector3d> normals;
  for (std::size_t i = 0; i < seen.views.size(); ++i) {
    if (seen.unused[i].empty()) normals.push_back(seen.views[i].normal_C());
  }
  waretwin::expect_determined(normals, config.least_poses, config.least_angle_deg, X_BC.linear());
}

void drop(Views& seen, std::size_t pose, const std::string& why) {
  seen.unused[pose] = why;
  seen.views[pose].points.clear();
}

void pick_by_guess(Views& seen, const CalibrateConfig& config, const Pose& X_CL) {
  for (std::size_t i = 0; i < seen.views.size(); ++i) {
    if (!seen.unused[i].empty()) continue;
    seen.views[i].points = points_by_guess(seen.still[i], seen.views[i], config.board, X_CL, config.guess);
    if (seen.views[i].points.empty()) drop(seen, i, kNoLine);
  }
}

void pick_by_estimate(Views& seen, const CalibrateConfig& config, const Pose& X_CL, double bias_m, double gate_m) {
  for (std::size_t i = 0; i < seen.views.size(); ++i) {
    // A pose whose line was not found without an estimate comes back where beams meet its board now.
    if (!seen.unused[i].empty() && seen.unused[i] != kNoLine) continue;
    seen.views[i].points = points_by_estimate(seen.still[i], seen.views[i], config.board, X_CL, bias_m, gate_m);
    if (!seen.views[i].points.empty()) {
      seen.unused[i].clear();
    } else if (seen.unused[i].empty()) {
      drop(seen, i, "the laser's beams miss the board");
    }
  }
}

std::vector<PlaneAndPoints> planes_of(const Views& seen) {
  std::vector<PlaneAndPoints> planes;
  for (std::size_t i = 0; i < seen.views.size(); ++i) {
    if (!seen.unused[i].empty()) continue;
    PlaneAndPoints plane{seen.views[i].normal_C(), seen.views[i].distance_m(), {}};
    for (const LaserPoint& point : seen.views[i].points) plane.points_L.push_back(point.p_L());
    planes.push_back(std::move(plane));
  }
  return planes;
}

// How far the points of a view are from its plane, in metres (rms).
double off_plane(const BoardView& view, const Pose& X_CL) {
  double sum = 0.0;
  for (const LaserPoint& point : view.points) sum += std::pow(view.normal_C().dot(X_CL * point.p_L()) - view.distance_m(), 2);
  return view.points.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(view.points.size()));
}

// In closed form, without the poses whose line was somebody else's: the worst goes while it is far worse than the others.
Pose robust_closed_form(Views& seen, const CalibrateConfig& config, const Pose& X_BC) {
  // A systematic error of the ranges alone leaves this much.
  constexpr double kUsual_m = 0.03, kFarWorse = 4.0;
  while (true) {
    expect_determined(seen, config, X_BC);
    const Pose X_CL = closed_form_X_CL(planes_of(seen));
    std::vector<double> all;
    std::size_t worst = 0;
    double most = -1.0;
    for (std::size_t i = 0; i < seen.views.size(); ++i) {
      if (!seen.unused[i].empty()) continue;
      all.push_back(off_plane(seen.views[i], X_CL));
      if (all.back() > most) {
        most = all.back();
        worst = i;
      }
    }
    if (most <= std::max(kUsual_m, kFarWorse * median(all))) return X_CL;
    drop(seen, worst, "the line in the scan is not on the board's plane");
  }
}

// Where the guess is too far off to tell which lines are boards, the poses tell it together.
Pose first_estimate(Views& seen, const CalibrateConfig& config, const Pose& X_BC_given, const Pose& X_BL) {
  std::vector<std::size_t> used;
  std::vector<BoardAndLines> poses;
  const std::vector<BoardLines> lines = board_lines(seen.still, config.board);
  for (std::size_t i = 0; i < seen.views.size(); ++i) {
    if (!seen.unused[i].empty()) continue;
    used.push_back(i);
    poses.push_back({seen.views[i], lines[i]});
  }
  // Measured over the poses of scenes/agiprobot/calibration.yaml: eight always find each other, of six half do.
  constexpr std::size_t kEnough = 8;
  const bool enough = used.size() >= kEnough;
  Views guessed = seen;
  LineSearch by_guess;
  int told = 0;  // poses whose line the guess told
  std::optional<Error> refusal;
  try {
    pick_by_guess(guessed, config, X_BC_given.inverse() * X_BL);
    by_guess = agreeing_lines(poses, config.board, robust_closed_form(guessed, config, X_BC_given));
    told = static_cast<int>(std::count(guessed.unused.begin(), guessed.unused.end(), ""));
  } catch (const Error& error) {
    refusal = error;
  }
  LineSearch best = by_guess;
  if (by_guess.agreed < static_cast<int>(used.size())) {
    const std::optional<LineSearch> found = search_lines(poses, config.board);
    if (found && found->agreed > best.agreed) best = *found;
  }
  // The closed form of few poses is so rough that lines which the guess told rightly may miss their boards; of more it is not.
  const bool guess_holds = !enough || by_guess.agreed >= config.least_poses;
  if (best.agreed > told || (!guess_holds && best.agreed >= config.least_poses)) {
    for (std::size_t k = 0; k < used.size(); ++k) {
      if (best.line[k] < 0) {
        drop(seen, used[k], kNoLine);
      } else {
        seen.views[used[k]].points = poses[k].candidates.lines[static_cast<std::size_t>(best.line[k])].points;
      }
    }
    return robust_closed_form(seen, config, X_BC_given);
  }
  if (refusal && !enough) {
    throw Error(std::string(refusal->what()) + "; or the camera's place known within " +
                std::to_string(config.guess.distance_m).substr(0, 4) + " m and " + std::to_string(config.guess.angle_deg).substr(0, 4) +
                " deg (calibrate.guess), or eight poses");
  }
  if (refusal) throw Error(*refusal);
  if (!guess_holds) {
    throw Error("the lines in the scans lie on the boards of " + std::to_string(best.agreed) + " of " + std::to_string(used.size()) +
                " poses only; expected at least " + std::to_string(config.least_poses) + " on which one place of the camera agrees");
  }
  seen = std::move(guessed);
  return by_guess.X_CL;
}

double beam_rms(const BoardView& view, const Pose& X_CO, const Pose& X_CL, double bias_m) {
  const Eigen::Vector3d normal = X_CO.linear().col(2);
  double sum = 0.0;
  for (const LaserPoint& point : view.points) {
    const double range = normal.dot(X_CO.translation() - X_CL.translation()) / normal.dot(X_CL.linear() * point.direction_L());
    sum += std::pow(point.range_m - bias_m - range, 2);
  }
  return view.points.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(view.points.size()));
}

}  // namespace

void CalibrateConfig::visit(Fields& f) {
  f("camera", camera, "which one; empty: the only one");
  f("laser", laser, "which one; empty: the only one");
  f.group("board", board, "the checkerboard");
  f.group("still", still, "when board and vehicle stand still");
  f.group("guess", guess, "where the lines of boards are looked for first; without success the search goes without what is known");
  f.group("refine", refine, "the refinement");
  f.group("lens", lens, "the camera's intrinsics");
  f("least_poses", least_poses, "fewer are refused", {.min = 5, .max = 1e6});
  f("least_angle_deg", least_angle_deg, "boards within this angle are parallel; normals within half of it of a plane lie in it",
    {.min = 0.1, .max = 45});
  f("largest_corner_px", largest_corner_px, "a pose whose corners are farther off their board (rms) is left out",
    {.min = 0.01, .max = 100});
}

Calibration calibrate(SensorStream& stream, const CalibrateConfig& config, const std::function<void(double, int)>& progress) {
  expect_refinement();
  const StreamInfo& info = stream.info();
  const std::string camera = chosen(info.cameras, config.camera, "camera"), laser = chosen(info.lasers, config.laser, "laser");
  StillPoses poses(config.board, config.still);
  std::optional<Stamp> first;
  while (std::optional<SensorEvent> event = stream.next()) {
    const Stamp stamp = stamp_of(*event);
    if (!first) first = stamp;
    if (auto* frame = std::get_if<RgbdFrame>(&*event); frame && frame->sensor == camera) {
      load_pictures(*frame);
      poses.add(*frame);
      double done = info.duration_s && *info.duration_s > 0.0 ? to_seconds(stamp - *first) / *info.duration_s : 0.0;
      if (info.frame_count && *info.frame_count > 0) done = std::max(done, static_cast<double>(poses.frames()) / *info.frame_count);
      if (progress) progress(std::min(done, 1.0), poses.poses());
    }
    if (const auto* scan = std::get_if<LaserScan>(&*event); scan && scan->sensor == laser) poses.add(*scan);
  }
  std::vector<StillPose> still = poses.finish();
  if (still.empty()) {
    throw Error("calibrate: of " + std::to_string(poses.frames()) + " frames " + std::to_string(poses.frames_with_board()) +
                " show a whole checkerboard with " + std::to_string(config.board.columns) + " x " + std::to_string(config.board.rows) +
                " inner corners, and in none of them it stands still for " + std::to_string(config.still.frames) + " frames and " +
                std::to_string(config.still.scans) + " scans; expected a board that is held still in several poses (--board, --square)");
  }
  Calibration calibration = calibrate(still, info, config);
  calibration.frames = poses.frames();
  calibration.frames_with_board = poses.frames_with_board();
  for (PoseReport& pose : calibration.poses) pose.at_s -= to_seconds(*first);
  return calibration;
}

Calibration calibrate(const std::vector<StillPose>& still, const StreamInfo& info, const CalibrateConfig& config) {
  Calibration result;
  result.camera = chosen(info.cameras, config.camera, "camera");
  result.laser = chosen(info.lasers, config.laser, "laser");
  result.X_BC_given = info.cameras.at(result.camera).X_BC;
  result.X_BL = info.lasers.at(result.laser).X_BL;
  result.given = info.cameras.at(result.camera).intrinsics;
  const Pose& X_BL = result.X_BL;

  Views seen = seen_boards(still, result.given, config);
  expect_determined(seen, config, result.X_BC_given);
  const Pose X_CL = first_estimate(seen, config, result.X_BC_given, X_BL);
  Refined& found = result.found;
  found = refine(seen.views, result.given, config.board, X_BL, X_BL * X_CL.inverse(), 0.0, config.refine);
  // Points anew, by what was found: beams at the board's ends come in, strangers go out.
  for (const double gate_m : {0.10, 0.05, 0.03}) {
    pick_by_estimate(seen, config, found.X_BC.inverse() * X_BL, found.bias_m, gate_m);
    expect_determined(seen, config, result.X_BC_given);
    found = refine(seen.views, result.given, config.board, X_BL, found.X_BC, found.bias_m, config.refine);
  }

  std::vector<std::vector<Eigen::Vector2d>> corners;
  for (std::size_t i = 0; i < seen.views.size(); ++i) {
    const BoardView& view = seen.views[i];
    result.poses.push_back({.at_s = to_seconds(still[i].begin),
                            .frames = still[i].frames,
                            .scans = still[i].scans,
                            .points = static_cast<int>(view.points.size()),
                            .corner_rms_px = view.rms_px,
                            .point_rms_m = beam_rms(view, found.X_CO[i], found.X_BC.inverse() * X_BL, found.bias_m),
                            .unused = seen.unused[i]});
    result.used_poses += seen.unused[i].empty() ? 1 : 0;
    if (seen.unused[i] != kNoBoard) corners.push_back(view.corners);
  }
  if (config.lens.estimate) result.lens = estimate_lens(corners, config.board, result.given, config.lens);
  return result;
}

}  // namespace waretwin

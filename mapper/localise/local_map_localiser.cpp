#include "mapper/localise/local_map_localiser.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>

#include "core/error.h"
#include "mapper/localise/map_search.h"

namespace waretwin {
namespace {

constexpr std::size_t kFewestPoints = 20;  // of a scan that says anything
constexpr int kLostForGood = 10;           // scans without a match after which the map is begun anew where odometry says the vehicle is
constexpr double kNear_m = 0.02;           // a scan this near to its keyframe is added to it
constexpr double kNear_deg = 0.7;
constexpr std::size_t kMostLaidAnew = 80;  // keyframes; by then the bias has long settled

// What is left of a covariance after another is taken off: its negative eigenvalues are set to a little.
Eigen::Matrix3d positive_part(const Eigen::Matrix3d& covariance) {
  constexpr double kLeast = 1e-10;  // (0.01 mm)^2
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(0.5 * (covariance + covariance.transpose()));
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(kLeast).asDiagonal() * eigen.eigenvectors().transpose();
}

bool within(const PlanarMotion& X_AB, double distance, double angle_deg) {
  return X_AB.translation.norm() <= distance && std::abs(X_AB.yaw) <= to_radians(angle_deg);
}

}  // namespace

LocalMapLocaliser::LocalMapLocaliser(const LocalMapConfig& config, const StreamInfo& info)
    : config_(config), X_WS_(info.X_WB_start), map_(config.map_cell_m), bias_(config.estimate_bias, config.bias_sd_m) {
  if (info.lasers.empty()) throw Error(info.source + ": no laser in this stream; laser poses need one (--poses odometry or recorded)");
  laser_ = info.lasers.begin()->first;
  X_BL_ = info.lasers.begin()->second.X_BL;
}

void LocalMapLocaliser::add(const OdometryReading& reading) {
  odometry_.add(reading.stamp, planar(reading.X_OB));
  if (!anchor_) anchor_ = reading.stamp;
}

void LocalMapLocaliser::add(const LaserScan& scan) {
  if (scan.sensor != laser_) return;
  const Stamp turn = scan.ranges.empty() ? 0 : scan.beam_interval * (static_cast<Stamp>(scan.ranges.size()) - 1);
  const Stamp middle = scan.stamp + turn / 2;
  const std::vector<ScanPoint> points_B =
      scan_points(scan, X_BL_, motion(middle, scan.stamp), motion(middle, scan.stamp + turn), config_.scan);
  // Before the first scan the start pose is that of the first event.
  const Stamp from = anchor_.value_or(scan.stamp);
  predict(motion(from, middle), middle - from);
  anchor_ = middle;
  newest_scan_ = scan.stamp;
  ++counts_.scans;
  if (graph_.keyframes().empty()) {
    if (points_B.size() >= kFewestPoints) add_keyframe(points_B);
  } else {
    // Odometry is doubted: the vehicle may have gone on as it did before.
    match(points_B, scan_poses_.empty() ? X_SB_ : scan_poses_.at(middle));
  }
  scan_poses_.add(middle, X_SB_);
}

std::optional<Pose> LocalMapLocaliser::pose_at(const RgbdFrame& frame) {
  if (!anchor_) return X_WS_;
  return X_WS_ * upright(X_SB_ * motion(*anchor_, frame.stamp));
}

std::optional<Pose> LocalMapLocaliser::current_pose() const {
  if (!newest_scan_) return std::nullopt;
  return X_WS_ * upright(X_SB_ * motion(*anchor_, *newest_scan_));
}

std::optional<Eigen::Matrix3d> LocalMapLocaliser::covariance() const {
  if (!newest_scan_) return std::nullopt;
  return turned_covariance(P_, yaw_of(X_WS_));
}

PlanarMotion LocalMapLocaliser::motion(Stamp from, Stamp to) const {
  return odometry_.empty() ? scan_poses_.between(from, to) : odometry_.between(from, to);
}

void LocalMapLocaliser::predict(const PlanarMotion& step, Stamp duration) {
  const MotionTrustConfig& trust = config_.motion;
  const double distance = step.translation.norm(), turn = std::abs(step.yaw);
  const auto squared = [](double x) { return x * x; };
  double along = squared(trust.floor_m) + squared(trust.distance_share * distance) + squared(trust.distance_sd_m) * distance;
  double heading = squared(to_radians(trust.floor_deg)) + squared(trust.turn_share * turn) +
                   squared(to_radians(trust.turn_sd_per_m_deg)) * distance + squared(to_radians(trust.turn_sd_per_rad_deg)) * turn;
  if (odometry_.empty()) {
    // The last velocity is all there is: vehicles change it by a metre and a radian a second in a second.
    const double seconds = to_seconds(duration);
    along += squared(0.5 * seconds * seconds + 0.2 * distance);
    heading += squared(0.5 * seconds * seconds + 0.2 * turn);
  }
  // Scale errors add up, they do not average out: after a way D that no scan has checked the error is share * D.
  along += squared(trust.distance_share) * 2.0 * unchecked_m_ * distance;
  heading += squared(trust.turn_share) * 2.0 * unchecked_rad_ * turn;
  unchecked_m_ += distance;
  unchecked_rad_ += turn;
  const PlanarMotion before = X_SB_;
  X_SB_ = X_SB_ * step;
  P_ = carried_covariance(P_, before.translation, X_SB_.translation);
  P_(0, 0) += doubt_ * along;
  P_(1, 1) += doubt_ * along;
  P_(2, 2) += doubt_ * heading;
}

Eigen::Matrix3d LocalMapLocaliser::map_covariance() const {
  const Keyframe& reference = graph_.keyframes()[static_cast<std::size_t>(reference_)];
  return carried_covariance(reference.covariance, reference.X_SK.translation, X_SB_.translation) + map_noise_;
}

void LocalMapLocaliser::match(const std::vector<ScanPoint>& points_B, const PlanarMotion& carried_on) {
  const auto missed = [&] {
    ++counts_.not_matched;
    ++lost_;
  };
  if (points_B.size() < kFewestPoints) {
    last_match_ = MapMatch{};
    missed();
    return;
  }
  // Relative to the map: what is uncertain about the map itself is no matter of this scan.
  const Eigen::Matrix3d before = positive_part(P_ - map_covariance());
  PosePrior prior{X_SB_, before.inverse()};
  PlanarMotion start = X_SB_;
  const bool doubtful = doubt_ > config_.motion.doubtful;
  // Odometry that has just been wrong does not decide alone: what little the scan tells is better.
  MapMatchConfig how = config_.match;
  how.degeneracy = how.degeneracy && !doubtful;
  if (doubtful && pose_score(map_, points_B, carried_on, bias_.value(), config_.search) >
                      pose_score(map_, points_B, X_SB_, bias_.value(), config_.search)) {
    start = carried_on;
  }
  last_match_ = match_to_map(map_, points_B, prior, start, bias_.value(), how);
  const auto off = [&](const MapMatch& m) {
    Eigen::Vector3d e;
    e << m.X_SB.translation - X_SB_.translation, wrap_angle(m.X_SB.yaw - X_SB_.yaw);
    return e.dot(prior.information * e) / 3.0;
  };
  double surprise = off(last_match_);
  if (last_match_.believable && surprise > config_.motion.disbelief * config_.motion.disbelief) {
    constexpr double kForgotten = 1e-4;
    prior.information *= kForgotten;
    last_match_ = match_to_map(map_, points_B, prior, last_match_.X_SB, bias_.value(), how);
    ++counts_.odometry_doubted;
  }
  if (!last_match_.believable && !find_again(points_B)) {
    missed();
    if (lost_ >= kLostForGood && !odometry_.empty()) keep(points_B);
    return;
  }
  constexpr double kMemory = 0.95, kMostDoubt = 1e4;
  doubt_ = std::clamp(kMemory * doubt_ + (1.0 - kMemory) * doubt_ * std::min(surprise, 1e4), 1.0, kMostDoubt);
  lost_ = 0;
  if (last_match_.degenerate) ++counts_.degenerate;
  accept(last_match_, before);
  keep(points_B);
}

bool LocalMapLocaliser::find_again(const std::vector<ScanPoint>& points_B) {
  const MapSearchConfig& search = config_.search;
  // A long loss is searched for ever more rarely, in ever larger windows.
  if (!search.enabled || (lost_ & (lost_ + 1)) != 0) return false;
  const double spread_m = 3.0 * std::sqrt(std::max(P_(0, 0), P_(1, 1)));
  SearchWindow window;
  window.centre = X_SB_;
  window.half_m = std::min(search.max_window_m, std::max(search.window_m * (1.0 + lost_), spread_m));
  window.half_deg = std::min(180.0, search.window_deg * (1.0 + lost_));
  const auto found = search_map(map_, points_B, window, bias_.value(), search);
  if (!found) return false;
  const PosePrior nothing{found->X_SB, Eigen::Matrix3d::Zero()};
  MapMatch match = match_to_map(map_, points_B, nothing, found->X_SB, bias_.value(), config_.match);
  // Where the scan leaves a direction open, a search along it means nothing.
  if (!match.believable || match.degenerate) return false;
  last_match_ = std::move(match);
  ++counts_.found_again;
  // Odometry has not led here.
  P_ = map_covariance() + Eigen::Matrix3d::Identity();
  return true;
}

void LocalMapLocaliser::accept(const MapMatch& match, const Eigen::Matrix3d& before) {
  X_SB_ = match.X_SB;
  unchecked_rad_ = 0.0;
  if (!match.degenerate) unchecked_m_ = 0.0;
  choose_reference();
  // The map's points are averages of mean_count points each, whose error stays the same from scan to scan.
  constexpr double kWeak = 1e-6;
  const Eigen::Matrix3d from_scan = (match.information + kWeak * Eigen::Matrix3d::Identity());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(from_scan);
  Eigen::Vector3d noise = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    // A direction that the scan does not hold owes the map nothing.
    if (eigen.eigenvalues()[i] > 1.0) noise[i] = 1.0 / (eigen.eigenvalues()[i] * std::max(1.0, map_.mean_count()));
  }
  map_noise_ = eigen.eigenvectors() * noise.asDiagonal() * eigen.eigenvectors().transpose();
  P_ = map_covariance() + (before.inverse() + match.information).inverse();
}

// Half of the matched points were first seen from keyframes at least as certain as the reference.
void LocalMapLocaliser::choose_reference() {
  std::vector<int> seen;
  seen.reserve(last_match_.matched.size());
  for (const int point : last_match_.matched) seen.push_back(map_.points()[static_cast<std::size_t>(point)].first_seen);
  if (seen.empty()) return;
  const auto middle = seen.begin() + static_cast<std::ptrdiff_t>(seen.size() / 2);
  std::nth_element(seen.begin(), middle, seen.end());
  reference_ = *middle;
}

void LocalMapLocaliser::keep(const std::vector<ScanPoint>& points_B) {
  std::vector<Keyframe>& keyframes = graph_.keyframes();
  Keyframe& newest = keyframes.back();
  const PlanarMotion X_KB = newest.X_SK.inverse() * X_SB_;
  if (within(X_KB, kNear_m, kNear_deg) && newest.scans < config_.keyframe_scans && lost_ == 0) {
    const Eigen::Matrix2d R = X_KB.rotation();
    std::vector<ScanPoint> added;
    added.reserve(points_B.size());
    for (const ScanPoint& point : points_B) added.push_back({X_KB * point.p, R * point.direction, R * point.normal});
    const int number = static_cast<int>(keyframes.size()) - 1;
    map_.add(added, newest.X_SK, bias_.value(), number);
    map_.finish();
    newest.points_K.insert(newest.points_K.end(), added.begin(), added.end());
    ++newest.scans;
    return;
  }
  for (const int member : members_) {
    if (within(keyframes[static_cast<std::size_t>(member)].X_SK.inverse() * X_SB_, config_.keyframe_distance_m, config_.keyframe_angle_deg))
      return;
  }
  add_keyframe(points_B);
}

void LocalMapLocaliser::add_keyframe(const std::vector<ScanPoint>& points_B) {
  const bool first = graph_.keyframes().empty();
  const int number = graph_.add({X_SB_, points_B, 1, P_});
  ++counts_.keyframes;
  if (first) {
    members_ = {number};
    map_.add(points_B, X_SB_, bias_.value(), number);
    map_.finish();
    return;
  }
  bias_.take(last_match_);
  const auto link_to = [&](int other, double share) {
    const PlanarMotion& X_SA = graph_.keyframes()[static_cast<std::size_t>(other)].X_SK;
    const Eigen::Matrix3d relative = positive_part(
        P_ - carried_covariance(graph_.keyframes()[static_cast<std::size_t>(other)].covariance, X_SA.translation, X_SB_.translation));
    graph_.link({other, number, X_SA.inverse() * X_SB_, turned_covariance(relative, -X_SA.yaw) / share});
  };
  // The one match ties the keyframe to the one before it and to the map's reference.
  const int previous = number - 1;
  link_to(previous, reference_ == previous ? 1.0 : 0.5);
  if (reference_ != previous) link_to(reference_, 0.5);
  bool moved = false;
  if (config_.loops) moved = close_loop(number, graph_.paths_from(number));
  if (moved) {
    update_map(true);
  } else {
    update_bias();
    update_map(false);
  }
}

bool LocalMapLocaliser::close_loop(int newest, const std::vector<double>& paths) {
  const std::vector<Keyframe>& keyframes = graph_.keyframes();
  const Keyframe& here = keyframes[static_cast<std::size_t>(newest)];
  // The nearest of the keyframes that lie far back along the way.
  int nearest = -1;
  double nearest_distance = 0.0;
  for (int i = 0; i < newest; ++i) {
    if (paths[static_cast<std::size_t>(i)] <= config_.map_path_m) continue;
    const Keyframe& there = keyframes[static_cast<std::size_t>(i)];
    const double distance = (there.X_SK.translation - here.X_SK.translation).norm();
    if (distance > config_.loop_radius_m + 3.0 * std::sqrt(std::max(P_(0, 0), P_(1, 1)))) continue;
    if (nearest >= 0 && distance >= nearest_distance) continue;
    nearest = i;
    nearest_distance = distance;
  }
  if (nearest < 0) return false;
  const Keyframe& old = keyframes[static_cast<std::size_t>(nearest)];
  LocalMap there(config_.map_cell_m);
  const std::vector<double> old_paths = graph_.paths_from(nearest);
  for (int i = 0; i < newest; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (old_paths[at] > config_.map_radius_m || paths[at] <= config_.map_path_m) continue;
    there.add(keyframes[at].points_K, keyframes[at].X_SK, bias_.value(), i);
  }
  there.finish();
  // What has come between the two places since the old one.
  const Eigen::Matrix3d between =
      positive_part(here.covariance - carried_covariance(old.covariance, old.X_SK.translation, here.X_SK.translation));
  SearchWindow window;
  window.centre = here.X_SK;
  constexpr double kLeastWindow_m = 0.3, kLeastWindow_deg = 3.0;
  window.half_m = std::clamp(3.0 * std::sqrt(std::max(between(0, 0), between(1, 1))), kLeastWindow_m, config_.search.max_window_m);
  window.half_deg = std::clamp(to_degrees(3.0 * std::sqrt(between(2, 2))), kLeastWindow_deg, 180.0);
  const auto found = search_map(there, here.points_K, window, bias_.value(), config_.search);
  if (!found) return false;
  const MapMatch match =
      match_to_map(there, here.points_K, {found->X_SB, Eigen::Matrix3d::Zero()}, found->X_SB, bias_.value(), config_.match);
  if (!match.believable || match.degenerate) return false;
  constexpr double kWeak = 1e-6;
  const Eigen::Matrix3d own = (match.information + kWeak * Eigen::Matrix3d::Identity()).inverse();
  graph_.link({nearest, newest, old.X_SK.inverse() * match.X_SB, turned_covariance(own, -old.X_SK.yaw), true,
               turned_covariance(own + between, -old.X_SK.yaw)});
  graph_.straighten();
  ++counts_.loops;
  X_SB_ = graph_.keyframes().back().X_SK;
  P_ = graph_.keyframes().back().covariance;
  return true;
}

void LocalMapLocaliser::update_bias() {
  constexpr int kMostSteps = 4;
  for (int i = 0; i < kMostSteps && std::abs(bias_.change()) > config_.bias_step_m; ++i) {
    if (graph_.keyframes().size() > kMostLaidAnew || counts_.loops > 0) return;
    bias_.step();
    lay_anew();
    ++counts_.bias_steps;
  }
}

// The keyframes so far, one after the other against those before it, with the present bias.
void LocalMapLocaliser::lay_anew() {
  std::vector<Keyframe>& keyframes = graph_.keyframes();
  LocalMap map(config_.map_cell_m);
  PlanarMotion moved;  // of the keyframe before: the next one goes with it
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    Keyframe& keyframe = keyframes[i];
    if (i > 0) {
      const PlanarMotion X_before = keyframe.X_SK;
      const PosePrior prior{moved * keyframe.X_SK, Eigen::Vector3d(1.0, 1.0, 1.0).asDiagonal().toDenseMatrix()};
      const MapMatch match = match_to_map(map, keyframe.points_K, prior, prior.X_SB, bias_.value(), config_.match);
      keyframe.X_SK = match.X_SB;
      bias_.take(match);
      moved = keyframe.X_SK * X_before.inverse();
    }
    map.add(keyframe.points_K, keyframe.X_SK, bias_.value(), static_cast<int>(i));
    map.finish();
  }
  graph_.relink();
  X_SB_ = keyframes.back().X_SK;
  members_.clear();  // the map holds the old poses
}

void LocalMapLocaliser::update_map(bool from_scratch) {
  const std::vector<Keyframe>& keyframes = graph_.keyframes();
  const int newest = static_cast<int>(keyframes.size()) - 1;
  const std::vector<double> paths = graph_.paths_from(newest);
  std::vector<int> chosen;
  for (int i = 0; i <= newest; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const double distance = (keyframes[at].X_SK.translation - keyframes.back().X_SK.translation).norm();
    if (paths[at] <= config_.map_path_m && distance <= config_.map_radius_m) chosen.push_back(i);
  }
  // The newest stay, for they see what lies ahead; of the others the oldest, for they have drifted least.
  const std::size_t most = static_cast<std::size_t>(config_.map_keyframes);
  if (chosen.size() > most) {
    const std::size_t fresh = (most + 1) / 2;
    chosen.erase(chosen.begin() + static_cast<std::ptrdiff_t>(most - fresh), chosen.end() - static_cast<std::ptrdiff_t>(fresh));
  }
  const bool grows = !from_scratch && !members_.empty() && std::includes(chosen.begin(), chosen.end(), members_.begin(), members_.end());
  std::vector<int> added = chosen;
  if (grows) {
    added.clear();
    std::set_difference(chosen.begin(), chosen.end(), members_.begin(), members_.end(), std::back_inserter(added));
  } else {
    map_ = LocalMap(config_.map_cell_m);
  }
  for (const int i : added) {
    const Keyframe& keyframe = keyframes[static_cast<std::size_t>(i)];
    map_.add(keyframe.points_K, keyframe.X_SK, bias_.value(), i);
  }
  map_.finish();
  members_ = std::move(chosen);
  const bool there = std::find(members_.begin(), members_.end(), reference_) != members_.end();
  if (!there) reference_ = members_.front();
}

}  // namespace waretwin

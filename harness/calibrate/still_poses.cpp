#include "harness/calibrate/still_poses.h"

#include <algorithm>
#include <cmath>

namespace waretwin {

namespace {

Stamp end_of(const LaserScan& scan) {
  return scan.stamp + static_cast<Stamp>(std::max<std::size_t>(scan.ranges.size(), 1) - 1) * scan.beam_interval;
}

}  // namespace

void StillConfig::visit(Fields& f) {
  f("still_px", still_px, "corners that move no more than this stand still", {.min = 0.01, .max = 50});
  f("frames", frames, "a pose has at least this many", {.min = 2, .max = 1e6});
  f("scans", scans, "a pose has at least this many", {.min = 1, .max = 1e6});
}

bool StillPoses::stands_with(const std::vector<Eigen::Vector2d>& corners) const {
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if ((corners[i] - newest_[i]).norm() > config_.still_px) return false;
    if (now_.frames > 0 && (corners[i] - now_.mean(i)).norm() > config_.still_px) return false;
  }
  return true;
}

void StillPoses::add(const RgbdFrame& frame) {
  ++frames_;
  std::optional<std::vector<Eigen::Vector2d>> corners;
  if (in_sight_ > 0) corners = find_corners_again(frame.colour, board_, newest_, config_.still_px);
  if (!corners) corners = find_corners(frame.colour, board_);
  if (corners) ++frames_with_board_;
  if (in_sight_ == 0 || !corners || !stands_with(*corners)) {
    close();
    std::erase_if(since_, [&](const LaserScan& scan) { return scan.stamp < frame.stamp; });
    if (!corners) return;
  } else if (in_sight_ > 1) {
    // The newest so far has one like it before and after.
    if (now_.frames == 0) {
      now_.begin = newest_stamp_;
      now_.corners.assign(newest_.size(), Eigen::Vector2d::Zero());
    }
    for (std::size_t i = 0; i < newest_.size(); ++i) now_.corners[i] += newest_[i];
    ++now_.frames;
    now_.end = newest_stamp_;
    take_scans();
  }
  ++in_sight_;
  newest_ = std::move(*corners);
  newest_stamp_ = frame.stamp;
}

void StillPoses::add(const LaserScan& scan) {
  // Without a board in sight only those count that a frame of the same instant may still claim.
  if (in_sight_ == 0) std::erase_if(since_, [&](const LaserScan& old) { return old.stamp < scan.stamp; });
  since_.push_back(scan);
}

// Scans are still only between two frames that are.
void StillPoses::take_scans() {
  for (const LaserScan& scan : since_) {
    if (scan.stamp < now_.begin || end_of(scan) > now_.end) continue;
    const std::size_t beams = scan.ranges.size();
    if (now_.scans == 0) {
      now_.ranges.assign(beams, 0.0);
      now_.squares.assign(beams, 0.0);
      now_.readings.assign(beams, 0);
      now_.angles.clear();
      for (std::size_t i = 0; i < beams; ++i) now_.angles.push_back(scan.angle_min + static_cast<double>(i) * scan.angle_increment);
    }
    if (beams != now_.ranges.size()) continue;
    ++now_.scans;
    for (std::size_t i = 0; i < beams; ++i) {
      const double range = scan.ranges[i];
      if (!(range > 0.0)) continue;
      now_.ranges[i] += range;
      now_.squares[i] += range * range;
      ++now_.readings[i];
    }
  }
  std::erase_if(since_, [&](const LaserScan& scan) { return end_of(scan) <= now_.end; });
}

void StillPoses::close() {
  Sums ended = std::move(now_);
  now_ = {};
  in_sight_ = 0;
  if (ended.frames < config_.frames || ended.scans < config_.scans) return;
  for (Sums& earlier : done_) {
    bool same = earlier.ranges.size() == ended.ranges.size();
    for (std::size_t i = 0; same && i < ended.corners.size(); ++i)
      same = (earlier.mean(i) - ended.mean(i)).norm() <= 2.0 * config_.still_px;
    if (!same) continue;
    for (std::size_t i = 0; i < ended.corners.size(); ++i) earlier.corners[i] += ended.corners[i];
    for (std::size_t i = 0; i < ended.ranges.size(); ++i) {
      earlier.ranges[i] += ended.ranges[i];
      earlier.squares[i] += ended.squares[i];
      earlier.readings[i] += ended.readings[i];
    }
    earlier.frames += ended.frames;
    earlier.scans += ended.scans;
    earlier.end = ended.end;
    return;
  }
  done_.push_back(std::move(ended));
}

std::vector<StillPose> StillPoses::finish() {
  close();
  std::vector<StillPose> poses;
  for (const Sums& sums : done_) {
    StillPose pose{.begin = sums.begin, .end = sums.end, .frames = sums.frames, .scans = sums.scans, .corners = {}, .beams = {}};
    for (std::size_t i = 0; i < sums.corners.size(); ++i) pose.corners.push_back(sums.mean(i));
    for (std::size_t i = 0; i < sums.ranges.size(); ++i) {
      BeamMean beam{.angle = sums.angles[i], .readings = sums.readings[i]};
      const double n = beam.readings;
      if (n > 0) beam.range_m = sums.ranges[i] / n;
      if (n > 1) beam.sigma_m = std::sqrt(std::max(0.0, sums.squares[i] - n * beam.range_m * beam.range_m) / (n - 1));
      pose.beams.push_back(beam);
    }
    poses.push_back(std::move(pose));
  }
  return poses;
}

}  // namespace waretwin

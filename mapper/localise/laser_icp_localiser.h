// Localisation as in section 4.3 of the paper: ICP (Censi 2008) on laser scans, wheel odometry as the first guess.
#pragma once

#include <vector>

#include "mapper/localise/localiser.h"
#include "mapper/localise/odometry_history.h"
#include "mapper/localise/scan_matcher.h"
#include "sensors/sensor_stream.h"

namespace waretwin {

// Every scan is matched against a keyframe scan. A scan is measured while the vehicle moves: its points are first brought to the
// instant at its middle, by odometry (or by the last scans' velocity where there is none), and that instant is what a match gives the
// pose of. Other instants (a frame's stamp, a scan's own stamp) are reached from there by odometry.
// The vehicle moves in the plane of the start pose, and stands still at the first event (one odometry reading tells no velocity). One laser
// is used: the first by name; scans of others are ignored.
class LaserIcpLocaliser : public Localiser {
 public:
  // Throws Error where the stream names no laser.
  LaserIcpLocaliser(const LaserIcpConfig& config, const StreamInfo& info);

  void add(const OdometryReading& reading) override;
  void add(const LaserScan& scan) override;
  // From the start on there is a pose: before the first scan it is the start pose carried on by odometry.
  std::optional<Pose> pose_at(const RgbdFrame& frame) override;
  // At the stamp of the newest scan, which is its first beam's; nothing before the first scan.
  std::optional<Pose> current_pose() const override;
  bool localised() const override { return counts_.scans <= 1 || last_match_.believable; }

  // What became of the scans, for reports.
  struct Counts {
    int scans = 0;
    int not_matched = 0;  // pose from odometry alone
    int keyframes = 0;
    int keyframes_reused = 0;
  };
  const Counts& counts() const { return counts_; }
  // Of the newest scan; untouched (believable = false) for the very first.
  const ScanMatch& last_match() const { return last_match_; }

 private:
  struct Keyframe {
    PlanarMotion X_SB;  // S: the frame of the start pose
    ReferenceScan scan;
  };

  PlanarMotion motion(Stamp from, Stamp to) const;
  std::vector<Eigen::Vector2d> points_in_base(const LaserScan& scan, Stamp middle) const;
  bool near(const PlanarMotion& X_SB, const Keyframe& keyframe) const;
  void choose_keyframe(const std::vector<Eigen::Vector2d>& points_B);

  LaserIcpConfig config_;
  Pose X_WS_;
  std::string laser_;
  Pose X_BL_;
  OdometryHistory odometry_;
  OdometryHistory scan_poses_;  // X_SB at the middles of past scans: the motion model where there is no odometry
  std::vector<Keyframe> keyframes_;
  std::size_t active_ = 0;
  PlanarMotion X_SB_;            // at the middle of the newest scan
  std::optional<Stamp> anchor_;  // that instant; before the first scan: of the first odometry reading
  std::optional<Stamp> newest_scan_;
  ScanMatch last_match_;
  Counts counts_;
};

}  // namespace waretwin

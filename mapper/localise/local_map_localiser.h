// Localisation of profile `best`: each scan against a local map that many scans were averaged into.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mapper/localise/keyframe_graph.h"
#include "mapper/localise/local_map_config.h"
#include "mapper/localise/localiser.h"
#include "mapper/localise/map_matcher.h"
#include "mapper/localise/odometry_history.h"
#include "mapper/localise/range_bias.h"
#include "sensors/sensor_stream.h"

namespace waretwin {

// A scan is brought to the instant at its middle (scan_points.h) and laid onto the local map with odometry as prior (map_matcher.h). The
// map is made of the keyframes around, the oldest first, for they have drifted least (local_map.h). A match that cannot be believed is
// followed by a search over a window that grows until the scan is found (map_search.h); until then odometry carries on. Where a keyframe
// comes near old ones that lie far back along the way, it is looked for among those, and the graph of keyframes is straightened
// (keyframe_graph.h). The laser's constant range error is estimated on the way (range_bias.h).
//
// The covariance of a pose is that of the map's own keyframes (which half of the matched points were first seen from keyframes at least as
// certain as), plus that of the map's points, plus that of the scan and odometry since, in which a direction that the scan does not hold
// grows with odometry's error alone.
//
// The vehicle moves in the plane of the start pose, which is taken as exact, and stands still at the first event. One laser is used: the
// first by name; scans of others are ignored.
class LocalMapLocaliser : public Localiser {
 public:
  // Throws Error where the stream names no laser.
  LocalMapLocaliser(const LocalMapConfig& config, const StreamInfo& info);

  void add(const OdometryReading& reading) override;
  void add(const LaserScan& scan) override;
  // From the start on there is a pose: before the first scan it is the start pose carried on by odometry.
  std::optional<Pose> pose_at(const RgbdFrame& frame) override;
  // At the stamp of the newest scan, which is its first beam's; nothing before the first scan.
  std::optional<Pose> current_pose() const override;
  bool localised() const override { return lost_ == 0; }
  std::optional<Eigen::Matrix3d> covariance() const override;

  // What became of the scans, for reports.
  struct Counts {
    int scans = 0;
    int not_matched = 0;       // pose from odometry alone
    int degenerate = 0;        // one direction from odometry alone
    int odometry_doubted = 0;  // odometry was far off and left out
    int found_again = 0;       // by search, after a bad match
    int keyframes = 0;
    int loops = 0;       // places seen again that straightened the graph
    int bias_steps = 0;  // times that all keyframes were laid anew
  };
  const Counts& counts() const { return counts_; }
  // Of the newest scan; untouched (believable = false) for the very first.
  const MapMatch& last_match() const { return last_match_; }
  const KeyframeGraph& graph() const { return graph_; }
  double range_bias_m() const { return bias_.value(); }

 private:
  PlanarMotion motion(Stamp from, Stamp to) const;
  void predict(const PlanarMotion& step, Stamp duration);
  // The uncertainty of the map where the vehicle stands: of its reference keyframe and of its points.
  Eigen::Matrix3d map_covariance() const;
  void match(const std::vector<ScanPoint>& points_B, const PlanarMotion& carried_on);
  bool find_again(const std::vector<ScanPoint>& points_B);
  void accept(const MapMatch& match, const Eigen::Matrix3d& before);
  void choose_reference();
  // A new keyframe where none is near, or this scan added to the newest one.
  void keep(const std::vector<ScanPoint>& points_B);
  void add_keyframe(const std::vector<ScanPoint>& points_B);
  bool close_loop(int newest, const std::vector<double>& paths);
  void update_bias();
  void lay_anew();
  // Brings the local map up to the keyframes around the newest one.
  void update_map(bool from_scratch);

  LocalMapConfig config_;
  Pose X_WS_;
  std::string laser_;
  Pose X_BL_;
  OdometryHistory odometry_;
  OdometryHistory scan_poses_;  // X_SB at the middles of past scans: the motion model where there is no odometry
  KeyframeGraph graph_;
  LocalMap map_;
  std::vector<int> members_;  // keyframes in map_, ascending
  RangeBias bias_;
  PlanarMotion X_SB_;                                    // at the middle of the newest scan
  Eigen::Matrix3d P_ = Eigen::Matrix3d::Zero();          // its covariance: x, y, yaw in S
  Eigen::Matrix3d map_noise_ = Eigen::Matrix3d::Zero();  // what the map's averaged points leave uncertain
  int reference_ = 0;                                    // keyframe whose covariance stands for the map's
  double doubt_ = 1.0;                                   // factor on the variances of odometry, from how well it foretold the last matches
  double unchecked_m_ = 0.0, unchecked_rad_ = 0.0;       // driven and turned since a scan last held the vehicle in all directions
  int lost_ = 0;                                         // scans since the last believable match
  std::optional<Stamp> anchor_;                          // the instant of X_SB_; before the first scan: of the first odometry reading
  std::optional<Stamp> newest_scan_;
  MapMatch last_match_;
  Counts counts_;
};

}  // namespace waretwin

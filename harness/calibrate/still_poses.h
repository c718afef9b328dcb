// From a stream, the moments at which board and vehicle stood still, with what camera and laser saw of them on average.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/fields.h"
#include "harness/calibrate/checker_board.h"
#include "sensors/measurements.h"

namespace waretwin {

struct StillConfig {
  double still_px = 0.5;  // no corner moves more than this from frame to frame or away from the mean
  int frames = 3;         // at least
  int scans = 10;         // at least
  void visit(Fields& f);
};

// One beam of the laser over all scans of a pose.
struct BeamMean {
  double angle = 0.0;    // radians, in the laser's frame
  int readings = 0;      // that were valid
  double range_m = 0.0;  // their mean
  double sigma_m = 0.0;  // standard deviation of one reading; 0 where there are fewer than two
};

struct StillPose {
  Stamp begin = 0, end = 0;  // first and last frame
  int frames = 0, scans = 0;
  std::vector<Eigen::Vector2d> corners;  // mean, pixels; order of CheckerBoard::corners_O
  std::vector<BeamMean> beams;           // all of a scan
};

// Takes the events of one camera and one laser in order of stamps. A board that was lost from sight for a moment and found in the same
// place is one pose.
class StillPoses {
 public:
  StillPoses(const CheckerBoard& board, const StillConfig& config) : board_(board), config_(config) {}

  void add(const RgbdFrame& frame);  // with its pictures loaded
  void add(const LaserScan& scan);
  std::vector<StillPose> finish();

  int frames() const { return frames_; }
  int frames_with_board() const { return frames_with_board_; }
  int poses() const { return static_cast<int>(done_.size()); }  // so far

 private:
  struct Sums {
    Stamp begin = 0, end = 0;
    int frames = 0, scans = 0;
    std::vector<Eigen::Vector2d> corners, last;  // sum; of the newest frame
    std::vector<double> angles, ranges, squares;
    std::vector<int> readings;
    Eigen::Vector2d mean(std::size_t corner) const { return corners[corner] / frames; }
  };
  bool stands_with(const std::vector<Eigen::Vector2d>& corners) const;
  void take_scans(Stamp until);
  void close();

  CheckerBoard board_;
  StillConfig config_;
  Sums now_;                      // frames == 0: no board in sight
  std::vector<LaserScan> since_;  // scans that began since the newest frame, or a little before
  std::vector<Sums> done_;
  int frames_ = 0, frames_with_board_ = 0;
};

}  // namespace waretwin

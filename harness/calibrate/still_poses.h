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
  int frames = 3;         // at least, beside the first and the last
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

// Takes the events of one camera and one laser in order of stamps. The first and the last frame of a pose only say that the board stood
// still in between: in them it may be about to arrive or to leave, by less than shows. A board that was lost from sight for a moment and
// found in the same place is one pose.
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
    std::vector<Eigen::Vector2d> corners;  // sum
    std::vector<double> angles, ranges, squares;
    std::vector<int> readings;
    Eigen::Vector2d mean(std::size_t corner) const { return corners[corner] / frames; }
  };
  bool stands_with(const std::vector<Eigen::Vector2d>& corners) const;
  void take_scans();
  void close();

  CheckerBoard board_;
  StillConfig config_;
  Sums now_;                             // of the board in sight
  int in_sight_ = 0;                     // frames of it; 0: no board
  std::vector<Eigen::Vector2d> newest_;  // the newest frame's corners, which are not in the sums yet
  Stamp newest_stamp_ = 0;
  std::vector<LaserScan> since_;  // scans that are not in the sums yet and may still be
  std::vector<Sums> done_;
  int frames_ = 0, frames_with_board_ = 0;
};

}  // namespace waretwin

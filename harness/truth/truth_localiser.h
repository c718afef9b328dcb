// The true pose in place of localisation.
#pragma once

#include "mapper/localise/localiser.h"
#include "sim/simulated_stream.h"

namespace waretwin {

class TruthLocaliser : public Localiser {
 public:
  // The stream must outlive the localiser.
  explicit TruthLocaliser(const SimulatedStream& stream) : stream_(stream) {}
  void add(const OdometryReading& reading) override {
    if (!newest_scan_) newest_reading_ = reading.stamp;
  }
  void add(const LaserScan& scan) override { newest_scan_ = scan.stamp; }
  std::optional<Pose> pose_at(const RgbdFrame& frame) override { return stream_.true_X_WB(frame.stamp); }
  std::optional<Pose> current_pose() const override {
    const std::optional<Stamp> newest = newest_scan_ ? newest_scan_ : newest_reading_;
    if (!newest) return std::nullopt;
    return stream_.true_X_WB(*newest);
  }

 private:
  const SimulatedStream& stream_;
  std::optional<Stamp> newest_scan_, newest_reading_;
};

}  // namespace waretwin

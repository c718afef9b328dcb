// Where training pictures are taken from: along the vehicle's route, around objects, and where none is in sight.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/dice.h"
#include "core/pose.h"
#include "core/stamp.h"
#include "harness/dataset/dataset_config.h"
#include "scenes/scenario.h"
#include "sensors/intrinsics.h"
#include "sim/ray_caster.h"
#include "sim/robot.h"

namespace waretwin {

enum class ViewKind { kRoute, kObject, kEmpty };
std::string to_text(ViewKind kind);

struct View {
  ViewKind kind = ViewKind::kRoute;
  // The camera around the moment of the picture; `from_it` in nanoseconds, negative before.
  std::function<Pose(Stamp from_it)> X_WC;
};

// Looks with few rays, so a sliver of an object may be in an empty view, and an object view is not promised to be labelled.
class ViewSampler {
 public:
  // `X_BC`: the camera on the vehicle; `classes`: of the objects that views are of, or free of. The caster outlives the sampler; views are
  // judged by how the hall then stands.
  ViewSampler(const RayCaster& hall, const Scenario& scenario, const Intrinsics& intrinsics, const Pose& X_BC, const ViewConfig& config,
              const std::vector<std::string>& classes);

  ViewKind draw_kind(Dice& dice) const;
  // Nothing where many tries found no such view: a hall without objects, or full of them.
  std::optional<View> draw(ViewKind kind, Dice& dice) const;

 private:
  View route_view(Dice& dice) const;
  std::optional<View> object_view(Dice& dice) const;
  std::optional<View> empty_view(Dice& dice) const;
  // A camera there would be in the open: nothing within arm's length, and not inside of anything.
  bool is_free(const Eigen::Vector3d& p_W) const;
  // Share of the picture that shows one of `objects` (indices).
  double share_of(std::span<const int> objects, const Pose& X_WC) const;
  View drifting(ViewKind kind, const Pose& X_WC, Dice& dice) const;

  const RayCaster& hall_;
  Intrinsics intrinsics_;
  Pose X_BC_;
  ViewConfig config_;
  RobotMotion route_;
  std::vector<int> objects_;  // of the classes, by index
  Eigen::AlignedBox3d bounds_;
  double floor_;
};

}  // namespace waretwin

#include "scenes/generate/route.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/parallel.h"
#include "core/pose.h"
#include "scenes/generate/free_space.h"
#include "sensors/depth_field.h"

namespace waretwin::generate {

namespace {

constexpr double kNearest = 0.45, kFarthest = 1.9;  // metres from a stop to the nearest of a conveyor
constexpr double kBestRange = 1.25;                 // metres to its middle: beyond, depth gets worse
constexpr double kFlattest = 0.20;                  // cosine to the normal below which a surface is too slanted to measure well
constexpr double kFarthestDepth = 3.0;              // metres
constexpr double kTwoSides = 50.0;                  // degrees between the first two directions
constexpr double kBorder = 12.0;                    // pixels to the picture's edge
constexpr std::size_t kMostCandidates = 220;        // per conveyor

// One way to look at one conveyor.
struct Look {
  std::size_t place = 0;
  double heading = 0.0;
  double range = 0.0;      // to the conveyor's middle
  double bearing = 0.0;    // of the place, seen from there
  std::vector<bool> sees;  // by patch
};

// What may hide a conveyor: everything near it but what it stands on and itself; its own deck hides its legs.
std::vector<Solid> occluders(const HallPlan& plan, std::size_t index) {
  const PlannedConveyor& conveyor = plan.conveyors[index];
  const Eigen::Vector3d middle = conveyor.middle();
  double lowest = conveyor.at.z;
  std::vector<Solid> list;
  for (std::size_t i = 0; i < plan.conveyors.size(); ++i) {
    for (const Solid& s : plan.conveyors[i].decks()) list.push_back(s);
  }
  for (const PlacedItem& item : plan.items) {
    const Solid s = solid_of(item.item.extent, item.at);
    if (s.high > lowest + 1e-4) list.push_back(s);
  }
  std::erase_if(list, [&](const Solid& s) { return distance(middle.head<2>(), s) > 3.0; });
  return list;
}

class Viewer {
 public:
  Viewer(const HallPlan& plan, const CameraConfig& camera, const FreeSpace& space, std::size_t index)
      : camera_(camera),
        intrinsics_(camera.intrinsics()),
        space_(space),
        patches_(plan.conveyors[index].surface()),
        occluders_(occluders(plan, index)),
        middle_(plan.conveyors[index].middle().head<2>()) {
    const std::vector<Solid> solids = plan.conveyors[index].solids();
    std::vector<std::size_t> near;
    for (std::size_t i = 0; i < space.places().size(); ++i) {
      double nearest = 1e9;
      for (const Solid& s : solids) nearest = std::min(nearest, distance(space.places()[i], s));
      if (nearest > kNearest && nearest < kFarthest) near.push_back(i);
    }
    // Every n-th, so that large halls and small ones cost the same.
    const std::size_t every = std::max<std::size_t>(1, near.size() / kMostCandidates);
    std::vector<std::size_t> places;
    for (std::size_t i = every / 2; i < near.size(); i += every) places.push_back(near[i]);
    // Long conveyors are looked at piece by piece as well.
    std::vector<Eigen::Vector2d> aims = {middle_};
    if (solids.size() == 1 && solids[0].half.x() > 0.5) {
      const Eigen::Vector2d along(std::cos(solids[0].yaw), std::sin(solids[0].yaw));
      for (const double side : {-0.55, 0.55}) aims.push_back(middle_ + side * solids[0].half.x() * along);
    }
    std::vector<std::vector<Look>> looks(places.size());
    parallel_for(places.size(), 8, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) looks[i] = from(places[i], aims);
    });
    for (auto& list : looks) looks_.insert(looks_.end(), list.begin(), list.end());
  }

  const std::vector<Look>& looks() const { return looks_; }
  double area(const std::vector<bool>& seen) const {
    double sum = 0;
    for (std::size_t i = 0; i < patches_.size(); ++i) sum += seen[i] ? patches_[i].area : 0.0;
    return sum;
  }
  std::size_t patch_count() const { return patches_.size(); }

 private:
  std::vector<Look> from(std::size_t place, const std::vector<Eigen::Vector2d>& aims) const {
    const Eigen::Vector2d p = space_.places()[place];
    const Eigen::Vector3d foot(p.x(), p.y(), 0);
    std::vector<Look> looks;
    for (const Eigen::Vector2d& aim : aims) {
      Look look;
      look.place = place;
      look.heading = std::atan2(aim.y() - p.y(), aim.x() - p.x());
      look.range = (middle_ - p).norm();
      look.bearing = std::atan2(p.y() - middle_.y(), p.x() - middle_.x());
      look.sees.assign(patches_.size(), false);
      const Pose X_WC = make_upright_pose(foot.x(), foot.y(), 0, look.heading) * camera_.mount.X_BC(), X_CW = X_WC.inverse();
      bool any = false;
      for (std::size_t i = 0; i < patches_.size(); ++i) {
        const SurfacePatch& patch = patches_[i];
        const Eigen::Vector3d eye = X_WC.translation(), view = eye - patch.p_W, p_C = X_CW * patch.p_W;
        if (patch.normal.dot(view) < kFlattest * view.norm()) continue;
        if (p_C.z() < camera_.depth_min_m + 0.03 || p_C.z() > std::min(kFarthestDepth, camera_.depth_max_m)) continue;
        const Eigen::Vector2d pixel = intrinsics_.project(p_C);
        if (!intrinsics_.contains(pixel.x() - kBorder, pixel.y() - kBorder) ||
            !intrinsics_.contains(pixel.x() + kBorder, pixel.y() + kBorder)) {
          continue;
        }
        if (!in_depth_field(camera_.field, p_C)) continue;
        const Eigen::Vector3d off = patch.p_W + 0.004 * patch.normal + 0.002 * view.normalized();
        if (std::any_of(occluders_.begin(), occluders_.end(), [&](const Solid& s) { return blocks(s, off, eye); })) continue;
        look.sees[i] = any = true;
      }
      if (any) looks.push_back(std::move(look));
    }
    return looks;
  }

  const CameraConfig& camera_;
  Intrinsics intrinsics_;
  const FreeSpace& space_;
  std::vector<SurfacePatch> patches_;
  std::vector<Solid> occluders_;
  Eigen::Vector2d middle_;
  std::vector<Look> looks_;
};

// Greedy choice: each next look is the one that adds most surface, seen from near.
std::vector<Look> choose(const Viewer& viewer, int effort, const std::vector<std::size_t>& taken) {
  const double wanted_share = std::min(0.995, 0.93 + 0.025 * effort);
  const std::size_t least = 2 + static_cast<std::size_t>(effort / 2), most = 4 + static_cast<std::size_t>(effort);
  std::vector<bool> any(viewer.patch_count(), false), seen = any;
  for (const Look& look : viewer.looks()) {
    for (std::size_t i = 0; i < any.size(); ++i) any[i] = any[i] || look.sees[i];
  }
  const double whole = viewer.area(any);
  std::vector<Look> chosen;
  std::vector<std::size_t> used = taken;
  while (chosen.size() < most) {
    if (chosen.size() >= least && viewer.area(seen) >= wanted_share * whole) break;
    const Look* best = nullptr;
    double best_score = 0.0;
    const bool needs_second_side = chosen.size() == 1;
    for (const Look& look : viewer.looks()) {
      if (std::find(used.begin(), used.end(), look.place) != used.end()) continue;
      if (needs_second_side && std::abs(to_degrees(wrap_angle(look.bearing - chosen[0].bearing))) < kTwoSides) continue;
      std::vector<bool> fresh(seen.size());
      for (std::size_t i = 0; i < seen.size(); ++i) fresh[i] = look.sees[i] && !seen[i];
      // What was seen before still counts a little: a second good look makes a better map.
      const double gain = viewer.area(fresh) + 0.15 * viewer.area(look.sees);
      const double score = gain / (1.0 + std::pow(std::max(0.0, look.range - kBestRange), 2));
      if (score > best_score) {
        best_score = score;
        best = &look;
      }
    }
    if (!best) {
      if (!needs_second_side) break;
      // No second side: whatever adds most.
      chosen.push_back(chosen[0]);
      continue;
    }
    for (std::size_t i = 0; i < seen.size(); ++i) seen[i] = seen[i] || best->sees[i];
    used.push_back(best->place);
    chosen.push_back(*best);
  }
  std::vector<Look> unique;
  for (const Look& look : chosen) {
    if (std::none_of(unique.begin(), unique.end(), [&](const Look& u) { return u.place == look.place; })) unique.push_back(look);
  }
  return unique;
}

// A short order: nearest neighbour from the start, then 2-opt on the path with its first place fixed, and its last one where `closed`.
std::vector<std::size_t> short_order(const std::vector<std::vector<double>>& d, bool closed) {
  const std::size_t n = d.size();
  std::vector<std::size_t> order = {0};
  std::vector<bool> used(n, false);
  used[0] = true;
  while (order.size() < n) {
    std::size_t best = n;
    for (std::size_t i = 0; i < n; ++i) {
      if (!used[i] && (best == n || d[order.back()][i] < d[order.back()][best])) best = i;
    }
    used[best] = true;
    order.push_back(best);
  }
  const auto length = [&](const std::vector<std::size_t>& o) {
    double sum = closed ? d[o.back()][o.front()] : 0.0;
    for (std::size_t i = 0; i + 1 < o.size(); ++i) sum += d[o[i]][o[i + 1]];
    return sum;
  };
  bool better = true;
  while (better) {
    better = false;
    for (std::size_t i = 1; i < n && !better; ++i) {
      for (std::size_t k = i + 1; k < n && !better; ++k) {
        std::vector<std::size_t> turned = order;
        std::reverse(turned.begin() + static_cast<std::ptrdiff_t>(i), turned.begin() + static_cast<std::ptrdiff_t>(k) + 1);
        if (length(turned) < length(order) - 1e-9) {
          order = turned;
          better = true;
        }
      }
    }
  }
  return order;
}

double rounded(double value, double step) { return std::round(value / step) * step + 0.0; }

}  // namespace

std::vector<int> plan_route(HallPlan& plan, const CameraConfig& camera, const RouteWishes& wishes) {
  const double radius = 0.5 * std::hypot(plan.robot.length_m, plan.robot.width_m) + wishes.clearance_m;
  const FreeSpace space(plan, radius);
  plan.stops.clear();
  plan.robot.route.clear();
  std::vector<int> unseen;
  struct PlannedLook {
    Look look;
    int conveyor;
  };
  std::vector<PlannedLook> looks;
  std::vector<std::size_t> taken;
  for (std::size_t k = 0; k < plan.conveyors.size(); ++k) {
    const Viewer viewer(plan, camera, space, k);
    const std::vector<Look> chosen = choose(viewer, k < wishes.effort.size() ? wishes.effort[k] : 0, taken);
    if (chosen.empty()) unseen.push_back(static_cast<int>(k));
    for (const Look& look : chosen) {
      looks.push_back({look, static_cast<int>(k)});
      taken.push_back(look.place);
    }
  }
  if (!unseen.empty() || space.places().empty()) {
    if (unseen.empty()) {
      for (std::size_t k = 0; k < plan.conveyors.size(); ++k) unseen.push_back(static_cast<int>(k));
    }
    return unseen;
  }

  std::vector<std::size_t> nodes = {space.nearest(wishes.start)};
  for (const PlannedLook& look : looks) nodes.push_back(look.look.place);
  std::vector<std::vector<double>> between(nodes.size());
  parallel_for(nodes.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::vector<double> from_here = space.distances(nodes[i]);
      for (const std::size_t node : nodes) between[i].push_back(from_here[node]);
    }
  });
  const std::vector<std::size_t> order = short_order(between, wishes.back_to_start);

  constexpr double kCentimetre = 0.01;
  const auto waypoint = [&](const Eigen::Vector2d& p) {
    Waypoint w;
    w.x_m = rounded(p.x(), kCentimetre);
    w.y_m = rounded(p.y(), kCentimetre);
    return w;
  };
  std::vector<Waypoint>& route = plan.robot.route;
  route.push_back(waypoint(space.places()[nodes[0]]));
  route.back().wait_s = wishes.wait_s;
  const auto drive_to = [&](std::size_t from, std::size_t to) {
    const std::vector<Eigen::Vector2d> way = space.way(nodes[from], nodes[to]);
    for (std::size_t i = 1; i < way.size(); ++i) route.push_back(waypoint(way[i]));
  };
  for (std::size_t i = 1; i < order.size(); ++i) {
    drive_to(order[i - 1], order[i]);
    const PlannedLook& look = looks[order[i] - 1];
    Waypoint& stop = route.back();
    stop.heading_deg = rounded(to_degrees(look.look.heading), 0.1);
    stop.wait_s = wishes.wait_s;
    plan.stops.push_back({{stop.x_m, stop.y_m}, *stop.heading_deg, look.conveyor});
  }
  if (wishes.back_to_start && order.size() > 1) {
    drive_to(order.back(), 0);
    route.back().wait_s = wishes.wait_s;
  }
  if (route[0].heading_deg) return {};  // the first stop is the start
  if (route.size() > 1) {
    route[0].heading_deg = rounded(to_degrees(std::atan2(route[1].y_m - route[0].y_m, route[1].x_m - route[0].x_m)), 0.1);
  } else {
    route[0].heading_deg = 0.0;
  }
  return {};
}

}  // namespace waretwin::generate

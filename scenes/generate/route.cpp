#include "scenes/generate/route.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/parallel.h"
#include "core/pose.h"
#include "scenes/generate/free_space.h"
#include "sensors/depth_field.h"

namespace waretwin::generate {

namespace {

constexpr double kNearest = 0.45;             // metres from a stop to the nearest of an object
constexpr double kBestRange = 1.25;           // metres to its middle: beyond, depth gets worse
constexpr double kTwoSides = 50.0;            // degrees between the first two directions
constexpr double kBorder = 12.0;              // pixels to the picture's edge
constexpr std::size_t kMostCandidates = 220;  // per object

constexpr double kFarthestDepth = 3.0;  // metres
constexpr double kFlattest = 0.2;       // cosine to the normal below which a surface is too slanted to measure well
constexpr double kFarAway = 3.0;        // metres to the nearest of an object, of a stop that is better than none
constexpr double kApart = 0.3;          // metres between such stops and the route's own

// Under a floor-standing conveyor one sees from afar; furniture is large, and a camera that looks ahead sees its feet from afar only.
double farthest(const PlannedObject& object) {
  if (std::holds_alternative<FurniturePart>(object.part)) return 2.6;
  return std::holds_alternative<builder::TableTopConveyor>(object.part) ? 1.7 : 2.2;
}
double best_range_of(const PlannedObject& object) { return std::holds_alternative<FurniturePart>(object.part) ? 2.0 : kBestRange; }

// One way to look at one object.
struct Look {
  std::size_t place = 0;
  double heading = 0.0;
  double range = 0.0;      // to the object's middle
  double bearing = 0.0;    // of the place, seen from there
  std::vector<bool> sees;  // by patch
};

// Free places at most `reach` from an object, every n-th, so that large halls and small ones cost the same.
std::vector<std::size_t> places_near(const FreeSpace& space, const PlannedObject& object, double reach) {
  const std::vector<Solid> solids = object.solids();
  std::vector<std::size_t> near;
  for (std::size_t i = 0; i < space.places().size(); ++i) {
    double nearest = 1e9;
    for (const Solid& s : solids) nearest = std::min(nearest, distance(space.places()[i], s));
    if (nearest > kNearest && nearest < reach) near.push_back(i);
  }
  const std::size_t every = std::max<std::size_t>(1, near.size() / kMostCandidates);
  std::vector<std::size_t> places;
  for (std::size_t i = every / 2; i < near.size(); i += every) places.push_back(near[i]);
  return places;
}

// The middle of an object; long ones are looked at piece by piece as well.
std::vector<Eigen::Vector2d> aims_at(const PlannedObject& object) {
  const Eigen::Vector2d middle = object.middle().head<2>();
  std::vector<Eigen::Vector2d> aims = {middle};
  const std::vector<Solid> solids = object.solids();
  if (solids.size() != 1 || solids[0].half.x() < 0.5) return aims;
  const Eigen::Vector2d along(std::cos(solids[0].yaw), std::sin(solids[0].yaw));
  for (const double side : {-0.55, 0.55}) aims.push_back(middle + side * solids[0].half.x() * along);
  return aims;
}

// What may hide an object: everything near it but what it stands on or in; its own deck hides its legs.
std::vector<Solid> occluders(const HallPlan& plan, std::size_t index) {
  const PlannedObject& object = plan.objects[index];
  const Eigen::Vector3d middle = object.middle();
  double lowest = object.at.z;
  std::vector<Solid> list;
  for (std::size_t i = 0; i < plan.objects.size(); ++i) {
    for (const Solid& s : plan.objects[i].decks()) list.push_back(s);
  }
  for (const PlacedItem& item : plan.items) {
    const Solid s = solid_of(item.item.extent, item.at);
    // An open case that an object stands in is empty where one looks at it.
    const bool holds_it = distance(middle.head<2>(), s) <= 0 && s.low < middle.z() && middle.z() < s.high;
    if (s.high > lowest + 1e-4 && !holds_it) list.push_back(s);
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
        patches_(plan.objects[index].surface()),
        occluders_(occluders(plan, index)),
        middle_(plan.objects[index].middle().head<2>()),
        best_range_(best_range_of(plan.objects[index])) {
    const std::vector<std::size_t> places = places_near(space, plan.objects[index], farthest(plan.objects[index]));
    const std::vector<Eigen::Vector2d> aims = aims_at(plan.objects[index]);
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
  double best_range() const { return best_range_; }

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
  double best_range_;
  std::vector<Look> looks_;
};

std::vector<bool> fresh(const std::vector<bool>& sees, const std::vector<bool>& seen) {
  std::vector<bool> result(seen.size());
  for (std::size_t i = 0; i < seen.size(); ++i) result[i] = sees[i] && !seen[i];
  return result;
}

// Greedy choice: each next look is the one that adds most surface, seen from near.
std::vector<Look> choose(const Viewer& viewer, const std::vector<std::size_t>& taken) {
  std::vector<bool> any(viewer.patch_count(), false), seen = any;
  for (const Look& look : viewer.looks()) {
    for (std::size_t i = 0; i < any.size(); ++i) any[i] = any[i] || look.sees[i];
  }
  const double whole = viewer.area(any);
  constexpr double kEnough = 0.88;       // share of what can be seen
  constexpr double kWorthwhile = 0.008;  // share that a further stop must add
  constexpr std::size_t kLeast = 2, kMost = 8;
  std::vector<Look> chosen;
  std::vector<std::size_t> used = taken;
  // First with the second direction apart from the first, then, where the hall has none, without.
  const auto best_look = [&](bool apart) {
    const Look* best = nullptr;
    double best_score = 0.0;
    for (const Look& look : viewer.looks()) {
      if (std::find(used.begin(), used.end(), look.place) != used.end()) continue;
      if (apart && std::abs(to_degrees(wrap_angle(look.bearing - chosen[0].bearing))) < kTwoSides) continue;
      // What was seen before still counts a little: a second good look makes a better map.
      const double gain = viewer.area(fresh(look.sees, seen)) + 0.15 * viewer.area(look.sees);
      const double score = gain / (1.0 + std::pow(std::max(0.0, look.range - viewer.best_range()), 2));
      if (score > best_score) {
        best_score = score;
        best = &look;
      }
    }
    return best;
  };
  while (chosen.size() < kMost) {
    if (chosen.size() >= kLeast && viewer.area(seen) >= kEnough * whole) break;
    const bool second = chosen.size() == 1;
    const Look* best = best_look(second);
    if (!best && second) best = best_look(false);
    if (!best) break;
    if (chosen.size() >= kLeast && viewer.area(fresh(best->sees, seen)) < kWorthwhile * whole) break;
    for (std::size_t i = 0; i < seen.size(); ++i) seen[i] = seen[i] || best->sees[i];
    used.push_back(best->place);
    chosen.push_back(*best);
  }
  return chosen;
}

// A quick order: nearest neighbour from the start, then 2-opt on the path with its first place fixed, back to it where `closed`. d[i][k] is
// what it costs to go from i to k.
std::vector<std::size_t> quick_order(const std::vector<std::vector<double>>& d, bool closed) {
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
    // And single places moved elsewhere.
    for (std::size_t i = 1; i < n && !better; ++i) {
      for (std::size_t k = 1; k < n && !better; ++k) {
        if (k == i) continue;
        std::vector<std::size_t> moved = order;
        moved.erase(moved.begin() + static_cast<std::ptrdiff_t>(i));
        moved.insert(moved.begin() + static_cast<std::ptrdiff_t>(k), order[i]);
        if (length(moved) < length(order) - 1e-9) {
          order = moved;
          better = true;
        }
      }
    }
  }
  return order;
}

double rounded(double value, double step) { return std::round(value / step) * step + 0.0; }

struct PlannedLook {
  std::size_t place = 0;
  double heading = 0.0;
  int object = 0;
};

double turning_radius(const HallPlan& plan, const RouteWishes& wishes) {
  return 0.5 * std::hypot(plan.robot.length_m, plan.robot.width_m) + wishes.clearance_m;
}

// Drives to all looks in a short round.
void lay_route(HallPlan& plan, const FreeSpace& space, const RouteWishes& wishes, const std::vector<PlannedLook>& looks) {
  std::vector<std::size_t> nodes = {space.nearest(wishes.start)};
  for (const PlannedLook& look : looks) nodes.push_back(look.place);
  // Turning costs time as driving does.
  const auto seconds = [&](std::size_t i, std::size_t k, double metres) {
    const Eigen::Vector2d way = space.places()[nodes[k]] - space.places()[nodes[i]];
    const double direction = std::atan2(way.y(), way.x());
    double turn = i > 0 ? std::abs(wrap_angle(direction - looks[i - 1].heading)) : 0.0;
    if (k > 0) turn += std::abs(wrap_angle(looks[k - 1].heading - direction));
    return metres / plan.robot.speed_mps + turn / to_radians(plan.robot.turn_rate_deg_s);
  };
  std::vector<std::vector<double>> between(nodes.size());
  parallel_for(nodes.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::vector<double> from_here = space.distances(nodes[i]);
      for (std::size_t k = 0; k < nodes.size(); ++k) between[i].push_back(seconds(i, k, from_here[nodes[k]]));
    }
  });
  const std::vector<std::size_t> order = quick_order(between, wishes.back_to_start);

  plan.stops.clear();
  std::vector<Waypoint>& route = plan.robot.route;
  route.clear();
  constexpr double kCentimetre = 0.01;
  const auto waypoint = [&](const Eigen::Vector2d& p) {
    Waypoint w;
    w.x_m = rounded(p.x(), kCentimetre);
    w.y_m = rounded(p.y(), kCentimetre);
    return w;
  };
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
    stop.heading_deg = rounded(to_degrees(look.heading), 0.1);
    stop.wait_s = wishes.wait_s;
    plan.stops.push_back({{stop.x_m, stop.y_m}, *stop.heading_deg, look.object});
  }
  if (wishes.back_to_start && order.size() > 1) {
    drive_to(order.back(), 0);
    route.back().wait_s = wishes.wait_s;
  }
  if (route[0].heading_deg) return;  // the first stop is the start
  route[0].heading_deg =
      route.size() > 1 ? rounded(to_degrees(std::atan2(route[1].y_m - route[0].y_m, route[1].x_m - route[0].x_m)), 0.1) : 0.0;
}

}  // namespace

std::vector<int> plan_route(HallPlan& plan, const CameraConfig& camera, const RouteWishes& wishes) {
  const FreeSpace space(plan, turning_radius(plan, wishes));
  plan.stops.clear();
  plan.robot.route.clear();
  std::vector<int> unseen;
  std::vector<PlannedLook> looks;
  std::vector<std::size_t> taken;
  for (std::size_t k = 0; k < plan.objects.size(); ++k) {
    const std::vector<Look> chosen = choose(Viewer(plan, camera, space, k), taken);
    if (chosen.empty()) unseen.push_back(static_cast<int>(k));
    for (const Look& look : chosen) {
      looks.push_back({look.place, look.heading, static_cast<int>(k)});
      taken.push_back(look.place);
    }
  }
  if (unseen.empty() && !space.places().empty()) lay_route(plan, space, wishes, looks);
  return unseen;
}

std::vector<Stop> possible_stops(const HallPlan& plan, const RouteWishes& wishes, std::size_t object) {
  const FreeSpace space(plan, turning_radius(plan, wishes));
  std::vector<Stop> stops;
  for (const std::size_t place : places_near(space, plan.objects[object], kFarAway)) {
    const Eigen::Vector2d& p = space.places()[place];
    if (std::any_of(plan.stops.begin(), plan.stops.end(), [&](const Stop& s) { return (s.place - p).norm() < kApart; })) continue;
    for (const Eigen::Vector2d& aim : aims_at(plan.objects[object])) {
      stops.push_back({p, rounded(to_degrees(std::atan2(aim.y() - p.y(), aim.x() - p.x())), 0.1), static_cast<int>(object)});
    }
  }
  return stops;
}

void add_stops(HallPlan& plan, const RouteWishes& wishes, const std::vector<Stop>& stops) {
  const FreeSpace space(plan, turning_radius(plan, wishes));
  std::vector<PlannedLook> looks;
  for (const std::vector<Stop>* list : {&std::as_const(plan.stops), &stops}) {
    for (const Stop& stop : *list) looks.push_back({space.nearest(stop.place), to_radians(stop.heading_deg), stop.object});
  }
  lay_route(plan, space, wishes, looks);
}

}  // namespace waretwin::generate

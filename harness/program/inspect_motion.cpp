#include "harness/program/inspect_motion.h"

#include <algorithm>
#include <cstdio>
#include <iostream>

#include "harness/program/progress.h"
#include "harness/score/motion_text.h"

namespace waretwin {

int inspect_motion(const Scenario& scenario, double seconds, bool quiet) {
  RayCaster ray_caster(std::make_shared<const Scene>(build_scene(scenario)));
  HallMotion motion(scenario, ray_caster);
  {
    Progress progress("motion", quiet);
    constexpr double kPiece_s = 1.0;
    for (double time_s = 0.0; time_s < seconds;) {
      time_s = std::min(time_s + kPiece_s, seconds);
      motion.advance_to(from_seconds(time_s));
      progress.update(time_s / seconds, std::to_string(static_cast<int>(time_s)) + " s of the hall's time");
    }
  }
  const MotionReport report = motion.report();
  const double route_s = to_seconds(motion.duration());
  std::printf("%.1f s; the route takes %.1f s\n", seconds, route_s);
  std::cout << motion_text(report) << "digest " << motion.digest() << "\n";
  return report.contacts.empty() && report.items_fell_through == 0 ? 0 : 1;
}

}  // namespace waretwin

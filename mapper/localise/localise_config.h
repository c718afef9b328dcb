// Laser localisation: which method, and the constants of each.
#pragma once

#include <string>

#include "core/fields.h"
#include "mapper/localise/laser_icp_config.h"
#include "mapper/localise/local_map_config.h"

namespace waretwin {

struct LocaliseConfig {
  std::string method = "icp_keyframe";  // "icp_keyframe": the paper's; "local_map": ours
  LaserIcpConfig icp;
  LocalMapConfig local_map;

  void visit(Fields& f) {
    f("method", method, "icp_keyframe: each scan against one keyframe; local_map: against a map of many scans",
      {.choices = {"icp_keyframe", "local_map"}});
    icp.visit(f);
    f.group("local_map", local_map, "method local_map");
  }
};

}  // namespace waretwin

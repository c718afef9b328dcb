#include "harness/score/motion_text.h"

#include <cstdio>

namespace waretwin {

std::string contact_text(const RobotContact& contact) {
  char line[240];
  std::snprintf(line, sizeof line, "the vehicle touched '%.60s' at %.2f s, at (%.2f, %.2f, %.2f), for %.2f s with up to %.0f N",
                contact.with.c_str(), to_seconds(contact.begin), contact.p_W.x(), contact.p_W.y(), contact.p_W.z(),
                to_seconds(contact.end - contact.begin), contact.force_n);
  return line;
}

std::string motion_text(const MotionReport& report) {
  std::string text;
  char line[240];
  if (!report.belts.empty()) {
    std::snprintf(line, sizeof line, "%-28s %10s %14s %14s %14s\n", "belt", "m/s", "items' speed", "farthest ride", "items x time");
    text += line;
  }
  for (const BeltReport& belt : report.belts) {
    std::snprintf(line, sizeof line, "%-28.28s %10.3f %13.2f%% %13.2f%% %12.1f s\n", belt.name.c_str(), belt.wanted_mps,
                  100.0 * belt.mean_ratio, 100.0 * belt.worst_ratio, belt.carried_s);
    text += line;
  }
  std::snprintf(line, sizeof line,
                "items: %d came in, %d left by a sink, %d in the hall; %d fell off a belt, %d fell through one; %d came later than due\n",
                report.items_in, report.items_delivered, report.items_in_hall, report.items_fell_off, report.items_fell_through,
                report.items_waited);
  text += line;
  if (report.contacts.empty()) text += "the vehicle touched nothing\n";
  for (const RobotContact& contact : report.contacts) text += contact_text(contact) + "\n";
  return text;
}

}  // namespace waretwin

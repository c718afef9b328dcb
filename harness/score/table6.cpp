#include "harness/score/table6.h"

#include <cstdarg>
#include <cstdio>

#include "harness/score/number_text.h"

namespace waretwin {

namespace {

[[gnu::format(printf, 1, 2)]] std::string format(const char* pattern, ...) {
  char buffer[256];
  va_list arguments;
  va_start(arguments, pattern);
  std::vsnprintf(buffer, sizeof buffer, pattern, arguments);
  va_end(arguments);
  return buffer;
}

std::string heading(const std::string& name) {
  return "\n## " + name + "\n\n| Object ID | Map ID | IoU_3D | E_trans (m) | E_rot (deg) | Seen |\n|---|---|---|---|---|---|\n";
}

std::string rows(const ObjectListScore& score) {
  std::string text;
  for (const ObjectScore& row : score.objects) {
    text += "| " + std::to_string(row.truth_id) + (row.counted ? "" : " (not counted)") + " | " +
            (row.map_id ? std::to_string(*row.map_id) : "-") + " | " + format("%.4f", row.iou3d) + " | " + number("%.3f", row.e_trans_m) +
            " | " + number("%.1f", row.e_rot_deg) + " | " + format("%.2f", row.visible_fraction) + " |\n";
  }
  const ScoreSummary& s = score.summary;
  text += "| Average | | " + number("%.4f", s.mean_iou3d) + " | " + number("%.3f", s.mean_e_trans_m) + " | " +
          number("%.1f", s.mean_e_rot_deg) + " | |\n";
  text += "\n" + std::to_string(s.matched) + " of " + std::to_string(s.truth) + " objects matched (IoU >= 0.5), " +
          std::to_string(s.mapped) + " mapped; mAP as in the paper " + number("%.2f", s.map_paper) + ", AP50 " + number("%.2f", s.ap50) +
          ".\n";
  if (!score.false_positives.empty()) {
    text += "\nMapped, but no true object's match:";
    for (const int id : score.false_positives) text += " " + std::to_string(id);
    text += ".\n";
  }
  return text;
}

std::string explanation_text(const std::vector<Explanation>& lines) {
  std::string text;
  for (const Explanation& line : lines) {
    text += "- " + (line.truth_id ? "Object " + std::to_string(*line.truth_id) : "Mapped object " + std::to_string(*line.map_id)) + ": " +
            line.text + ".\n";
  }
  return text;
}

}  // namespace

const std::vector<PaperRow>& paper_table6() {
  static const std::vector<PaperRow> rows = {{"1", 0.7446, 0.058, 3.4},
                                             {"2", 0.7140, 0.060, 0.9},
                                             {"3", 0.8061, 0.029, 1.6},
                                             {"4", 0.9056, 0.035, 1.0},
                                             {"Average", 0.7925, 0.045, 1.7}};
  return rows;
}

std::string table6(const ComparedLists& objects, const std::string& title) {
  std::string text = "# Table 6: " + title + "\n";
  text += heading("As mapped") + rows(objects.plain);
  if (!objects.explanations.empty()) text += "\n## What is wrong\n\n" + explanation_text(objects.explanations);
  if (objects.aligned && objects.X_TM) {
    text += heading("After aligning the map to the truth by one planar motion") + rows(*objects.aligned);
    const Eigen::Vector3d shift = objects.X_TM->translation();
    text += format("\nThe motion: %.3f m, %.3f m, %.2f deg. The paper's truth was annotated in its own map, so its table holds no drift.\n",
                   shift.x(), shift.y(), to_degrees(yaw_of(*objects.X_TM)));
  }
  text += "\n## The paper\n\n| Object ID | IoU_3D | E_trans (m) | E_rot (deg) |\n|---|---|---|---|\n";
  for (const PaperRow& row : paper_table6())
    text += format("| %s | %.4f | %.3f | %.1f |\n", row.id.c_str(), row.iou3d, row.e_trans_m, row.e_rot_deg);
  return text;
}

}  // namespace waretwin
